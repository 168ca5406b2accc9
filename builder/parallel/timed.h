// Work on a device with the clock around it.
#pragma once

#include <chrono>
#include <vector>

#include "builder/parallel/timeline.h"

namespace copse {

class Stopwatch {
 public:
  double ms() const { return std::chrono::duration<double, std::milli>(Clock::now() - start_).count(); }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point start_ = Clock::now();
};

/// Milliseconds that work(recording device) takes: by the device's own events on CUDA, by the clock on the CPU. Its
/// phases go to a timeline.
template <class Work>
double timed(const Device& device, std::vector<PhaseTime>& phases, Work work) {
  Timeline timeline(device);
  const Stopwatch watch;
  work(device.recording(timeline));
  synchronise(device);
  const double ms = device.isCuda() ? timeline.spanMs() : watch.ms();
  phases = timeline.phases();
  return ms;
}

}  // namespace copse
