// What every room takes for granted of a scene that was loaded.
#pragma once

#include <cmath>

#include "tracer/scene/scene.h"

namespace copse::test {

inline bool isWhole(const Scene& scene) {
  const std::size_t n = scene.triangles.size();
  bool good = scene.materialOf.size() == n && (scene.uvTriangles.empty() || scene.uvTriangles.size() == n);
  good &= !scene.cameras.empty();
  for (const uvec3& t : scene.triangles)
    for (int k = 0; k < 3; ++k)
      good &= t[k] < scene.positions.size() && std::isfinite(glm::length(scene.positions[t[k]]));
  for (const uvec3& t : scene.uvTriangles)
    for (int k = 0; k < 3; ++k) good &= t[k] < scene.uvs.size();
  for (const uint32_t m : scene.materialOf) good &= m < scene.materials.size();
  for (const Material& m : scene.materials) {
    good &= m.texture < static_cast<int>(scene.textures.size());
    for (int k = 0; k < 3; ++k) good &= m.kd[k] >= 0 && m.kd[k] <= 1 && m.ke[k] >= 0 && std::isfinite(m.ke[k]);
  }
  return good;
}

}  // namespace copse::test
