// Triangles for tests of builders and traversal: ordinary and degenerate ones. The same name, size and seed give the
// same triangles on any machine.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "builder/bvh.h"

namespace copse::test {

struct TestMesh {
  std::string name;
  std::vector<vec3> positions;  ///< Three per triangle, none shared.
  std::vector<uvec3> indices;

  uint32_t count() const { return static_cast<uint32_t>(indices.size()); }
  TrianglesView hostView() const { return {positions.data(), indices.data(), count()}; }
};

/// `count`, or a tenth of it in a build with a sanitizer, which is ten times as slow and finds its errors at that size
/// as well.
uint32_t many(uint32_t count);

/// Sizes around every block and warp size, and one that fills several blocks: 0, 1, 2, 3, 5, … 1025, many(100000).
const std::vector<uint32_t>& inputSizes();

/// "random", "identical", "equal-centres", "coplanar", "collinear", "grid", "two-clusters", "one-huge", "zero-area",
/// "negative", "large", "tiny", "shrinking" (each triangle half as large and as far as the one before).
const std::vector<std::string>& inputNames();

/// `count` triangles of the kind `name`; throws std::out_of_range for another name.
TestMesh makeInput(const std::string& name, uint32_t count, uint32_t seed = 1);

/// A mesh in a device's memory.
class DeviceMesh {
 public:
  DeviceMesh(const Device& device, const TestMesh& mesh)
      : positions_(device, mesh.positions), indices_(device, mesh.indices), count_(mesh.count()) {}
  TrianglesView view() const { return {positions_.data(), indices_.data(), count_}; }

 private:
  Buffer<vec3> positions_;
  Buffer<uvec3> indices_;
  uint32_t count_;
};

}  // namespace copse::test
