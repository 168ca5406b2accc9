// One call a pixel adds a batch's samples in their order.
#include "tracer/integrators/clusters.h"

#include <cmath>

#include "builder/parallel/launch.h"
#include "tracer/integrators/box_lines.h"
#include "tracer/integrators/path/surface.h"

namespace copse {

namespace {

/// Of a line with its rim, in pixels: representatives are small, being mean boxes of triangles.
float lineHalfWidth(int height) { return std::fmax(1.5f, height / 400.0f); }

struct alignas(16) ClusterSums {
  double colour[3];
  int32_t first;  ///< Cluster of the first sample.
};

struct AddClusters {
  SceneView scene;
  const uint32_t* clusterOf;
  const vec3* palette;
  EdgesView edges;
  bool drawEdges;
  PrimaryBatch batch;
  vec3 forward;
  uint64_t seed;
  uint32_t width, pixels;
  ClusterSums* sums;

  HD void operator()(uint32_t j) const {
    const uint32_t pixel = static_cast<uint32_t>((batch.first + j) % pixels);
    ClusterSums sum = sums[pixel];
    for (uint64_t i = j; i < batch.count; i += pixels) {
      const uint64_t sample = (batch.first + i) / pixels;
      const Hit hit = batch.hits[i];
      const bool hits = hit.triangle != Hit::none;
      if (sample == 0 && hits) sum.first = static_cast<int32_t>(clusterOf[hit.triangle]);
      const vec3 direction = batch.rays[i].direction;
      vec3 colour = hits ? surface(hit, direction) : vec3(0);
      if (drawEdges) {
        const vec2 point = samplePoint(width, pixel, randomKey(seed, pixel, sample));
        drawLine(point, hits ? hit.t * glm::dot(direction, forward) : FLT_MAX, colour);
      }
      for (int c = 0; c < 3; ++c) sum.colour[c] += colour[c];
    }
    sums[pixel] = sum;
  }

 private:
  /// Light from the eye, and some from everywhere.
  HD vec3 surface(const Hit& hit, const vec3& direction) const {
    const SurfaceTriangle triangle = scene.triangles[hit.triangle];
    const float cosine = fabsf(glm::dot(unitNormal(triangle.edge1, triangle.edge2), direction));
    return palette[clusterOf[hit.triangle]] * (0.15f + 0.85f * cosine);
  }

  HD void drawLine(const vec2& point, float depth, vec3& colour) const {
    const EdgeHit edge = nearestEdge(edges, point.x, point.y);
    if (edge.box == EdgeHit::none) return;
    const vec3 line = edge.isRim ? vec3(0) : palette[edge.box] * 0.2f + vec3(0.8f);
    const bool visible = edge.depth <= depth * 1.001f;
    colour += (line - colour) * (visible ? 1.0f : 0.4f);
  }
};

struct MeanColours {
  const ClusterSums* sums;
  uint64_t whole;  ///< Samples that every pixel has.
  uint32_t more;   ///< Pixels below it have one more.
  vec3* colours;
  float* clusters;

  HD void operator()(uint32_t i) const {
    const uint64_t samples = whole + (i < more ? 1 : 0);
    for (int c = 0; c < 3; ++c)
      colours[i][c] = samples ? static_cast<float>(sums[i].colour[c] / static_cast<double>(samples)) : 0;
    clusters[i] = static_cast<float>(sums[i].first);
  }
};

struct StartSums {
  ClusterSums* sums;
  HD void operator()(uint32_t i) const { sums[i] = {{0, 0, 0}, -1}; }
};

class ClusterFilm final : public PrimaryFilm {
 public:
  ClusterFilm(const Device& device, const AddClusters& kernel) : kernel_(kernel), sums_(device, kernel.pixels) {
    kernel_.sums = sums_.data();
    launch(device, "clusters", kernel.pixels, StartSums{sums_.data()});
  }

  void add(const Device& device, const PrimaryBatch& batch) override {
    kernel_.batch = batch;
    launch(device, "clusters", batch.count < kernel_.pixels ? batch.count : kernel_.pixels, kernel_);
  }

  void finish(const Device& device, ClusterPicture& picture) const {
    const uint32_t pixels = kernel_.pixels;
    Buffer<vec3> colours(device, pixels);
    Buffer<float> clusters(device, pixels);
    launch(device, "clusters", pixels,
           MeanColours{sums_.data(), picture.samples / pixels, static_cast<uint32_t>(picture.samples % pixels),
                       colours.data(), clusters.data()});
    picture.image.pixels = colours.toHost();
    picture.cluster = clusters.toHost();
  }

 private:
  AddClusters kernel_;
  Buffer<ClusterSums> sums_;
};

}  // namespace

vec3 clusterColour(uint32_t cluster) {
  // Colours on a screen, by hue; every third number is lighter, and every fifth is paler.
  const double hue = 6 * std::fmod(0.08 + cluster * 0.6180339887498949, 1.0);
  const double value = cluster % 3 == 1 ? 1.0 : 0.82, saturation = cluster % 5 == 2 ? 0.45 : 0.72;
  vec3 colour;
  for (int c = 0; c < 3; ++c) {
    const double away = std::abs(std::fmod(hue + 6 - 2 * c, 6.0) - 3) - 1;  // 0 … 1 is between the primaries.
    const double shown = value * (1 - saturation * (1 - std::fmin(std::fmax(away, 0), 1)));
    colour[c] = static_cast<float>(std::pow(shown, 2.2));
  }
  return colour;
}

ClusterPicture renderClusters(const Device& device, const SceneView& scene, const RayTracer& tracer,
                              const PassClusters& clusters, const View& view, const RenderSettings& settings,
                              bool boxes, const Watch& watch, uint32_t queue) {
  checkSettings(settings);
  const Camera camera = makeCamera(view, settings.width, settings.height);
  std::vector<vec3> colours;
  for (std::size_t i = 0; i < clusters.representatives.size(); ++i)
    colours.push_back(clusterColour(static_cast<uint32_t>(i)));
  const Buffer<vec3> palette(device, std::span<const vec3>(colours));
  std::span<const Box> drawn = clusters.representatives;
  if (!boxes || drawn.size() > mostBoxesDrawn) drawn = {};
  const EdgesOnScreen edges(device, drawn, camera, settings.width, settings.height, lineHalfWidth(settings.height));

  const auto width = static_cast<uint32_t>(settings.width), pixels = width * static_cast<uint32_t>(settings.height);
  ClusterFilm film(device, {scene,
                            clusters.clusterOf.data(),
                            palette.data(),
                            edges.view(),
                            !drawn.empty(),
                            {},
                            camera.forward(),
                            settings.seed,
                            width,
                            pixels,
                            nullptr});
  ClusterPicture picture;
  picture.image = {settings.width, settings.height, {}};
  picture.samples = tracePrimary(device, tracer, camera, settings, film, watch, queue);
  film.finish(device, picture);
  return picture;
}

}  // namespace copse
