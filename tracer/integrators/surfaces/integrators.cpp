// Normals, albedo and depth as integrators: the buffers that are rendered, their channels, and their values as sRGB
// colours.
#include <algorithm>
#include <cmath>
#include <iterator>

#include "builder/parallel/timed.h"
#include "tracer/integrators/integrator.h"
#include "tracer/integrators/surfaces/channels.h"
#include "tracer/scene/colour.h"

namespace copse {

std::vector<Channel> channelsOf(const SurfaceBuffers& surfaces) {
  std::vector<Channel> channels;
  for (int c = 0; c < 6; ++c) {
    const Image& image = c < 3 ? surfaces.normals : surfaces.albedo;
    std::vector<float> values;
    values.reserve(image.pixels.size());
    for (const vec3& pixel : image.pixels) values.push_back(pixel[c % 3]);
    channels.push_back({surfaceChannels[c], std::move(values)});
  }
  channels.push_back({surfaceChannels[6], surfaces.depth});
  return channels;
}

namespace {

/// Maps -1 … 1 to 0 … 1.
Image normalsOnScreen(const Image& normals) {
  Image shown = normals;
  for (vec3& pixel : shown.pixels)
    for (int c = 0; c < 3; ++c) pixel[c] = linearOfScreen((pixel[c] + 1) / 2);
  return shown;
}

/// What is nearest is white, what is farthest dark grey, and nothing is black.
Image depthOnScreen(const std::vector<float>& depth, int width, int height) {
  float nearest = INFINITY, farthest = 0;
  for (const float z : depth) {
    if (!std::isfinite(z)) continue;
    nearest = std::min(nearest, z);
    farthest = std::max(farthest, z);
  }
  const float range = farthest > nearest ? farthest - nearest : 1;
  Image shown{width, height, {}};
  for (const float z : depth)
    shown.pixels.push_back(vec3(std::isfinite(z) ? linearOfScreen(1 - 0.85f * (z - nearest) / range) : 0));
  return shown;
}

Image depthAsImage(const std::vector<float>& depth, int width, int height) {
  Image image{width, height, {}};
  for (const float z : depth) image.pixels.push_back(vec3(std::isfinite(z) ? z : 0));
  return image;
}

void showNormals(Picture& picture, SurfaceBuffers& buffers) {
  picture.preview = normalsOnScreen(buffers.normals);
  picture.image = std::move(buffers.normals);
}
void showAlbedo(Picture& picture, SurfaceBuffers& buffers) { picture.image = std::move(buffers.albedo); }
void showDepth(Picture& picture, SurfaceBuffers& buffers) {
  const int width = buffers.normals.width, height = buffers.normals.height;
  picture.image = depthAsImage(buffers.depth, width, height);
  picture.preview = depthOnScreen(buffers.depth, width, height);
}

class SurfaceIntegrator final : public Integrator {
 public:
  using Show = void (*)(Picture&, SurfaceBuffers&);

  SurfaceIntegrator(const IntegratorInput& input, std::span<const char* const> channels, Show show)
      : scene_(*input.onDevice), tracer_(*input.tracer), channels_(channels), show_(show) {}

  Picture render(const Device& device, const Camera& camera, const RenderSettings& settings,
                 const Watch& watch) const override {
    Picture picture;
    SurfaceResult result;
    picture.renderMs = timed(device, picture.renderPhases, [&](const Device& recording) {
      result = renderSurfaces(recording, scene_.view(), tracer_, camera, settings, watch);
    });
    picture.samplesDone = static_cast<double>(result.samples) / settings.width / settings.height;
    picture.rays.primary = result.samples;
    for (Channel& channel : channelsOf(result.buffers))
      if (std::find(channels_.begin(), channels_.end(), channel.name) != channels_.end())
        picture.channels.push_back(std::move(channel));
    show_(picture, result.buffers);
    return picture;
  }

 private:
  const SceneOnDevice& scene_;
  const TreeTracer& tracer_;
  std::span<const char* const> channels_;
  Show show_;
};

constexpr PhaseName phaseNames[] = {phases::generate, phases::tracePrimary, phases::surfaces};

/// Its channels are `count` of surfaceChannels from `first` on, with --aov all of them.
template <std::size_t first, std::size_t count, SurfaceIntegrator::Show show>
constexpr IntegratorEntry entry(const char* name, const char* meaning) {
  constexpr std::span<const char* const> all = surfaceChannels;
  return {.name = name,
          .meaning = meaning,
          .takes = {.aov = true},
          .channels = all.subspan(first, count),
          .phases = phaseNames,
          .make = [](const Device&, const IntegratorInput& input,
                     const IntegratorOptions& options) -> std::unique_ptr<const Integrator> {
            constexpr std::span<const char* const> channels = surfaceChannels;
            return std::make_unique<SurfaceIntegrator>(input, options.aov ? channels : channels.subspan(first, count),
                                                       show);
          }};
}

}  // namespace

extern const IntegratorEntry normalsIntegrator, albedoIntegrator, depthIntegrator;
constinit const IntegratorEntry normalsIntegrator =
    entry<0, 3, showNormals>("normals", "surface normals, facing the eye");
constinit const IntegratorEntry albedoIntegrator = entry<3, 3, showAlbedo>("albedo", "surface albedo");
constinit const IntegratorEntry depthIntegrator = entry<6, 1, showDepth>("depth", "depth of surfaces along the view");

}  // namespace copse
