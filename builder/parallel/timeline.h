// Named phases and the time each took: device events on CUDA, the clock on the CPU.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "builder/parallel/device.h"

namespace copse {

struct PhaseTime {
  std::string name;
  double ms = 0;
  int launches = 0;  ///< Kernel launches inside the phase.
};

/// Rows are flat: the outermost open phase gets the time, and phases of one name are added up, in order of first use.
/// A launch outside any phase is a phase of its own under the launch's name. Where phases follow each other at once, n
/// of them cost n + 1 events; one phase around all of them costs two, and is what leaves the times alone the most.
class Timeline {
 public:
  explicit Timeline(const Device& device);
  ~Timeline();
  Timeline(const Timeline&) = delete;
  Timeline& operator=(const Timeline&) = delete;

  /// Called by one host thread, in pairs.
  void begin(const char* name);
  void end();
  void countLaunch();

  /// Waits for the device.
  std::vector<PhaseTime> phases();
  /// From the first begin to the last end, gaps on the host included, in milliseconds; waits for the device.
  double spanMs();
  /// Of a CUDA device, so far.
  int eventsRecorded() const;

 private:
  struct Events;
  std::unique_ptr<Events> events_;
};

/// A phase for the time of a scope, and an NVTX range on CUDA; no row where the device records no timeline.
class Phase {
 public:
  Phase(const Device& device, const char* name);
  ~Phase();
  Phase(const Phase&) = delete;
  Phase& operator=(const Phase&) = delete;

 private:
  Timeline* timeline_;
  [[maybe_unused]] bool onCuda_;
};

}  // namespace copse
