// CUDA keeps the marks of its own pool; the CPU's are kept with its memory.
#include "builder/parallel/device_facts.h"

#include <fstream>
#include <sstream>

#include "builder/parallel/host_memory.h"

#if COPSE_CUDA
#include <fmt/format.h>

#include "builder/parallel/cuda_check.h"
#endif

namespace copse {

#if COPSE_CUDA
namespace {

uint64_t poolMark(const Device& device, cudaMemPoolAttr mark) {
  if (!device.hasPools) return 0;
  detail::bind(device);
  cudaMemPool_t pool = nullptr;
  uint64_t bytes = 0;
  detail::checkCuda(cudaDeviceGetDefaultMemPool(&pool, device.ordinal), "cudaDeviceGetDefaultMemPool");
  detail::checkCuda(cudaMemPoolGetAttribute(pool, mark, &bytes), "cudaMemPoolGetAttribute");
  return bytes;
}

/// "580.65.06" of "NVRM version: NVIDIA UNIX x86_64 Kernel Module  580.65.06  …": the first word that starts with a
/// digit and has a point.
std::string kernelModule() {
  std::ifstream file("/proc/driver/nvidia/version");
  std::string line;
  std::getline(file, line);
  std::istringstream words(line);
  for (std::string word; words >> word;)
    if (word[0] >= '0' && word[0] <= '9' && word.find('.') != std::string::npos) return word;
  return "";
}

std::string versionText(int number) { return fmt::format("{}.{}", number / 1000, number % 1000 / 10); }

}  // namespace
#endif

uint64_t bytesInUse([[maybe_unused]] const Device& device) {
#if COPSE_CUDA
  if (device.isCuda()) return poolMark(device, cudaMemPoolAttrUsedMemCurrent);
#endif
  return detail::hostBytesInUse();
}

void startPeak([[maybe_unused]] const Device& device) {
#if COPSE_CUDA
  if (device.isCuda()) {
    if (!device.hasPools) return;
    detail::bind(device);
    cudaMemPool_t pool = nullptr;
    uint64_t none = 0;  // The one value that this mark can be set to: it starts again from what is in use.
    detail::checkCuda(cudaDeviceGetDefaultMemPool(&pool, device.ordinal), "cudaDeviceGetDefaultMemPool");
    detail::checkCuda(cudaMemPoolSetAttribute(pool, cudaMemPoolAttrUsedMemHigh, &none), "cudaMemPoolSetAttribute");
    return;
  }
#endif
  detail::startHostPeak();
}

uint64_t peakBytes([[maybe_unused]] const Device& device) {
#if COPSE_CUDA
  if (device.isCuda()) return poolMark(device, cudaMemPoolAttrUsedMemHigh);
#endif
  return detail::hostPeakBytes();
}

std::string driverOf([[maybe_unused]] const Device& device) {
#if COPSE_CUDA
  if (device.isCuda()) {
    int number = 0;
    const std::string module = kernelModule();
    if (cudaDriverGetVersion(&number) != cudaSuccess || number == 0) return module;
    return (module.empty() ? "" : module + ", ") + "CUDA " + versionText(number);
  }
#endif
  return "";
}

std::vector<std::pair<std::string, double>> propertiesOf([[maybe_unused]] const Device& device) {
  std::vector<std::pair<std::string, double>> properties;
#if COPSE_CUDA
  if (!device.isCuda()) return properties;
  detail::bind(device);
  std::size_t freeBytes = 0, allBytes = 0;
  if (cudaMemGetInfo(&freeBytes, &allBytes) == cudaSuccess) {
    properties.emplace_back("memory_bytes", static_cast<double>(allBytes));
    properties.emplace_back("memory_free_bytes", static_cast<double>(freeBytes));
  }
  const auto add = [&](const char* name, cudaDeviceAttr attribute, double unit = 1) {
    int value = 0;
    if (cudaDeviceGetAttribute(&value, attribute, device.ordinal) == cudaSuccess)
      properties.emplace_back(name, value * unit);
  };
  add("compute_capability_major", cudaDevAttrComputeCapabilityMajor);
  add("compute_capability_minor", cudaDevAttrComputeCapabilityMinor);
  add("multiprocessors", cudaDevAttrMultiProcessorCount);
  add("threads_per_multiprocessor", cudaDevAttrMaxThreadsPerMultiProcessor);
  add("registers_per_multiprocessor", cudaDevAttrMaxRegistersPerMultiprocessor);
  add("shared_bytes_per_multiprocessor", cudaDevAttrMaxSharedMemoryPerMultiprocessor);
  add("l2_bytes", cudaDevAttrL2CacheSize);
  add("clock_mhz", cudaDevAttrClockRate, 1e-3);
  add("memory_clock_mhz", cudaDevAttrMemoryClockRate, 1e-3);
  add("memory_bus_bits", cudaDevAttrGlobalMemoryBusWidth);
  add("ecc", cudaDevAttrEccEnabled);
  cudaGetLastError();  // A property that is unknown is no error of a launch to come.
#endif
  return properties;
}

std::string cudaToolkit() {
#if COPSE_CUDA
  return versionText(CUDART_VERSION);
#else
  return "";
#endif
}

}  // namespace copse
