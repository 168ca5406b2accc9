// Loading, building and rendering with the clock around each step.
#include "tracer/session/run.h"

#include "builder/metrics/end_point_overlap.h"
#include "builder/parallel/device_facts.h"
#include "tracer/accel/counting.h"
#include "tracer/image/image_io.h"
#include "tracer/integrators/reference/reference.h"
#include "tracer/session/timed.h"

namespace copse {

TrianglesView LoadedScene::triangles() const {
  if (paths_) return trianglesOf(*paths_);
  return {positions_.data(), indices_.data(), static_cast<uint32_t>(indices_.size())};
}

LoadedScene loadForPaths(const Device& device, const std::string& file) {
  return loadForPaths(device, [&] { return loadScene(file); });
}

LoadedScene loadForBuild(const Device& device, const std::string& file) {
  return loadForBuild(device, [&] { return loadScene(file); });
}

LoadedScene loadForPaths(const Device& device, const std::function<Scene()>& read) {
  const Stopwatch watch;
  LoadedScene loaded;
  loaded.scene = read();
  loadTextures(loaded.scene);
  loaded.paths_ = uploadScene(device, loaded.scene);
  synchronise(device);
  loaded.ms = watch.ms();
  return loaded;
}

LoadedScene loadForReference(const std::string& file) {
  const Stopwatch watch;
  LoadedScene loaded;
  loaded.scene = loadScene(file);
  loadTextures(loaded.scene);
  loaded.ms = watch.ms();
  return loaded;
}

LoadedScene loadForBuild(const Device& device, const std::function<Scene()>& read) {
  const Stopwatch watch;
  LoadedScene loaded;
  loaded.scene = read();
  loaded.positions_ = Buffer<vec3>(device, loaded.scene.positions);
  loaded.indices_ = Buffer<uvec3>(device, loaded.scene.triangles);
  synchronise(device);
  loaded.ms = watch.ms();
  return loaded;
}

TreeRecord BuiltTree::record(const Device& device) const {
  TreeRecord record{{}, tracer->bytes(), {}};
  if (!source.isOwnTree()) record.statistics = statistics(device, bvh, *parameters);
  return record;
}

void BuiltTree::describe(const Device& device, RunRecord& record) const {
  record.builder = source.name();
  record.optimisers = optimisers;
  record.tracer = tracer->name();
  record.parameters = parameters;
  record.tree = known ? *known : this->record(device);
  record.buildMs = ms;
  record.buildPhases = phases;
  record.buildPeakBytes = peakBytes;
}

BuiltTree buildTree(const Device& device, const TrianglesView& triangles, const TreeSource& source,
                    const Parameters& chosen, const OptimiserNames& optimisers, const TracerChoice& choice) {
  BuiltTree tree;
  tree.source = source;
  tree.optimisers = optimisers;
  if (!source.isOwnTree()) tree.parameters = withPreset(source.builder(), chosen);
  const TracerEntry& entry = choice.resolve(device, source);
  std::unique_ptr<TreeTracer> tracer =
      entry.make(device, triangles, tree.parameters.value_or(Parameters()), source.name());
  const uint64_t before = bytesInUse(device);
  startPeak(device);
  tree.ms = timed(device, tree.phases, [&](const Device& recording) {
    if (!source.isOwnTree())
      tree.bvh = buildBvh(recording, triangles, source.builder(), *tree.parameters, {optimisers});
    tracer->build(recording, tree.bvh, triangles);
  });
  const uint64_t peak = copse::peakBytes(device);
  tree.peakBytes = (peak > before ? peak - before : 0) + tracer->foreignPeakBytes();
  tree.tracer = std::move(tracer);
  return tree;
}

RunRecord recordOf(const Device& device, const LoadedScene& loaded) {
  RunRecord record;
  record.sceneName = loaded.scene.name;
  record.sceneFile = loaded.scene.file;
  record.sceneGenerated = loaded.scene.generated;
  record.triangles = loaded.scene.triangles.size();
  record.emitters = loaded.scene.emitterCount();
  record.device = device;
  record.device.timeline = nullptr;
  record.loadMs = loaded.ms;
  return record;
}

std::vector<Channel> channelsOf(const SurfaceBuffers& surfaces) {
  std::vector<Channel> channels;
  const auto add = [&](const char* layer, const char* components, const Image& image) {
    for (int c = 0; c < 3; ++c) {
      std::vector<float> values;
      values.reserve(image.pixels.size());
      for (const vec3& pixel : image.pixels) values.push_back(pixel[c]);
      channels.push_back({std::string(layer) + "." + components[c], std::move(values)});
    }
  };
  add("N", "XYZ", surfaces.normals);
  add("albedo", "RGB", surfaces.albedo);
  channels.push_back({"Z", surfaces.depth});
  return channels;
}

std::optional<TraversalRecord> countTraversal(const Device& device, const LoadedScene& loaded, const BuiltTree& tree,
                                              const View& view, const RenderSettings& settings, const Watch& watch) {
  const StepTracer* const steps = tree.tracer->stepTracer();
  if (!steps) return std::nullopt;
  const CountingRayTracer tracer(*steps);
  const PathResult result = renderPath(device, loaded.forPaths(), tracer, view, settings, watch);
  if (result.samplesDone < settings.spp) return std::nullopt;
  const auto perRay = [&](const char* name) -> std::optional<TraversalCounts> {
    const TraversalSteps sum = tracer.steps(name);
    if (sum.rays == 0) return std::nullopt;
    const double rays = static_cast<double>(sum.rays);
    return TraversalCounts{static_cast<double>(sum.nodes) / rays, static_cast<double>(sum.triangles) / rays};
  };
  return TraversalRecord{perRay("trace primary"), perRay("trace bounce"), perRay("trace shadow"),
                         "each ray by itself, a node at a time, the nearer child first"};
}

std::optional<double> endPointOverlapOf(const Device& device, const LoadedScene& loaded, const BuiltTree& tree) {
  if (tree.source.isOwnTree()) return std::nullopt;
  return endPointOverlap(device, tree.bvh, loaded.triangles(), *tree.parameters);
}

Rendered renderTree(const Device& device, const LoadedScene& loaded, const BuiltTree& tree, const View& view,
                    const RenderSettings& settings, const Watch& watch, bool surfaces) {
  Rendered rendered;
  RunRecord& record = rendered.record;
  record = recordOf(device, loaded);
  tree.describe(device, record);
  PathOptions options{.surfaces = surfaces};
  if (tree.parameters) options.queue = pathQueueOf(*tree.parameters);
  PathResult result;
  record.renderMs = timed(device, record.renderPhases, [&](const Device& recording) {
    result = renderPath(recording, loaded.forPaths(), *tree.tracer, view, settings, watch, options);
  });
  record.image = ImageRecord{"", view.name, "path", settings, result.samplesDone};
  record.rays = result.rays;
  if (result.surfaces) rendered.channels = channelsOf(*result.surfaces);
  rendered.image = std::move(result.image);
  return rendered;
}

Rendered renderByReference(const Device& device, const LoadedScene& loaded, const View& view,
                           const RenderSettings& settings, const Watch& watch) {
  Rendered rendered;
  RunRecord& record = rendered.record;
  record = recordOf(device, loaded);
  record.builder = "reference";
  ReferenceResult result = renderReference(loaded.scene, view, settings, device.threads, watch);
  record.buildMs = result.buildMs;
  record.renderMs = result.renderMs;
  record.image = ImageRecord{"", view.name, "reference", settings, result.samplesDone};
  record.rays = RayCounts{result.rays[0], result.rays[1], result.rays[2]};
  rendered.image = std::move(result.image);
  return rendered;
}

}  // namespace copse
