// A copy of a device's triangles on the host, for checks and measures that run there.
#pragma once

#include <algorithm>

#include "builder/bvh.h"

namespace copse {

struct HostTriangles {
  std::vector<vec3> positions;  ///< As many as the indices reach.
  std::vector<uvec3> indices;

  HostTriangles(const Device& device, const TrianglesView& triangles) {
    copy(device, indices, triangles.indices, triangles.count);
    std::size_t corners = 0;
    for (const uvec3& index : indices)
      for (int c = 0; c < 3; ++c) corners = std::max<std::size_t>(corners, std::size_t{index[c]} + 1);
    copy(device, positions, triangles.positions, corners);
  }

 private:
  template <class T>
  static void copy(const Device& device, std::vector<T>& to, const T* from, std::size_t count) {
    to.resize(count);
    if (count) copyToHost(device, to.data(), from, count * sizeof(T));
  }
};

}  // namespace copse
