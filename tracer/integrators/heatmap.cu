// A ray tracer that keeps each ray's steps beside its hit, and a film that adds them up.
#include "tracer/integrators/heatmap.h"

#include "builder/parallel/launch.h"

namespace copse {

namespace {

struct StepSums {
  uint64_t nodes, triangles;
};

/// Call j adds the samples of one pixel.
struct AddSteps {
  const RaySteps* steps;
  uint64_t first;
  uint32_t count, pixels;
  StepSums* sums;

  HD void operator()(uint32_t j) const {
    StepSums& pixel = sums[(first + j) % pixels];
    StepSums sum = pixel;
    for (uint64_t i = j; i < count; i += pixels) {
      sum.nodes += steps[i].nodes;
      sum.triangles += steps[i].triangles;
    }
    pixel = sum;
  }
};

/// Both the tracer and the film: steps go from one to the other.
class StepCounter final : public RayTracer, public PrimaryFilm {
 public:
  StepCounter(const Device& device, const StepTracer& tracer, uint32_t pixels)
      : tracer_(tracer), sums_(device, pixels) {
    sums_.fill(0);
  }

  void closest(const Device& device, const char* name, uint32_t count, const Ray* rays, Hit* hits) const override {
    if (steps_.size() < count) steps_ = Buffer<RaySteps>(device, count);
    tracer_.closest(device, name, count, rays, hits, steps_.data());
  }
  /// Camera rays are not asked for any hit.
  void any(const Device&, const char*, uint32_t, const Ray*, uint32_t*) const override {}

  void add(const Device& device, const PrimaryBatch& batch) override {
    const auto pixels = static_cast<uint32_t>(sums_.size());
    launch(device, "add steps", batch.count < pixels ? batch.count : pixels,
           AddSteps{steps_.data(), batch.first, batch.count, pixels, sums_.data()});
  }

  std::vector<StepSums> sums() const { return sums_.toHost(); }

 private:
  const StepTracer& tracer_;
  mutable Buffer<RaySteps> steps_;
  Buffer<StepSums> sums_;
};

}  // namespace

StepBuffers countSteps(const Device& device, const StepTracer& tracer, const View& view, const RenderSettings& settings,
                       const Watch& watch, uint32_t queue) {
  checkSettings(settings);
  const Camera camera = makeCamera(view, settings.width, settings.height);
  const uint32_t pixels = static_cast<uint32_t>(settings.width) * static_cast<uint32_t>(settings.height);
  StepCounter counter(device, tracer, pixels);
  StepBuffers result;
  result.samples = tracePrimary(device, counter, camera, settings, counter, watch, queue, "count steps");
  const std::vector<StepSums> sums = counter.sums();
  uint64_t nodes = 0, triangles = 0;
  for (uint32_t i = 0; i < pixels; ++i) {
    const uint64_t samples = result.samples / pixels + (i < result.samples % pixels ? 1 : 0);
    const double part = samples ? 1.0 / static_cast<double>(samples) : 0;
    result.nodes.push_back(static_cast<float>(static_cast<double>(sums[i].nodes) * part));
    result.triangles.push_back(static_cast<float>(static_cast<double>(sums[i].triangles) * part));
    nodes += sums[i].nodes;
    triangles += sums[i].triangles;
  }
  if (result.samples > 0) {
    result.meanNodes = static_cast<double>(nodes) / static_cast<double>(result.samples);
    result.meanTriangles = static_cast<double>(triangles) / static_cast<double>(result.samples);
  }
  return result;
}

}  // namespace copse
