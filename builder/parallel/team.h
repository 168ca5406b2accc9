// A team works through loops whose iterations are independent and meets between them: 32 lanes on CUDA, one thread on
// the CPU. It suits kernels that keep counters and sums in shared memory; where lanes talk to each other, take a Warp.
#pragma once

#include <cstdint>
#include <type_traits>
#include <vector>

#include "builder/parallel/device.h"
#include "builder/parallel/launch.h"
#include "builder/parallel/platform.h"
#include "builder/parallel/timeline.h"

namespace copse {

/// Every member is called by the whole team, in the same order; lambdas see only what is shared or constant.
class Team {
 public:
  HD explicit Team(void* shared) : shared_(shared) {}

  /// Memory of the team: `sharedBytes` of launchTeams, aligned to 16, uninitialised.
  HD void* shared() const { return shared_; }

  /// f(i) for every i < n, in any order; what was written is seen by the whole team afterwards.
  template <class F>
  HD void forEach(uint32_t n, F f) const {
#if defined(__CUDA_ARCH__)
    for (uint32_t i = threadIdx.x & 31; i < n; i += 32) f(i);
    __syncwarp();
#else
    for (uint32_t i = 0; i < n; ++i) f(i);
#endif
  }

  /// Everyone has read and written what came before.
  HD void sync() const {
#if defined(__CUDA_ARCH__)
    __syncwarp();
#endif
  }

  /// f() once.
  template <class F>
  HD void single(F f) const {
    forEach(1, [&](uint32_t) { f(); });
  }

  /// Inside forEach: adds to shared memory.
  template <class T>
  HD static void add(T* to, T value) {
#if defined(__CUDA_ARCH__)
    if constexpr (sizeof(T) == 8)
      atomicAdd(reinterpret_cast<unsigned long long*>(to), static_cast<unsigned long long>(value));
    else
      atomicAdd(to, value);
#else
    *to += value;
#endif
  }

  /// Hands out places in the order of i: emit(i, cursors[c]++) with c = binOf(i). `cursors` is shared memory.
  template <class BinOf, class Emit>
  HD void partition(uint32_t n, uint32_t* cursors, BinOf binOf, Emit emit) const {
#if defined(__CUDA_ARCH__)
    const uint32_t lane = threadIdx.x & 31;
    for (uint32_t base = 0; base < n; base += 32) {
      const uint32_t i = base + lane;
      const uint32_t bin = i < n ? binOf(i) : 0xffffffffu;
      const uint32_t peers = __match_any_sync(0xffffffffu, bin);
      const uint32_t rank = __popc(peers & ((1u << lane) - 1));
      uint32_t place = 0;
      if (i < n) place = cursors[bin] + rank;
      __syncwarp();
      if (i < n && rank == 0) cursors[bin] += __popc(peers);
      __syncwarp();
      if (i < n) emit(i, place);
    }
    __syncwarp();
#else
    for (uint32_t i = 0; i < n; ++i) emit(i, cursors[binOf(i)]++);
#endif
  }

 private:
  void* shared_;
};

namespace detail {
constexpr uint32_t teamsInBlock = 4;
#if defined(__CUDACC__)
template <class Kernel>
__global__ void __launch_bounds__(32 * teamsInBlock) runTeams(uint32_t teams, uint32_t bytesPerTeam, Kernel kernel) {
  extern __shared__ uint4 sharedOfBlock[];
  const uint32_t inBlock = threadIdx.x / 32;
  const uint32_t index = blockIdx.x * teamsInBlock + inBlock;
  if (index >= teams) return;
  kernel(Team(reinterpret_cast<char*>(sharedOfBlock) + inBlock * bytesPerTeam), index);
}
#endif
}  // namespace detail

/// Runs kernel(team, index) for every index < teams; `sharedBytes` of at most 48 KiB / 4 a team.
template <class Kernel>
void launchTeams(const Device& device, const char* name, uint32_t teams, const Kernel& kernel, uint32_t sharedBytes,
                 uint32_t grain = 8) {
  static_assert(std::is_trivially_copyable_v<Kernel>);
  if (teams == 0) return;
  Phase phase(device, name);
  if (device.timeline) device.timeline->countLaunch();
  const uint32_t bytes = (sharedBytes + 15) / 16 * 16;
#if defined(__CUDACC__)
  if (device.isCuda()) {
    detail::runTeams<<<(teams - 1) / detail::teamsInBlock + 1, 32 * detail::teamsInBlock, bytes * detail::teamsInBlock,
                       static_cast<cudaStream_t>(device.stream)>>>(teams, bytes, kernel);
    detail::checkLaunch(device, name);
    return;
  }
#endif
  const int64_t count = teams;
  [[maybe_unused]] const int chunk = static_cast<int>(grain);
#pragma omp parallel num_threads(device.threads) if (teams > grain)
  {
    std::vector<double> shared(bytes / 8 + 2);
    const Team team(shared.data());
#pragma omp for schedule(dynamic, chunk)
    for (int64_t i = 0; i < count; ++i) kernel(team, static_cast<uint32_t>(i));
  }
}

}  // namespace copse
