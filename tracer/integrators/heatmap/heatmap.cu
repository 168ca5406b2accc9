// A ray tracer that keeps the steps of each ray, and a film that adds them up.
#include "tracer/integrators/heatmap/heatmap.h"

#include "tracer/integrators/film.h"

namespace copse {

namespace {

/// Totals over a pixel's samples.
struct StepSums {
  uint64_t nodes, triangles;

  HD StepSums& operator+=(const StepSums& other) {
    nodes += other.nodes;
    triangles += other.triangles;
    return *this;
  }
};

/// A pixel's sums as means over its rays.
struct MeanSteps {
  float *nodes, *triangles;

  HD void operator()(uint32_t pixel, const StepSums& sum, uint64_t samples) const {
    const double part = samples ? 1.0 / static_cast<double>(samples) : 0;
    nodes[pixel] = static_cast<float>(static_cast<double>(sum.nodes) * part);
    triangles[pixel] = static_cast<float>(static_cast<double>(sum.triangles) * part);
  }
};

struct StepsOfRay {
  const RaySteps* steps;
  HD StepSums operator()(const FilmSample& sample) const {
    return {steps[sample.place].nodes, steps[sample.place].triangles};
  }
};

/// Both tracer and film: the steps go from one to the other.
class StepCounter final : public RayTracer, public PrimaryFilm {
 public:
  StepCounter(const Device& device, const StepTracer& tracer, const PixelOrder& order)
      : tracer_(tracer), film_(device, order) {}

  void closest(const Device& device, const char* name, uint32_t count, const Ray* rays, Hit* hits) const override {
    if (steps_.size() < count) steps_ = Buffer<RaySteps>(device, count);
    tracer_.closest(device, name, count, rays, hits, steps_.data());
  }
  /// Camera rays have no any-hit queries.
  void any(const Device&, const char*, uint32_t, const Ray*, uint32_t*) const override {}

  void add(const Device& device, const PrimaryBatch& batch) override {
    film_.add(device, phases::addSteps, batch.first, batch.count, StepsOfRay{steps_.data()});
  }

  /// What there is of `samples` rays.
  StepBuffers finish(const Device& device, uint64_t samples) {
    StepBuffers result;
    result.samples = samples;
    StepSums all{};
    for (const StepSums& sum : film_.sums().toHost()) all += sum;
    if (samples > 0) {
      result.meanNodes = static_cast<double>(all.nodes) / static_cast<double>(samples);
      result.meanTriangles = static_cast<double>(all.triangles) / static_cast<double>(samples);
    }
    Buffer<float> nodes(device, film_.pixels()), triangles(device, film_.pixels());
    film_.finish(device, phases::addSteps, samples, MeanSteps{nodes.data(), triangles.data()});
    result.nodes = nodes.toHost();
    result.triangles = triangles.toHost();
    return result;
  }

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
  const PixelOrder order(device, settings.width, settings.height);
  StepCounter counter(device, tracer, order);
  const uint64_t samples =
      tracePrimary(device, counter, pinhole, settings, order, counter, watch, queue, phases::countSteps);
  return counter.finish(device, samples);
}

}  // namespace copse
