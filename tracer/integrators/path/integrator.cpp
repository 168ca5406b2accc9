// The path tracer as an integrator.
#include "tracer/integrators/integrator.h"

#include "builder/parallel/timed.h"
#include "tracer/integrators/path/path_tracer.h"
#include "tracer/integrators/surfaces/channels.h"

namespace copse {

namespace {

class PathIntegrator final : public Integrator {
 public:
  PathIntegrator(const IntegratorInput& input, const IntegratorOptions& options)
      : scene_(*input.onDevice), tracer_(*input.tracer), options_{.surfaces = options.aov} {
    if (input.parameters) options_.queue = pathQueueOf(*input.parameters);
  }

  Picture render(const Device& device, const Camera& camera, const RenderSettings& settings,
                 const Watch& watch) const override {
    return renderFrom(device, camera, settings, watch, nullptr);
  }
  Picture resume(const Device& device, const Camera& camera, const RenderSettings& settings, const Watch& watch,
                 const FilmState& from) const override {
    return renderFrom(device, camera, settings, watch, &from);
  }

 private:
  Picture renderFrom(const Device& device, const Camera& camera, const RenderSettings& settings, const Watch& watch,
                     const FilmState* from) const {
    Picture picture;
    PathResult result;
    PathOptions options = options_;
    options.from = from;
    picture.renderMs = timed(device, picture.renderPhases, [&](const Device& recording) {
      result = renderPath(recording, scene_, tracer_, camera, settings, watch, options);
    });
    picture.samplesDone = result.samplesDone;
    picture.rays = result.rays;
    if (result.surfaces) picture.channels = channelsOf(*result.surfaces);
    picture.image = std::move(result.image);
    picture.film = std::move(result.film);
    return picture;
  }

  const SceneOnDevice& scene_;
  const TreeTracer& tracer_;
  PathOptions options_;
};

constexpr PhaseName phaseNames[] = {phases::generate,    phases::tracePrimary, phases::surfaces,   phases::shade,
                                    phases::traceShadow, phases::accumulate,   phases::traceBounce};

}  // namespace

extern const IntegratorEntry pathIntegrator;
constinit const IntegratorEntry pathIntegrator{
    .name = "path",
    .meaning = "light by wavefront path tracing",
    .rendersLight = true,
    .takes = {.aov = true, .countTraversal = true, .endPointOverlap = true, .exposure = true, .resume = true},
    .phases = phaseNames,
    .make = [](const Device&, const IntegratorInput& input, const IntegratorOptions& options)
        -> std::unique_ptr<const Integrator> { return std::make_unique<PathIntegrator>(input, options); }};

}  // namespace copse
