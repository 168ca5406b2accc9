// Rendering, and the record of a run.
#include "tracer/session/render.h"

#include "tracer/accel/counting.h"
#include "tracer/integrators/path/path_tracer.h"
#include "tracer/integrators/phases.h"
#include "tracer/integrators/registry.h"

namespace copse {

RunRecord recordOf(const Device& device, const LoadedScene& loaded) {
  RunRecord record;
  record.sceneName = loaded.scene.name;
  record.sceneFile = loaded.scene.file;
  record.sceneGenerated = loaded.scene.generated;
  record.sceneOptions = loaded.scene.options;
  record.sceneHash = loaded.hash;
  record.triangles = loaded.scene.triangles.size();
  record.emitters = loaded.scene.emitterCount();
  record.device = device;
  record.device.timeline = nullptr;
  record.loadMs = loaded.ms;
  return record;
}

LoadFor loadFor(const IntegratorEntry& integrator) {
  return integrator.tree == TreeUse::none ? LoadFor::reference : LoadFor::renders;
}

ReadyIntegrator makeReady(const IntegratorEntry& entry, const Device& device, const LoadedScene& loaded,
                          const BuiltTree& tree, const IntegratorOptions& options) {
  IntegratorInput input{loaded.scene};
  if (entry.tree != TreeUse::none) {
    checkTree(entry, tree.source);
    input.onDevice = loaded.onDevice.get();
    input.tracer = tree.tracer.get();
    if (!tree.source.isOwnTree()) {
      input.builder = &tree.source.builder();
      input.parameters = &*tree.parameters;
    }
  }
  return {&entry, entry.make(device, input, options)};
}

Rendered render(const ReadyIntegrator& ready, const Device& device, const LoadedScene& loaded, const BuiltTree& tree,
                const Camera& camera, const RenderSettings& settings, const Watch& watch, const FilmState* from) {
  Rendered rendered;
  RunRecord& record = rendered.record;
  record = recordOf(device, loaded);
  if (ready.entry->tree == TreeUse::none)
    record.builder = ready.entry->name;
  else
    describe(device, tree, record);
  Picture& picture = rendered.picture;
  picture = from ? ready.integrator->resume(device, camera, settings, watch, *from)
                 : ready.integrator->render(device, camera, settings, watch);
  record.buildMs += picture.buildMs;
  record.buildPhases.insert(record.buildPhases.end(), picture.buildPhases.begin(), picture.buildPhases.end());
  record.renderMs = picture.renderMs;
  record.renderPhases = picture.renderPhases;
  record.image = ImageRecord{"",
                             camera.name,
                             ready.entry->name,
                             settings,
                             picture.samplesDone,
                             picture.figures,
                             inFiles(loaded.scene, camera)};
  record.rays = picture.rays;
  record.traversal = picture.traversal;
  return rendered;
}

std::optional<TraversalRecord> countTraversal(const Device& device, const LoadedScene& loaded, const BuiltTree& tree,
                                              const Camera& camera, const RenderSettings& settings,
                                              const Watch& watch) {
  const StepTracer* const steps = tree.tracer->stepTracer();
  if (!steps) return std::nullopt;
  const CountingRayTracer tracer(*steps);
  const PathResult result = renderPath(device, *loaded.onDevice, tracer, camera, settings, watch);
  if (result.samplesDone < settings.spp) return std::nullopt;
  const auto perRay = [&](PhaseName phase) -> std::optional<TraversalCounts> {
    const TraversalSteps sum = tracer.steps(phase.text);
    if (sum.rays == 0) return std::nullopt;
    const double rays = static_cast<double>(sum.rays);
    return TraversalCounts{static_cast<double>(sum.nodes) / rays, static_cast<double>(sum.triangles) / rays};
  };
  return TraversalRecord{perRay(phases::tracePrimary), perRay(phases::traceBounce), perRay(phases::traceShadow),
                         countedBy};
}

}  // namespace copse
