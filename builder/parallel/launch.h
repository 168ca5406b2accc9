// Runs a kernel, a small trivially copyable struct with `HD void operator()(uint32_t i) const`, for every i below n.
// One source: a grid of threads on CUDA, OpenMP on the CPU. Only .cu files include this.
#pragma once

#include <algorithm>
#include <cstdint>
#include <type_traits>

#include "builder/parallel/device.h"
#include "builder/parallel/platform.h"
#include "builder/parallel/timeline.h"

#if COPSE_CUDA && !defined(__CUDACC__)
#error "launch.h belongs in a .cu file: nvcc must see the kernels"
#endif

namespace copse {

namespace detail {
/// A thread's own copy of a kernel. One that has `HD void prepare()` gets what all its indices share from the device's
/// memory into its members there: numbers that the host need not wait for.
template <class Kernel>
HD inline Kernel prepared(const Kernel& kernel) {
  Kernel own = kernel;
  if constexpr (requires { own.prepare(); }) own.prepare();
  return own;
}

#if defined(__CUDACC__)
template <class Kernel>
__global__ void runOnGrid(uint32_t n, Kernel kernel) {
  const uint32_t i = blockIdx.x * blockDim.x + threadIdx.x;
  if (i >= n) return;
  if constexpr (requires { kernel.prepare(); })
    prepared(kernel)(i);
  else
    kernel(i);
}
#endif
/// Binds the device to this thread and keeps the launch's name for the message of an error that arrives later.
void beforeLaunch(const Device& device, const char* launch);
/// Throws DeviceError naming `launch` if it could not be started.
void checkLaunch(const Device& device, const char* launch);
}  // namespace detail

/// How many indices to launch where the device alone knows how many there are: `max` on CUDA, where the kernel has to
/// leave out those from `*count` on. The CPU's memory is the host's, and what was launched has run: no more than that.
inline uint32_t indicesFor(const Device& device, uint32_t max, const uint32_t* count) {
  return device.isCuda() || *count > max ? max : *count;
}

/// Indices that a CPU thread takes at a time where the work per index is small and even: at least `min`, and a share
/// of a thread's that is small enough to leave no thread idle at the end. Kernels read and write a few arrays in order,
/// and each new run begins with waits for memory: over 12 million triangles, builds took 7 % less time with such runs
/// than with runs of 1024.
inline uint32_t evenGrain(const Device& device, uint32_t n, uint32_t min) {
  return std::max(min, n / (64 * static_cast<uint32_t>(std::max(device.threads, 1))));
}

/// On CUDA it returns before the kernel has run; synchronise() and copies to the host report a kernel that failed.
/// Kernels do not throw: on the CPU an exception cannot leave the OpenMP region and ends the program.
/// `grain`: indices that a CPU thread takes at a time where the work per index is large or uneven; 0 where it is even.
template <class Kernel>
void launch(const Device& device, PhaseName name, uint32_t n, const Kernel& kernel, uint32_t grain = 0) {
  static_assert(std::is_trivially_copyable_v<Kernel>);
  if (n == 0) return;
  Phase phase(device, name);
  if (device.timeline) device.timeline->countLaunch();
#if defined(__CUDACC__)
  if (device.isCuda()) {
    constexpr uint32_t block = 256;
    detail::beforeLaunch(device, name);
    detail::runOnGrid<<<(n - 1) / block + 1, block, 0, static_cast<cudaStream_t>(device.stream)>>>(n, kernel);
    detail::checkLaunch(device, name);
    return;
  }
#endif
  const int64_t count = n;
  if (grain == 0) grain = evenGrain(device, n, 1024);
  [[maybe_unused]] const int chunk = static_cast<int>(grain);
#pragma omp parallel num_threads(device.threads) if (n > grain)
  {
    const Kernel own = detail::prepared(kernel);  // No one else can see it, so its members stay in registers.
#pragma omp for schedule(dynamic, chunk)
    for (int64_t i = 0; i < count; ++i) own(static_cast<uint32_t>(i));
  }
}

}  // namespace copse
