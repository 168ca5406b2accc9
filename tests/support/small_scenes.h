// Scenes of a few triangles, made by hand.
#pragma once

#include <array>
#include <cmath>
#include <glm/geometric.hpp>

#include "tracer/scene/scene.h"

namespace copse::test {

inline void addTriangle(Scene& scene, vec3 a, vec3 b, vec3 c, uint32_t material) {
  const auto first = static_cast<uint32_t>(scene.positions.size());
  scene.positions.insert(scene.positions.end(), {a, b, c});
  scene.triangles.push_back({first, first + 1, first + 2});
  scene.materialOf.push_back(material);
}

/// Two triangles; its normal points along cross(u, v).
inline void addQuad(Scene& scene, vec3 corner, vec3 u, vec3 v, uint32_t material) {
  addTriangle(scene, corner, corner + u, corner + u + v, material);
  addTriangle(scene, corner, corner + u + v, corner + v, material);
}

inline void addBox(Scene& scene, vec3 lo, vec3 hi, uint32_t material) {
  const vec3 x{hi.x - lo.x, 0, 0}, y{0, hi.y - lo.y, 0}, z{0, 0, hi.z - lo.z};
  addQuad(scene, lo, y, x, material);
  addQuad(scene, lo, x, z, material);
  addQuad(scene, lo, z, y, material);
  addQuad(scene, hi, -x, -y, material);
  addQuad(scene, hi, -z, -x, material);
  addQuad(scene, hi, -y, -z, material);
}

/// A grey square in y = 0 around the origin, material 0.
inline Scene floorScene(float kd, float halfSide) {
  Scene scene;
  scene.materials.push_back({"grey", vec3(kd), vec3(0), -1});
  addQuad(scene, {-halfSide, 0, -halfSide}, {0, 0, 2 * halfSide}, {2 * halfSide, 0, 0}, 0);
  return scene;
}

/// An octahedron, each triangle split into four `levels` times, with its vertices on the sphere of radius 1.
inline Scene sphereScene(float kd, vec3 ke, int levels) {
  Scene scene;
  scene.materials.push_back({"sphere", vec3(kd), ke, -1});
  std::vector<std::array<vec3, 3>> faces;
  for (const float x : {-1.0f, 1.0f})
    for (const float y : {-1.0f, 1.0f})
      for (const float z : {-1.0f, 1.0f}) faces.push_back({vec3(x, 0, 0), vec3(0, y, 0), vec3(0, 0, z)});
  for (int level = 0; level < levels; ++level) {
    std::vector<std::array<vec3, 3>> finer;
    for (const auto& [a, b, c] : faces) {
      const vec3 ab = glm::normalize(a + b), bc = glm::normalize(b + c), ca = glm::normalize(c + a);
      finer.insert(finer.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
    }
    faces = finer;
  }
  for (const auto& [a, b, c] : faces) addTriangle(scene, a, b, c, 0);
  return scene;
}

}  // namespace copse::test
