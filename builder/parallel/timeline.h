// Named phases and the time each took: device events on CUDA, the clock on the CPU.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "builder/parallel/device.h"

namespace copse {

/// What several phases have in common: figures add up their times and draw them in one colour, and a rate of rays is
/// over the phases of one group. A group is known by its address, so it is declared once, as an `inline constexpr`
/// variable.
struct PhaseGroup {
  const char* name;
  const PhaseGroup* within = nullptr;  ///< The coarser group that it is a part of, if any.
};

/// The name of a phase or a launch, with its group. Phases that anything else asks for are declared once, in a header
/// of the stage that launches them; a launch within a phase needs no more than a text.
struct PhaseName {
  const char* text;
  const PhaseGroup* group = nullptr;

  constexpr PhaseName(const char* text, const PhaseGroup* group = nullptr) : text(text), group(group) {}
  constexpr operator const char*() const { return text; }
};

struct PhaseTime {
  std::string name;
  double ms = 0;
  int launches = 0;  ///< Kernel launches inside the phase.
  const PhaseGroup* group = nullptr;
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
  void begin(PhaseName name);
  void end();
  void countLaunch();

  /// Waits for the device.
  std::vector<PhaseTime> phases();
  /// From the first begin to the last end, gaps on the host included, in milliseconds; waits for the device.
  double spanMs();
  /// Events recorded so far on a CUDA device.
  int eventsRecorded() const;

 private:
  struct Events;
  std::unique_ptr<Events> events_;
};

/// A phase for the time of a scope, and an NVTX range on CUDA; no row where the device records no timeline.
class Phase {
 public:
  Phase(const Device& device, PhaseName name);
  ~Phase();
  Phase(const Phase&) = delete;
  Phase& operator=(const Phase&) = delete;

 private:
  Timeline* timeline_;
  [[maybe_unused]] bool onCuda_;
};

}  // namespace copse
