// A ray tracer that keeps each ray's steps beside its hit, and a film that adds them up.
#include "tracer/integrators/heatmap/heatmap.h"

#include "tracer/integrators/film.h"

namespace copse {

namespace {

/// Of a pixel's samples together.
struct StepSums {
  uint64_t nodes, triangles;

  HD StepSums& operator+=(const StepSums& other) {
    nodes += other.nodes;
    triangles += other.triangles;
    return *this;
  }
};

struct StepsOfRay {
  const RaySteps* steps;
  HD StepSums operator()(const FilmSample& sample) const {
    return {steps[sample.place].nodes, steps[sample.place].triangles};
  }
};

/// Both the tracer and the film: steps go from one to the other.
class StepCounter final : public RayTracer, public PrimaryFilm {
 public:
  StepCounter(const Device& device, const StepTracer& tracer, uint32_t pixels)
      : tracer_(tracer), film_(device, pixels) {}

  void closest(const Device& device, const char* name, uint32_t count, const Ray* rays, Hit* hits) const override {
    if (steps_.size() < count) steps_ = Buffer<RaySteps>(device, count);
    tracer_.closest(device, name, count, rays, hits, steps_.data());
  }
  /// Camera rays are not asked for any hit.
  void any(const Device&, const char*, uint32_t, const Ray*, uint32_t*) const override {}

  void add(const Device& device, const PrimaryBatch& batch) override {
    film_.add(device, phases::addSteps, batch.first, batch.count, StepsOfRay{steps_.data()});
  }

  std::vector<StepSums> sums() const { return film_.sums().toHost(); }

 private:
  const StepTracer& tracer_;
  mutable Buffer<RaySteps> steps_;
  Film<StepSums> film_;
};

}  // namespace

StepBuffers countSteps(const Device& device, const StepTracer& tracer, const Camera& camera,
                       const RenderSettings& settings, const Watch& watch, uint32_t queue) {
  checkSettings(settings);
  const Pinhole pinhole = makePinhole(camera, settings.width, settings.height);
  const uint32_t pixels = pixelsOf(settings);
  StepCounter counter(device, tracer, pixels);
  StepBuffers result;
  result.samples = tracePrimary(device, counter, pinhole, settings, counter, watch, queue, phases::countSteps);
  const std::vector<StepSums> sums = counter.sums();
  uint64_t nodes = 0, triangles = 0;
  for (uint32_t i = 0; i < pixels; ++i) {
    const uint64_t samples = samplesOfPixel(result.samples, pixels, i);
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
