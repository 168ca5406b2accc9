// A sculpture as a scanner sees it: one closed surface of small triangles of nearly one size, as in Stanford's scans,
// whose number it has by default. The cell is chosen so that the quads make a little less than the count asked for;
// the largest are cut into four around their centres for the rest.
#include <algorithm>
#include <cmath>
#include <numeric>

#include <glm/geometric.hpp>

#include "tracer/generators/generate.h"
#include "tracer/generators/statue_figure.h"

namespace copse::generator {

namespace {

constexpr uint32_t minTriangles = 1'000, maxTriangles = 50'000'000;

/// A mesh of at most `quads` quads, and not many less. Their number is nearly the area over cell²; the area that a
/// twice coarser mesh sees is close to its own.
QuadMesh meshOf(const DistanceField& field, std::size_t quads) {
  const auto seen = [&](double cell) {
    return cell * cell * static_cast<double>(surfaceNets(field, cell).quads.size());
  };
  const auto cellFor = [&](double area, double share) {
    return std::sqrt(area / (share * static_cast<double>(quads)));
  };
  double area = seen(0.04);
  area = seen(std::min(0.04, 2 * cellFor(area, 1)));
  for (double share = 0.97;; share *= 0.97) {
    QuadMesh mesh = surfaceNets(field, cellFor(area, share));
    if (mesh.quads.size() <= quads) return mesh;
  }
}

float areaOf(const QuadMesh& mesh, const std::array<uint32_t, 4>& q) {
  return glm::length(
      glm::cross(mesh.positions[q[2]] - mesh.positions[q[0]], mesh.positions[q[3]] - mesh.positions[q[1]]));
}

void addTriangles(Scene& scene, const Figure& figure, QuadMesh mesh, uint32_t triangles) {
  const std::size_t count = mesh.quads.size(), cut = std::min(count, triangles / 2 - count);
  std::vector<uint32_t> byArea(count);
  std::iota(byArea.begin(), byArea.end(), 0u);
  std::vector<float> area(count);
  for (std::size_t i = 0; i < count; ++i) area[i] = areaOf(mesh, mesh.quads[i]);
  // Ties by index: the same everywhere.
  const auto larger = [&](uint32_t a, uint32_t b) { return area[a] != area[b] ? area[a] > area[b] : a < b; };
  std::nth_element(byArea.begin(), byArea.begin() + static_cast<std::ptrdiff_t>(cut), byArea.end(), larger);
  std::vector<bool> isCut(count);
  for (std::size_t i = 0; i < cut; ++i) isCut[byArea[i]] = true;

  scene.positions = std::move(mesh.positions);
  scene.positions.reserve(scene.positions.size() + cut);
  scene.triangles.reserve(2 * (count + cut));
  scene.materialOf.reserve(2 * (count + cut));
  for (std::size_t i = 0; i < count; ++i) {
    const auto& [a, b, c, d] = mesh.quads[i];
    const vec3 pa = scene.positions[a], pb = scene.positions[b], pc = scene.positions[c], pd = scene.positions[d];
    const vec3 centre = 0.25f * (pa + pb + pc + pd);
    if (isCut[i]) {
      const uint32_t middle = static_cast<uint32_t>(scene.positions.size());
      scene.positions.push_back(centre);
      for (const uvec3& t : {uvec3(a, b, middle), {b, c, middle}, {c, d, middle}, {d, a, middle}})
        scene.triangles.push_back(t);
    } else if (glm::dot(pc - pa, pc - pa) <= glm::dot(pd - pb, pd - pb)) {
      scene.triangles.push_back({a, b, c});
      scene.triangles.push_back({a, c, d});
    } else {
      scene.triangles.push_back({a, b, d});
      scene.triangles.push_back({b, c, d});
    }
    scene.materialOf.resize(scene.triangles.size(), figure.partAt(dvec3(centre)));
  }
}

}  // namespace

Scene generateStatue(uint32_t triangles, uint64_t seed) {
  checkRange("statue", triangles, minTriangles, maxTriangles);
  Scene scene;
  scene.name = "statue";
  scene.materials = {{.name = "marble", .kd = {0.72f, 0.68f, 0.6f}},
                     {.name = "bronze", .kd = {0.42f, 0.25f, 0.1f}},
                     {.name = "granite", .kd = {0.2f, 0.21f, 0.23f}}};
  const Figure figure(seed);
  addTriangles(scene, figure, meshOf(figure, triangles / 2), triangles);

  scene.cameras = {{"front", {0.55f, 1.05f, 4.0f}, {0, 0.67f, 0}, {0, 1, 0}, 38},
                   {"bust", {-0.55f, 1.62f, 1.25f}, {0.01f, 1.42f, 0.05f}, {0, 1, 0}, 38},
                   {"hem", {1.15f, 0.5f, 1.5f}, {0, 0.28f, 0}, {0, 1, 0}, 42}};
  // As in a museum: a warm lamp from the left front, a cool one from behind on the right, dim walls all around.
  scene.sky = SkyLight{.radiance = {0.05f, 0.056f, 0.07f}, .file = {}, .image = {}};
  scene.quads = {lampAt({-2.9f, 3.1f, 2.6f}, {0, 0.9f, 0}, 1.3f, {22, 19, 15}),
                 lampAt({2.7f, 2.4f, -2.4f}, {0, 1, 0}, 1.3f, {15, 18, 24})};
  return scene;
}

}  // namespace copse::generator
