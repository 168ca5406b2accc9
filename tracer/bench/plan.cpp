// The order of the runs; times estimated from the closest run that has been measured.
#include "tracer/bench/plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace copse {

namespace {

std::string keyOf(const Experiment& experiment, const PlannedRun& run) {
  const ExperimentScene& scene = experiment.scenes[run.scene];
  const std::string& label = experiment.builders[run.builder].label;
  if (run.spp == 0) return fmt::format("{}/{}", scene.name, label);
  return fmt::format("{}/{}/{}/{}", scene.name, scene.views[run.view], label, run.spp);
}

}  // namespace

std::vector<PlannedRun> planOf(const Experiment& experiment) {
  std::vector<PlannedRun> plan;
  const std::vector<int> spp = experiment.renders() ? experiment.spp : std::vector<int>{0};
  for (std::size_t scene = 0; scene < experiment.scenes.size(); ++scene) {
    const std::size_t views = experiment.renders() ? experiment.scenes[scene].views.size() : 1;
    for (std::size_t view = 0; view < views; ++view)
      for (std::size_t i = 0; i < spp.size(); ++i)
        for (int repetition = 1; repetition <= experiment.repetitions[i]; ++repetition)
          for (std::size_t builder = 0; builder < experiment.builders.size(); ++builder) {
            PlannedRun run{scene, view, builder, spp[i], repetition, ""};
            run.key = keyOf(experiment, run);
            plan.push_back(std::move(run));
          }
  }
  return plan;
}

void Estimate::learn(const PlannedRun& run, double buildMs, double renderMs) {
  measured_ = true;
  buildOf_[{run.scene, run.builder}].add(buildMs);
  buildIn_[run.scene].add(buildMs);
  buildBy_[run.builder].add(buildMs);
  build_.add(buildMs);
  if (run.spp == 0) return;
  const double perSample = renderMs / samples(run);
  sampleOf_[{run.scene, run.view}].add(perSample);
  sampleIn_[run.scene].add(perSample);
  sample_.add(perSample);
}

double Estimate::samples(const PlannedRun& run) const {
  return static_cast<double>(run.spp) * experiment_.settings.width * experiment_.settings.height;
}

double Estimate::buildMs(const PlannedRun& run) const {
  const auto exact = buildOf_.find({run.scene, run.builder});
  if (exact != buildOf_.end()) return *exact->second.value();
  // Another builder on this scene, as much slower or faster as it has been elsewhere.
  const auto here = buildIn_.find(run.scene);
  const auto other = buildBy_.find(run.builder);
  if (here != buildIn_.end() && other != buildBy_.end() && *build_.value() > 0)
    return *here->second.value() * *other->second.value() / *build_.value();
  if (here != buildIn_.end()) return *here->second.value();
  if (other != buildBy_.end()) return *other->second.value();
  if (build_.count) return *build_.value();
  // A rough estimate: a fixed time per triangle, and a quarter of a million triangles where the number is unknown.
  const uint64_t expected = experiment_.scenes[run.scene].expected;
  const double triangles = expected ? static_cast<double>(expected) : 250e3;
  return device_.isCuda() ? 1 + 1e-5 * triangles : 5e-4 * triangles / device_.threads;
}

double Estimate::renderMs(const PlannedRun& run) const {
  if (run.spp == 0) return 0;
  if (const auto exact = sampleOf_.find({run.scene, run.view}); exact != sampleOf_.end())
    return *exact->second.value() * samples(run);
  if (const auto here = sampleIn_.find(run.scene); here != sampleIn_.end()) return *here->second.value() * samples(run);
  if (sample_.count) return *sample_.value() * samples(run);
  // A rough estimate: a fixed number of paths per millisecond.
  const double rate = device_.isCuda() ? 50'000 : 250.0 * device_.threads;
  return samples(run) / rate;
}

double Estimate::of(const PlannedRun& run) const { return buildMs(run) + renderMs(run); }

double Estimate::of(const std::vector<PlannedRun>& plan, std::size_t from) const {
  double ms = 0;
  for (std::size_t i = from; i < plan.size(); ++i) ms += of(plan[i]);
  return ms;
}

std::string durationText(double seconds) {
  if (seconds < 90) return fmt::format("{:.0f} s", std::max(seconds, 1.0));
  const long minutes = std::lround(seconds / 60);
  return minutes < 120 ? fmt::format("{} min", minutes) : fmt::format("{} h {:02} min", minutes / 60, minutes % 60);
}

}  // namespace copse
