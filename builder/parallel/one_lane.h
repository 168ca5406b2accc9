// A warp of one lane, for kernels that are templates of their warp: 32 lanes on CUDA, one plain thread on the CPU,
// where 32 fibers would take some ten times as long. What such a kernel does must not depend on the number of lanes;
// launchWarps runs it on fibers, so that a test can compare the two and ThreadSanitizer sees the lanes. Only .cu files
// include this.
#pragma once

#include <cstdint>
#include <vector>

#include "builder/parallel/launch_warps.h"

namespace copse {

/// Warp's members that such kernels use, for one lane.
class OneLane {
 public:
  static constexpr uint32_t size = 1;

  HD explicit OneLane(void* shared) : shared_(shared) {}
  OneLane(const OneLane&) = delete;
  OneLane& operator=(const OneLane&) = delete;

  HD uint32_t lane() const { return 0; }
  HD void* shared() const { return shared_; }
  HD void sync() {}
  HD uint32_t ballot(bool predicate) { return predicate; }
  HD bool any(bool predicate) { return predicate; }
  template <class T>
  HD T shfl(T value, uint32_t) {
    return value;
  }
  template <class T, class Combine>
  HD T reduce(T value, Combine) {
    return value;
  }

 private:
  void* shared_;
};

namespace detail {
/// kernel(OneLane, index) for every index < count, on the CPU's threads.
template <class Kernel>
void runOneLanes(const Device& device, PhaseName name, uint32_t count, const Kernel& kernel, uint32_t sharedBytes,
                 uint32_t grain) {
  static_assert(std::is_trivially_copyable_v<Kernel>);
  if (count == 0) return;
  Phase phase(device, name);
  if (device.timeline) device.timeline->countLaunch();
  const int64_t lanes = count;
  [[maybe_unused]] const int chunk = static_cast<int>(grain);
#pragma omp parallel num_threads(device.threads) if (count > grain)
  {
    struct alignas(64) Line {
      unsigned char bytes[64];
    };
    std::vector<Line> shared(sharedBytes / sizeof(Line) + 1);
    OneLane lane(shared.data());
    const Kernel own = kernel;
#pragma omp for schedule(dynamic, chunk)
    for (int64_t i = 0; i < lanes; ++i) own(lane, static_cast<uint32_t>(i));
  }
}
}  // namespace detail

/// Calls kernel(lanes, index) with index * size + lane covering 0 … count-1, and beyond in the last warp:
/// `template <class Lanes> HD void operator()(Lanes& lanes, uint32_t index) const`. `grain`, not 0: indices that a CPU
/// thread takes at a time.
template <class Kernel>
void launchLanes(const Device& device, PhaseName name, uint32_t count, const Kernel& kernel, uint32_t sharedBytes,
                 uint32_t grain = 64) {
  if (device.isCuda())
    launchWarps(device, name, count / Warp::size + (count % Warp::size != 0), kernel, sharedBytes);
  else
    detail::runOneLanes(device, name, count, kernel, sharedBytes, grain);
}

/// The same with one warp per index: kernel(lanes, index) for index 0 … teams-1, all of a team's lanes on one index.
template <class Kernel>
void launchTeams(const Device& device, PhaseName name, uint32_t teams, const Kernel& kernel, uint32_t sharedBytes,
                 uint32_t grain = 8) {
  if (device.isCuda())
    launchWarps(device, name, teams, kernel, sharedBytes);
  else
    detail::runOneLanes(device, name, teams, kernel, sharedBytes, grain);
}

}  // namespace copse
