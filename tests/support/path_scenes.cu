// Scenes put together by hand, rendering them, and a ray tracer without a tree.
#include "tests/support/path_scenes.h"

#include <cmath>
#include <cstring>

#include "builder/build.h"
#include "builder/parallel/launch.h"
#include "tracer/accel/tracers.h"

namespace copse::test {

uint32_t SceneMaker::material(const vec3& kd, const vec3& ke) {
  Material material;
  material.kd = kd;
  material.ke = ke;
  scene.materials.push_back(material);
  return static_cast<uint32_t>(scene.materials.size() - 1);
}

void SceneMaker::triangle(const vec3& a, const vec3& b, const vec3& c, uint32_t material) {
  const uint32_t first = static_cast<uint32_t>(scene.positions.size());
  scene.positions.insert(scene.positions.end(), {a, b, c});
  scene.triangles.push_back({first, first + 1, first + 2});
  scene.materialOf.push_back(material);
  if (scene.uvs.empty()) scene.uvs = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
  scene.uvTriangles.push_back({0, 1, 2});
}

void SceneMaker::parallelogram(const vec3& corner, const vec3& edge1, const vec3& edge2, uint32_t material) {
  triangle(corner, corner + edge1, corner + edge1 + edge2, material);
  triangle(corner, corner + edge1 + edge2, corner + edge2, material);
  scene.uvTriangles.back() = {0, 2, 3};
}

void SceneMaker::box(const vec3& lo, const vec3& hi, uint32_t material, int without) {
  const vec3 d = hi - lo;
  const vec3 x(d.x, 0, 0), y(0, d.y, 0), z(0, 0, d.z);
  const vec3 sides[6][3] = {{lo, y, z}, {lo + x, z, y}, {lo, z, x}, {lo + y, x, z}, {lo, x, y}, {lo + z, y, x}};
  for (int side = 0; side < 6; ++side)
    if (side != without) parallelogram(sides[side][0], sides[side][1], sides[side][2], material);
}

void SceneMaker::sphere(const vec3& centre, float radius, int levels, uint32_t material) {
  const std::function<void(vec3, vec3, vec3, int)> split = [&](vec3 a, vec3 b, vec3 c, int level) {
    if (level == 0) return triangle(centre + a * radius, centre + b * radius, centre + c * radius, material);
    const vec3 ab = glm::normalize(a + b), bc = glm::normalize(b + c), ca = glm::normalize(c + a);
    split(a, ab, ca, level - 1);
    split(ab, b, bc, level - 1);
    split(ca, bc, c, level - 1);
    split(ab, bc, ca, level - 1);
  };
  for (int k = 0; k < 8; ++k) {
    const vec3 x(k & 1 ? -1 : 1, 0, 0), y(0, k & 2 ? -1 : 1, 0), z(0, 0, k & 4 ? -1 : 1);
    split(x, y, z, levels);
  }
}

Camera lookAt(const vec3& eye, const vec3& at, float vfov) { return {"test", eye, at, {0, 1, 0}, vfov}; }

RenderSettings settings(int width, int height, int spp, int maxDepth, uint64_t seed) {
  RenderSettings s;
  s.width = width;
  s.height = height;
  s.spp = spp;
  s.maxDepth = maxDepth;
  s.seed = seed;
  return s;
}

Traced::Traced(const Device& device, const Scene& scene) : device_(device), scene_(uploadScene(device, scene)) {
  const TrianglesView triangles = trianglesOf(*scene_);
  const BuilderEntry& builder = findBuilder("lbvh");
  const Bvh bvh = buildBvh(device, triangles, builder, withPreset(builder, {}));
  tracer_ = makeTracer(device, bvh, triangles);
}

PathResult Traced::render(const Camera& camera, const RenderSettings& settings, const PathOptions& options,
                          const Watch& watch) const {
  return renderPath(device_, *scene_, *tracer_, camera, settings, watch, options);
}

namespace {

/// t of the hit, or a negative number.
HD double hitDistance(const TrianglesView& triangles, uint32_t i, const Ray& ray, double& u, double& v) {
  using dvec3 = glm::dvec3;
  const uvec3 index = triangles.indices[i];
  const dvec3 a(triangles.positions[index.x]), b(triangles.positions[index.y]), c(triangles.positions[index.z]);
  const dvec3 edge1 = b - a, edge2 = c - a, direction(ray.direction);
  const dvec3 across = glm::cross(direction, edge2), from = dvec3(ray.origin) - a;
  const double determinant = glm::dot(edge1, across);
  if (determinant == 0) return -1;
  u = glm::dot(from, across) / determinant;
  const dvec3 along = glm::cross(from, edge1);
  v = glm::dot(direction, along) / determinant;
  if (u < 0 || v < 0 || u + v > 1) return -1;
  return glm::dot(edge2, along) / determinant;
}

struct ClosestOfAll {
  TrianglesView triangles;
  const Ray* rays;
  Hit* hits;

  HD void operator()(uint32_t i) const {
    const Ray ray = rays[i];
    Hit best{ray.tMax, 0, 0, Hit::none};
    for (uint32_t k = 0; k < triangles.count; ++k) {
      double u = 0, v = 0;
      const double t = hitDistance(triangles, k, ray, u, v);
      if (t > ray.tMin && t < best.t) best = {static_cast<float>(t), static_cast<float>(u), static_cast<float>(v), k};
    }
    hits[i] = best;
  }
};

struct AnyOfAll {
  TrianglesView triangles;
  const Ray* rays;
  uint32_t* occluded;

  HD void operator()(uint32_t i) const {
    const Ray ray = rays[i];
    occluded[i] = 0;
    for (uint32_t k = 0; k < triangles.count && !occluded[i]; ++k) {
      double u = 0, v = 0;
      const double t = hitDistance(triangles, k, ray, u, v);
      if (t > ray.tMin && t < ray.tMax) occluded[i] = 1;
    }
  }
};

class BruteForce final : public RayTracer {
 public:
  explicit BruteForce(const TrianglesView& triangles) : triangles_(triangles) {}
  void closest(const Device& device, const char* name, uint32_t count, const Ray* rays, Hit* hits) const override {
    launch(device, name, count, ClosestOfAll{triangles_, rays, hits}, 64);
  }
  void any(const Device& device, const char* name, uint32_t count, const Ray* rays, uint32_t* occluded) const override {
    launch(device, name, count, AnyOfAll{triangles_, rays, occluded}, 64);
  }

 private:
  TrianglesView triangles_;
};

Mean meanOver(const Image& image, int from, int to) {
  double sum = 0, squares = 0;
  for (const vec3& pixel : image.pixels) {
    double value = 0;
    for (int k = from; k < to; ++k) value += pixel[k];
    value /= to - from;
    sum += value;
    squares += value * value;
  }
  const double n = static_cast<double>(image.pixels.size());
  const double mean = sum / n;
  return {mean, std::sqrt(std::max(0.0, squares / n - mean * mean) / std::max(1.0, n - 1))};
}

}  // namespace

std::unique_ptr<RayTracer> bruteForce(const SceneOnDevice& scene) {
  return std::make_unique<BruteForce>(trianglesOf(scene));
}

Mean meanOf(const Image& image) { return meanOver(image, 0, 3); }
Mean meanOf(const Image& image, int channel) { return meanOver(image, channel, channel + 1); }

bool allFinite(const Image& image) {
  for (const vec3& pixel : image.pixels)
    for (int k = 0; k < 3; ++k)
      if (!std::isfinite(pixel[k]) || pixel[k] < 0) return false;
  return true;
}

bool identical(const Image& a, const Image& b) {
  return a.width == b.width && a.height == b.height &&
         std::memcmp(a.pixels.data(), b.pixels.data(), a.pixels.size() * sizeof(vec3)) == 0;
}

}  // namespace copse::test
