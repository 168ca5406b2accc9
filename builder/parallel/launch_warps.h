// Runs a kernel with 32 lanes per index: a small trivially copyable struct with
// `HD void operator()(Warp& warp, uint32_t index) const`, called by every lane. Only .cu files include this.
#pragma once

#include <cstdint>
#include <type_traits>

#include "builder/parallel/launch.h"
#include "builder/parallel/warp.h"

namespace copse {

namespace detail {

template <class Kernel>
void callWarpKernel(const void* kernel, Warp& warp, uint32_t index) {
  (*static_cast<const Kernel*>(kernel))(warp, index);
}

constexpr uint32_t roundedShared(uint32_t bytes) { return (bytes + 15) / 16 * 16; }

/// Warps per block: four, fewer where they would not fit into a block's shared memory.
constexpr uint32_t warpsPerBlock(uint32_t sharedBytes) {
  constexpr uint32_t maxBytes = 96 * 1024;
  uint32_t warps = 4;
  while (warps > 1 && warps * roundedShared(sharedBytes) > maxBytes) warps /= 2;
  return warps;
}

/// Blocks of 128 threads that a multiprocessor has to have registers for: a kernel whose shared memory leaves room for
/// few says so as `residentBlocks`, and ptxas need not save registers for more. 0 leaves it to ptxas.
template <class Kernel>
constexpr int residentBlocksOf() {
  if constexpr (requires { Kernel::residentBlocks; })
    return Kernel::residentBlocks;
  else
    return 0;
}

#if defined(__CUDACC__)
template <class Kernel>
__global__ void __launch_bounds__(128, residentBlocksOf<Kernel>())
    runWarpsOnGrid(uint32_t warps, uint32_t sharedStride, Kernel kernel) {
  extern __shared__ uint4 sharedOfBlock[];
  const uint32_t inBlock = threadIdx.x / Warp::size;
  const uint32_t index = blockIdx.x * (blockDim.x / Warp::size) + inBlock;
  if (index >= warps) return;  // A whole warp leaves.
  char* shared = reinterpret_cast<char*>(sharedOfBlock) + inBlock * sharedStride;
  Warp warp(threadIdx.x % Warp::size, shared, nullptr);
  kernel(warp, index);
}

/// More than 48 KiB of shared memory per block must be asked for. Throws DeviceError naming `name`.
void allowShared(const void* function, const char* name, uint32_t bytesPerBlock);
/// Blocks that run at a time on the whole device, no more than `maxPerProcessor` (1 or more) per multiprocessor.
uint32_t residentBlocks(const Device& device, const void* function, uint32_t threads, uint32_t bytesPerBlock,
                        uint32_t maxPerProcessor);
#endif

}  // namespace detail

/// Calls kernel(warp, index) for index 0 … warps-1. On the CPU an exception that a kernel throws leaves launchWarps,
/// and lanes that do not meet in the same collective are a DeviceError naming the launch; the launch's results are then
/// void.
template <class Kernel>
void launchWarps(const Device& device, PhaseName name, uint32_t warps, const Kernel& kernel, uint32_t sharedBytes = 0) {
  static_assert(std::is_trivially_copyable_v<Kernel>);
  if (warps == 0) return;
  Phase phase(device, name);
  if (device.timeline) device.timeline->countLaunch();
#if defined(__CUDACC__)
  if (device.isCuda()) {
    const uint32_t perBlock = detail::warpsPerBlock(sharedBytes);
    const uint32_t stride = detail::roundedShared(sharedBytes);
    detail::beforeLaunch(device, name);
    detail::allowShared(reinterpret_cast<const void*>(&detail::runWarpsOnGrid<Kernel>), name, perBlock * stride);
    detail::runWarpsOnGrid<<<(warps - 1) / perBlock + 1, perBlock * Warp::size, perBlock * stride,
                             static_cast<cudaStream_t>(device.stream)>>>(warps, stride, kernel);
    detail::checkLaunch(device, name);
    return;
  }
#endif
  detail::runWarpsOnFibers(device, name, warps, sharedBytes, &kernel, &detail::callWarpKernel<Kernel>);
}

/// How many warps of `Kernel` the device keeps running at a time: the number to launch of a persistent kernel, whose
/// warps fetch work until none is left; no more than `maxBlocks` blocks per multiprocessor. On the CPU, one per thread.
template <class Kernel>
uint32_t residentWarps(const Device& device, [[maybe_unused]] uint32_t sharedBytes = 0,
                       [[maybe_unused]] uint32_t maxBlocks = ~0u) {
#if defined(__CUDACC__)
  if (device.isCuda()) {
    const uint32_t perBlock = detail::warpsPerBlock(sharedBytes);
    return perBlock * detail::residentBlocks(device, reinterpret_cast<const void*>(&detail::runWarpsOnGrid<Kernel>),
                                             perBlock * Warp::size, perBlock * detail::roundedShared(sharedBytes),
                                             maxBlocks);
  }
#endif
  return static_cast<uint32_t>(device.threads);
}

}  // namespace copse
