// What launchWarps asks the CUDA runtime: shared memory of a block and how many blocks the device holds.
#include <fmt/format.h>

#include <algorithm>

#include "builder/base/error.h"
#include "builder/parallel/cuda_check.h"

namespace copse::detail {

void allowShared(const void* function, const char* name, uint32_t bytesPerBlock) {
  constexpr uint32_t always = 48 * 1024;
  if (bytesPerBlock <= always) return;
  const cudaError_t status =
      cudaFuncSetAttribute(function, cudaFuncAttributeMaxDynamicSharedMemorySize, static_cast<int>(bytesPerBlock));
  if (status == cudaSuccess) return;
  cudaGetLastError();  // As checkCuda does.
  throw DeviceError(fmt::format("launch '{}': {} bytes of shared memory per block: {}", name, bytesPerBlock,
                                cudaGetErrorString(status)));
}

uint32_t residentBlocks(const Device& device, const void* function, uint32_t threads, uint32_t bytesPerBlock,
                        uint32_t maxPerProcessor) {
  bind(device);
  allowShared(function, "occupancy", bytesPerBlock);
  int perProcessor = 0, processors = 0;
  checkCuda(
      cudaOccupancyMaxActiveBlocksPerMultiprocessor(&perProcessor, function, static_cast<int>(threads), bytesPerBlock),
      "cudaOccupancyMaxActiveBlocksPerMultiprocessor");
  checkCuda(cudaDeviceGetAttribute(&processors, cudaDevAttrMultiProcessorCount, device.ordinal),
            "cudaDeviceGetAttribute");
  return std::clamp(static_cast<uint32_t>(perProcessor), 1u, maxPerProcessor) *
         static_cast<uint32_t>(std::max(processors, 1));
}

}  // namespace copse::detail
