// The rendering equation as it stands. Light of triangles and quads is sampled uniformly over their total area; the
// sky's comes from cosine-distributed bounces that leave the scene. Neither is sampled both ways, and there is no
// Russian roulette: the price is variance.
#include "tracer/integrators/reference/reference.h"

#include <omp.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>

#include "builder/base/error.h"
#include "tracer/integrators/reference/tree.h"

namespace copse {

using glm::dvec3;

namespace {

constexpr double pi = std::numbers::pi;

/// PCG32: O'Neill, "PCG: A Family of Simple Fast Space-Efficient Statistically Good Algorithms", 2014; its start is
/// mixed by SplitMix64: Steele, Lea and Flood, "Fast Splittable Pseudorandom Number Generators", 2014.
class Random {
 public:
  Random(uint64_t seed, uint64_t pixel, uint64_t sample)
      : state_(mix(seed + mix(sample + mix(pixel)))), stream_(mix(state_) | 1) {}
  /// In [0, 1).
  double uniform() { return next() * 0x1p-32 + next() * 0x1p-64; }

 private:
  uint32_t next() {
    const uint64_t old = state_;
    state_ = old * 6364136223846793005u + stream_;
    const auto mixed = static_cast<uint32_t>((old >> 18 ^ old) >> 27);
    const auto turn = static_cast<uint32_t>(old >> 59);
    return mixed >> turn | mixed << (-turn & 31);
  }
  static uint64_t mix(uint64_t x) {
    x += 0x9e3779b97f4a7c15u;
    x = (x ^ x >> 30) * 0xbf58476d1ce4e5b9u;
    x = (x ^ x >> 27) * 0x94d049bb133111ebu;
    return x ^ x >> 31;
  }
  uint64_t state_, stream_;
};

/// Between the four texels around (x, y), both in texels; columns repeat, rows do or stay at the edge.
template <class Pixels>
dvec3 bilinear(const Pixels& image, double x, double y, bool rowsRepeat) {
  const double x0 = std::floor(x - 0.5), y0 = std::floor(y - 0.5);
  const auto texel = [&](double column, double row) -> dvec3 {
    const double w = image.width, h = image.height;
    column -= w * std::floor(column / w);
    row = rowsRepeat ? row - h * std::floor(row / h) : std::clamp(row, 0.0, h - 1);
    return image.at(static_cast<int>(column), static_cast<int>(row));
  };
  const double fx = x - 0.5 - x0, fy = y - 0.5 - y0;
  return (texel(x0, y0) * (1 - fx) + texel(x0 + 1, y0) * fx) * (1 - fy) +
         (texel(x0, y0 + 1) * (1 - fx) + texel(x0 + 1, y0 + 1) * fx) * fy;
}

class Tracer {
 public:
  Tracer(const Scene& scene, const ReferenceTree& tree, const RenderSettings& settings)
      : scene_(scene), tree_(tree), settings_(settings) {
    for (uint32_t i = 0; i < scene.triangles.size(); ++i)
      if (scene.emits(i)) addLight(i, glm::length(tree.normal(i)) / 2);
    triangleLights_ = static_cast<uint32_t>(lights_.size());
    for (uint32_t i = 0; i < scene.quads.size(); ++i)
      addLight(i, glm::length(glm::cross(dvec3(scene.quads[i].edgeU), dvec3(scene.quads[i].edgeV))));
    const Box box = scene.bounds();
    if (!box.empty())
      for (int axis = 0; axis < 3; ++axis)
        epsilon_ = std::max({epsilon_, 1e-9 * std::abs(double{box.lo[axis]}), 1e-9 * std::abs(double{box.hi[axis]})});
  }

  /// Radiance that arrives at `origin` against `direction`, for a path already lit `depth` times.
  dvec3 radiance(const dvec3& origin, const dvec3& direction, int depth, Random& random, uint64_t* rays) const {
    ++rays[depth == 0 ? 0 : 1];
    ReferenceHit hit;
    if (!tree_.closest(origin, direction, depth == 0 ? 0 : epsilon_, infinity, hit)) return sky(direction);
    const Material& material = scene_.materials[scene_.materialOf[hit.triangle]];
    dvec3 light(0);
    if (depth == 0) light += dvec3(material.ke);
    const dvec3 albedo = albedoAt(hit, material);
    if (depth == settings_.maxDepth || albedo == dvec3(0)) return light;

    const dvec3 point = origin + hit.t * direction;
    dvec3 normal = glm::normalize(tree_.normal(hit.triangle));
    if (glm::dot(normal, direction) > 0) normal = -normal;
    light += albedo / pi * irradiance(point, normal, random, rays);
    // The last hit's bounce can only find the sky.
    if (depth + 1 < settings_.maxDepth || scene_.sky)
      light += albedo * radiance(point, cosineSample(normal, random), depth + 1, random, rays);
    return light;
  }

 private:
  static constexpr double infinity = std::numeric_limits<double>::infinity();

  void addLight(uint32_t index, double area) {
    lights_.push_back(index);
    areaUpTo_.push_back((areaUpTo_.empty() ? 0 : areaUpTo_.back()) + (std::isfinite(area) ? area : 0));
  }

  /// From triangles and quads: the mean over `lightSamples` points, one from each stratum of their total area.
  dvec3 irradiance(const dvec3& point, const dvec3& normal, Random& random, uint64_t* rays) const {
    dvec3 sum(0);
    const double area = areaUpTo_.empty() ? 0 : areaUpTo_.back();
    for (int i = 0; i < settings_.lightSamples && area > 0; ++i) {
      const double where = (i + random.uniform()) / settings_.lightSamples * area;
      const auto found = std::upper_bound(areaUpTo_.begin(), areaUpTo_.end(), where) - areaUpTo_.begin();
      const auto light = static_cast<uint32_t>(std::min<std::ptrdiff_t>(found, std::ssize(areaUpTo_) - 1));
      double s = random.uniform(), t = random.uniform();
      dvec3 place, lightNormal, emitted;
      const bool triangle = light < triangleLights_;
      if (triangle) {
        const uint32_t index = lights_[light];
        if (s + t > 1) s = 1 - s, t = 1 - t;
        const dvec3 a = tree_.vertex(index, 0);
        place = a + s * (tree_.vertex(index, 1) - a) + t * (tree_.vertex(index, 2) - a);
        lightNormal = tree_.normal(index);
        emitted = scene_.materials[scene_.materialOf[index]].ke;
      } else {
        const QuadLight& quad = scene_.quads[lights_[light]];
        place = dvec3(quad.corner) + s * dvec3(quad.edgeU) + t * dvec3(quad.edgeV);
        lightNormal = glm::cross(dvec3(quad.edgeU), dvec3(quad.edgeV));
        emitted = quad.radiance;
      }
      const double distance = glm::length(place - point);
      if (!(distance > 2 * epsilon_)) continue;
      const dvec3 direction = (place - point) / distance;
      const double cosine = glm::dot(normal, direction);
      double lightCosine = -glm::dot(glm::normalize(lightNormal), direction);
      if (triangle) lightCosine = std::abs(lightCosine);
      if (cosine <= 0 || lightCosine <= 0) continue;
      ++rays[2];
      if (!tree_.occluded(point, direction, epsilon_, distance - epsilon_))
        sum += emitted * (cosine * lightCosine * area / (distance * distance * settings_.lightSamples));
    }
    return sum;
  }

  dvec3 sky(const dvec3& direction) const {
    if (!scene_.sky) return dvec3(0);
    const Image& image = scene_.sky->image;
    if (image.pixels.empty()) return scene_.sky->radiance;
    const dvec3 d = glm::normalize(direction);
    return bilinear(image, (0.5 + std::atan2(d.x, -d.z) / (2 * pi) + scene_.sky->rotation / 360) * image.width,
                    std::acos(std::clamp(d.y, -1.0, 1.0)) / pi * image.height, false);
  }

  dvec3 albedoAt(const ReferenceHit& hit, const Material& material) const {
    dvec3 albedo = material.kd;
    if (material.texture >= 0 && !scene_.uvTriangles.empty()) {
      const Texels* texels = scene_.textures[material.texture].texels.get();
      double u = 0, v = 0;
      for (int corner = 0; corner < 3; ++corner) {
        const vec2 uv = scene_.uvs[scene_.uvTriangles[hit.triangle][corner]];
        u += hit.b[corner] * uv.x;
        v += hit.b[corner] * uv.y;
      }
      if (texels && std::isfinite(u) && std::isfinite(v))
        albedo =
            bilinear(*texels, (u - std::floor(u)) * texels->width, (1 - (v - std::floor(v))) * texels->height, true);
    }
    return glm::clamp(albedo, 0.0, 1.0);
  }

  static dvec3 cosineSample(const dvec3& normal, Random& random) {
    const double u = random.uniform(), angle = 2 * pi * random.uniform();
    const dvec3 across = glm::normalize(glm::cross(std::abs(normal.x) < 0.5 ? dvec3(1, 0, 0) : dvec3(0, 1, 0), normal));
    const dvec3 other = glm::cross(normal, across);
    return std::sqrt(u) * (std::cos(angle) * across + std::sin(angle) * other) + std::sqrt(1 - u) * normal;
  }

  const Scene& scene_;
  const ReferenceTree& tree_;
  const RenderSettings& settings_;
  std::vector<uint32_t> lights_;  // Triangles, then quads, by their index in the scene.
  std::vector<double> areaUpTo_;  // Cumulative area of the lights, each included.
  uint32_t triangleLights_ = 0;
  double epsilon_ = 1e-12;
};

double milliseconds(std::chrono::steady_clock::time_point since) {
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - since).count();
}

}  // namespace

ReferenceResult renderReference(const Scene& scene, const Camera& camera, const RenderSettings& settings, int threads,
                                const Watch& watch) {
  if (settings.width < 1 || settings.height < 1 || settings.spp < 1 || settings.lightSamples < 1 ||
      settings.maxDepth < 0 || settings.maxDepth > 1000)
    throw InputError("expected at least 1 pixel, sample and light sample, and a maximum depth from 0 to 1000");
  ReferenceResult result;
  const auto started = std::chrono::steady_clock::now();
  const ReferenceTree tree(scene);
  result.buildMs = milliseconds(started);
  const auto built = std::chrono::steady_clock::now();

  const Tracer tracer(scene, tree, settings);
  const int width = settings.width, height = settings.height;
  const dvec3 eye = camera.exactEye(), forward = glm::normalize(camera.exactAt() - eye);
  const dvec3 right = glm::normalize(glm::cross(forward, dvec3(camera.up))), up = glm::cross(right, forward);
  const double tangent = std::tan(camera.vfov * pi / 360);
  std::vector<dvec3> sums(static_cast<std::size_t>(width) * height, dvec3(0));
  std::vector<int> samples(height, 0);  // Per row: a render that is stopped has more in some.
  std::atomic<int64_t> rowsDone{0};
  uint64_t primary = 0, bounce = 0, shadow = 0;

#pragma omp parallel num_threads(threads > 0 ? threads : omp_get_max_threads()) reduction(+ : primary, bounce, shadow)
  {
    uint64_t rays[3] = {0, 0, 0};
    for (int sample = 0; sample < settings.spp; ++sample) {
#pragma omp for schedule(dynamic, 1)
      for (int y = 0; y < height; ++y) {
        if (watch.stop && *watch.stop) continue;
        for (int x = 0; x < width; ++x) {
          const std::size_t pixel = static_cast<std::size_t>(y) * width + x;
          Random random(settings.seed, pixel, static_cast<uint64_t>(sample));
          const double px = (2 * (x + random.uniform()) - width) / height * tangent;
          const double py = (height - 2 * (y + random.uniform())) / height * tangent;
          sums[pixel] += tracer.radiance(eye, glm::normalize(forward + px * right + py * up), 0, random, rays);
        }
        ++samples[y];
        const int64_t done = ++rowsDone;
        if (watch.progress && omp_get_thread_num() == 0)
          watch.progress(static_cast<double>(done) / (static_cast<double>(height) * settings.spp));
      }
    }
    primary += rays[0];
    bounce += rays[1];
    shadow += rays[2];
  }

  result.image = {width, height, std::vector<vec3>(sums.size(), vec3(0))};
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x)
      result.image.at(x, y) = vec3(sums[static_cast<std::size_t>(y) * width + x] / std::max(1.0, double(samples[y])));
  result.rays[0] = primary;
  result.rays[1] = bounce;
  result.rays[2] = shadow;
  result.samplesDone = static_cast<double>(rowsDone) / height;
  result.renderMs = milliseconds(built);
  return result;
}

}  // namespace copse
