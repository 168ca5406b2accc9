// The runs of a plan, one after the other: those that the journal holds are skipped, and each that is done or has
// failed is in the journal before the next begins.
#pragma once

#include <atomic>
#include <functional>
#include <string>
#include <vector>

#include "tracer/bench/journal.h"
#include "tracer/bench/plan.h"
#include "tracer/integrators/registry.h"
#include "tracer/session/record.h"

namespace copse {

/// The integrator that renders the images of a bench.
inline const IntegratorEntry& measuredIntegrator() { return *integrators().front(); }

/// What measures. Tests have one that takes no time.
class Runner {
 public:
  virtual ~Runner() = default;
  /// Loads this scene after releasing the previous one.
  virtual void load(std::size_t scene) = 0;
  /// Builds a tree of the loaded scene and renders with it. A run that was stopped is not `complete`.
  struct Outcome {
    RunRecord record;
    bool complete = true;
  };
  virtual Outcome run(const PlannedRun& run, const Watch& watch) = 0;
  /// After a measured run, before it is in the journal.
  virtual void keep(const PlannedRun&) {}
};

/// Each function may be empty.
struct LoopEvents {
  std::function<void(std::size_t scene)> loading;
  /// `left`: milliseconds until the last run should be done; `number` of the run, from 1, of all of the plan.
  std::function<void(const PlannedRun& run, std::size_t number, double left)> before;
  std::function<void(double done)> during;
  std::function<void(const PlannedRun& run, const std::string& error)> failed;
  /// `measured` is false while `left` is a rough estimate.
  std::function<void(std::size_t scene, int discarded, double left, bool measured)> warm;
  const std::atomic<bool>* stop = nullptr;
};

/// False where it was stopped. What a run throws is recorded as its failure; where a scene cannot be loaded all of its
/// runs fail. Throws InputError where the journal cannot be written.
bool runAll(const Experiment& experiment, const Device& device, const std::vector<PlannedRun>& plan, Journal& journal,
            Runner& runner, const LoopEvents& events = {});

/// Whether the median of the last three times is within `within` of the median of the three that ended one before.
bool isSteady(const std::vector<double>& times, double within);

}  // namespace copse
