// What a sample shows of clusters, and the mean colour of a pixel.
#include "tracer/integrators/clusters/clusters.h"

#include <cmath>

#include "tracer/integrators/clusters/box_lines.h"
#include "tracer/integrators/film.h"
#include "tracer/materials/surface.h"

namespace copse {

namespace {

/// Half the width of a line with its rim, in pixels: representatives are small, being mean boxes of triangles.
float lineHalfWidth(int height) { return std::fmax(1.5f, height / 400.0f); }

/// The film's sum: one sample, or all samples of a pixel.
struct alignas(16) ClusterSums {
  double colour[3];
  uint32_t first;  ///< 1 + the cluster that the first sample hits; 0 for none.

  HD ClusterSums& operator+=(const ClusterSums& other) {
    for (int c = 0; c < 3; ++c) colour[c] += other.colour[c];
    first += other.first;
    return *this;
  }
};

struct ShowClusters {
  SceneView scene;
  const uint32_t* clusterOf;
  const vec3* palette;
  EdgesView edges;
  bool drawEdges;
  vec3 forward;
  float start;  ///< As Pinhole's.
  uint64_t seed;
  uint32_t width;
  const Ray* rays;
  const Hit* hits;

  HD ClusterSums operator()(const FilmSample& sample) const {
    const Hit hit = hits[sample.place];
    const bool isHit = hit.triangle != Hit::none;
    const vec3 direction = rays[sample.place].direction;
    vec3 colour = isHit ? surface(hit, direction) : vec3(0);
    if (drawEdges) {
      const vec2 point = samplePoint(width, sample.pixel, randomKey(seed, sample.pixel, sample.number));
      drawLine(point, isHit ? start + hit.t * glm::dot(direction, forward) : FLT_MAX, colour);
    }
    return {{colour.x, colour.y, colour.z}, sample.number == 0 && isHit ? clusterOf[hit.triangle] + 1 : 0u};
  }

 private:
  /// A light at the eye, and some ambient light.
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
  vec3* colours;
  float* clusters;

  HD void operator()(uint32_t pixel, const ClusterSums& sum, uint64_t samples) const {
    for (int c = 0; c < 3; ++c)
      colours[pixel][c] = samples ? static_cast<float>(sum.colour[c] / static_cast<double>(samples)) : 0;
    clusters[pixel] = static_cast<float>(static_cast<int32_t>(sum.first) - 1);
  }
};

class ClusterFilm final : public PrimaryFilm {
 public:
  ClusterFilm(const Device& device, const ShowClusters& show, const PixelOrder& order)
      : show_(show), film_(device, order) {}

  void add(const Device& device, const PrimaryBatch& batch) override {
    show_.rays = batch.rays;
    show_.hits = batch.hits;
    film_.add(device, phases::clusters, batch.first, batch.count, show_);
  }

  void finish(const Device& device, ClusterPicture& picture) {
    Buffer<vec3> colours(device, film_.pixels());
    Buffer<float> clusters(device, film_.pixels());
    film_.finish(device, phases::clusters, picture.samples, MeanColours{colours.data(), clusters.data()});
    picture.image.pixels = colours.toHost();
    picture.cluster = clusters.toHost();
  }

 private:
  ShowClusters show_;
  Film<ClusterSums> film_;
};

}  // namespace

vec3 clusterColour(uint32_t cluster) {
  // sRGB by hue; every third number is lighter, and every fifth is paler.
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
                              const PassClusters& clusters, const Camera& camera, const RenderSettings& settings,
                              bool boxes, const Watch& watch, uint32_t queue) {
  checkSettings(settings);
  const Pinhole pinhole = makePinhole(camera, settings.width, settings.height);
  std::vector<vec3> colours;
  for (std::size_t i = 0; i < clusters.representatives.size(); ++i)
    colours.push_back(clusterColour(static_cast<uint32_t>(i)));
  const Buffer<vec3> palette(device, std::span<const vec3>(colours));
  std::span<const Box> drawn = clusters.representatives;
  if (!boxes || drawn.size() > maxBoxesDrawn) drawn = {};
  const EdgesOnScreen edges(device, drawn, pinhole, settings.width, settings.height, lineHalfWidth(settings.height));

  const PixelOrder order(device, settings.width, settings.height);
  ClusterFilm film(device,
                   {scene, clusters.clusterOf.data(), palette.data(), edges.view(), !drawn.empty(), pinhole.forward(),
                    pinhole.start, settings.seed, static_cast<uint32_t>(settings.width), nullptr, nullptr},
                   order);
  ClusterPicture picture;
  picture.image = {settings.width, settings.height, {}};
  picture.samples = tracePrimary(device, tracer, pinhole, settings, order, film, watch, queue);
  film.finish(device, picture);
  return picture;
}

}  // namespace copse
