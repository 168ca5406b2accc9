// A ball of hair with the character of Laine's Hairball: strands that are random walks with momentum and curl, each a
// tapered three-sided tube of 48 segments, 288 triangles. Long, thin and overlapping: boxes hardly fit them.
#include <array>
#include <cmath>

#include <glm/geometric.hpp>

#include "tracer/generators/generate.h"
#include "tracer/generators/random.h"

namespace copse::generator {

namespace {

using glm::dvec3;

constexpr uint32_t steps = 48, sides = 3, perStrand = steps * sides * 2;
constexpr uint32_t maxTriangles = 50'000'160;  // 173,612 strands
constexpr double innermost = 0.5, outermost = 0.88, thickness = 0.0032, stepLength = 0.028;

using Path = std::array<dvec3, steps + 1>;

/// Starts at radius 0.45 to 0.6 outwards, keeps its direction, curls about an axis of its own, and stays in the shell.
Path walk(Random& random) {
  Path path;
  const dvec3 out = random.direction();
  dvec3 p = out * random.between(0.45, 0.6);
  dvec3 direction = glm::normalize(out + 0.6 * random.direction());
  const dvec3 axis = random.direction();
  const double curl = random.between(0.05, 0.35);
  for (uint32_t i = 0; i <= steps; ++i) {
    path[i] = p;
    dvec3 turn = curl * glm::cross(axis, direction) + 0.28 * random.direction();
    const double r = glm::length(p);
    const dvec3 radial = p / r;
    if (r > outermost - 0.08) turn -= radial * (6 * (r - outermost + 0.08));
    if (r < innermost + 0.06) turn += radial * (6 * (innermost + 0.06 - r));
    direction = glm::normalize(direction + turn);
    p += stepLength * direction;
    const double reached = glm::length(p);
    if (reached > outermost) p *= outermost / reached;
    if (reached < innermost && i > 6) p *= innermost / reached;
  }
  return path;
}

void addStrand(Scene& scene, const Path& path, uint32_t material) {
  const uint32_t first = static_cast<uint32_t>(scene.positions.size());
  dvec3 across = glm::cross(path[1] - path[0], dvec3(0.36, 0.48, 0.8));
  for (uint32_t i = 0; i <= steps; ++i) {
    const dvec3 along = glm::normalize(i < steps ? path[i + 1] - path[i] : path[i] - path[i - 1]);
    // The frame is carried along the strand, so that the tube does not twist on itself.
    across = glm::normalize(across - along * glm::dot(across, along));
    const dvec3 other = glm::cross(along, across);
    const double radius = thickness * (1 - 0.9 * i / steps);
    constexpr double half = 0.5, height = 0.8660254037844386;
    for (const dvec3& q : {across, -half * across + height * other, -half * across - height * other})
      scene.positions.push_back(vec3(path[i] + radius * q));
  }
  for (uint32_t i = 0; i < steps; ++i)
    for (uint32_t k = 0; k < sides; ++k) {
      const uint32_t a = first + i * sides + k, b = first + i * sides + (k + 1) % sides;
      scene.triangles.push_back({a, b, b + sides});
      scene.triangles.push_back({a, b + sides, a + sides});
      scene.materialOf.insert(scene.materialOf.end(), 2, material);
    }
}

}  // namespace

Scene generateHairball(uint32_t triangles, uint64_t seed) {
  checkRange("hairball", triangles, perStrand, maxTriangles);
  const uint32_t strands = (triangles + perStrand / 2) / perStrand;
  Scene scene;
  scene.name = "hairball";
  scene.materials = {{.name = "chestnut", .kd = {0.58f, 0.36f, 0.2f}},
                     {.name = "straw", .kd = {0.76f, 0.6f, 0.36f}},
                     {.name = "ash", .kd = {0.62f, 0.57f, 0.52f}}};
  scene.positions.reserve(std::size_t{strands} * (steps + 1) * sides);
  scene.triangles.reserve(std::size_t{strands} * perStrand);
  scene.materialOf.reserve(std::size_t{strands} * perStrand);
  for (uint32_t i = 0; i < strands; ++i) {
    Random random(seed, i);
    addStrand(scene, walk(random), i % 3);
  }

  // Cameras of Meister's hippie (test/Comparison/env.py), given there for the mesh scaled into a unit box.
  constexpr float lo = -0.9f, extent = 1.8f;
  const auto camera = [&](const char* name, vec3 p, vec3 direction) {
    const vec3 eye = vec3(lo) + p * extent;
    scene.cameras.push_back({name, eye, eye + direction, {0, 1, 0}, 45});
  };
  camera("outside", {1.1f, -0.23f, -0.48f}, {-0.4f, 0.54f, 0.74f});
  camera("beside", {-0.47f, 0.42f, -0.44f}, {0.74f, 0.07f, 0.67f});
  camera("close", {0.1f, 0.54f, 0.85f}, {0.74f, -0.12f, -0.66f});
  scene.sky = SkyLight{.radiance = {0.7f, 0.8f, 1.0f}, .file = {}, .image = {}};
  scene.quads.push_back({{-0.9f, 2.6f, -0.9f}, {1.2f, 0, 0}, {0, 0, 1.2f}, {14, 12.5f, 10}});
  return scene;
}

}  // namespace copse::generator
