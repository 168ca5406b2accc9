// The runs of an experiment in their order, and how long they should take.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "builder/parallel/device.h"
#include "tracer/bench/experiment.h"
#include "tracer/session/record.h"

namespace copse {

struct PlannedRun {
  std::size_t scene = 0, view = 0, builder = 0;  ///< Into the experiment's; the view into its scene's.
  int spp = 0;                                   ///< 0: a tree and no image.
  int repetition = 1;
  std::string key;  ///< "sponza/nave/kmeans-q2/8", or "sponza/kmeans-q2" without an image. Repetitions share it.
};

/// Scene by scene, view by view, spp by spp, and there A B C A B C …: every builder once before any has
/// its second repetition, so that a machine that slows down slows all of them.
std::vector<PlannedRun> planOf(const Experiment& experiment);

/// Learns from the runs that are done. Milliseconds.
class Estimate {
 public:
  Estimate(const Experiment& experiment, const Device& device) : experiment_(experiment), device_(device) {}

  /// From a measured or a warm-up run.
  void learn(const PlannedRun& run, double buildMs, double renderMs);
  double of(const PlannedRun& run) const;
  /// The sum over plan[from …].
  double of(const std::vector<PlannedRun>& plan, std::size_t from = 0) const;
  /// False while `of` is a rough estimate that no run has corrected.
  bool measured() const { return measured_; }

 private:
  struct Mean {
    double sum = 0;
    int count = 0;
    void add(double value) { sum += value, ++count; }
    std::optional<double> value() const { return count ? std::optional(sum / count) : std::nullopt; }
  };

  double buildMs(const PlannedRun& run) const;
  double renderMs(const PlannedRun& run) const;
  double samples(const PlannedRun& run) const;

  const Experiment& experiment_;
  Device device_;
  bool measured_ = false;
  std::map<std::pair<std::size_t, std::size_t>, Mean> buildOf_, sampleOf_;  // (scene, builder), (scene, view)
  std::map<std::size_t, Mean> buildIn_, buildBy_, sampleIn_;                // scene, builder, scene
  Mean build_, sample_;
};

/// "14 min", "35 s", "2 h 05 min".
std::string durationText(double seconds);

}  // namespace copse
