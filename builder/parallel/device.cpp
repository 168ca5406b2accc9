// Opening devices, their memory and copies. The CPU's memory is the host's own.
#include "builder/parallel/device.h"

#include <fmt/format.h>
#include <omp.h>
#include <sched.h>

#include <cstdlib>
#include <cstring>
#include <fstream>
#include <new>

#include "builder/parallel/error.h"

#if COPSE_CUDA
#include <cuda_runtime.h>
#endif

namespace copse {

namespace {

#if COPSE_CUDA
void check(cudaError_t status, const char* call) {
  if (status != cudaSuccess)
    throw DeviceError(fmt::format("{}: {} ({})", call, cudaGetErrorString(status), cudaGetErrorName(status)));
}

cudaStream_t streamOf(const Device& device) { return static_cast<cudaStream_t>(device.stream); }

/// 0 where there is no driver or no device.
int cudaDeviceTotal() {
  int count = 0;
  return cudaGetDeviceCount(&count) == cudaSuccess ? count : 0;
}

Device cudaDevice(int ordinal) {
  cudaDeviceProp properties{};
  check(cudaGetDeviceProperties(&properties, ordinal), "cudaGetDeviceProperties");
  Device device;
  device.kind = DeviceKind::cuda;
  device.name = properties.name;
  device.ordinal = ordinal;
  return device;
}
#endif

int processors() {
  cpu_set_t allowed;
  if (sched_getaffinity(0, sizeof allowed, &allowed) == 0) return CPU_COUNT(&allowed);
  return omp_get_num_procs();
}

std::string processorName() {
  std::ifstream info("/proc/cpuinfo");
  for (std::string line; std::getline(info, line);)
    if (line.rfind("model name", 0) == 0) {
      const auto colon = line.find(": ");
      if (colon != std::string::npos) return line.substr(colon + 2);
    }
  return "CPU";
}

Device cpuDevice(int threads) {
  Device device;
  device.name = processorName();
  device.threads = threads > 0 ? threads : processors();
  return device;
}

}  // namespace

Device Device::recording(Timeline& to) const {
  Device copy = *this;
  copy.timeline = &to;
  return copy;
}

Device openDevice(const std::string& name, int threads) {
  if (name != "auto" && name != "cpu" && name != "cuda")
    throw InputError(fmt::format("unknown device '{}': auto, cuda or cpu", name));
  if (threads < 0) throw InputError(fmt::format("threads = {}: 0 or more", threads));
#if COPSE_CUDA
  if (name != "cpu") {
    if (cudaDeviceTotal() > 0) {
      Device device = cudaDevice(0);
      device.threads = cpuDevice(threads).threads;
      check(cudaSetDevice(device.ordinal), "cudaSetDevice");
      return device;
    }
    if (name == "cuda") throw DeviceError("no CUDA device is there, or its driver is not");
  }
#else
  if (name == "cuda") throw DeviceError("this build has no CUDA");
#endif
  return cpuDevice(threads);
}

std::vector<Device> listDevices() {
  std::vector<Device> devices{cpuDevice(0)};
#if COPSE_CUDA
  for (int i = 0; i < cudaDeviceTotal(); ++i) devices.push_back(cudaDevice(i));
#endif
  return devices;
}

void synchronise([[maybe_unused]] const Device& device) {
#if COPSE_CUDA
  if (device.isCuda()) check(cudaStreamSynchronize(streamOf(device)), "cudaStreamSynchronize");
#endif
}

void* allocate(const Device& device, std::size_t bytes) {
#if COPSE_CUDA
  if (device.isCuda()) {
    void* memory = nullptr;
    const cudaError_t status = cudaMallocAsync(&memory, bytes, streamOf(device));
    if (status != cudaSuccess)
      throw DeviceError(fmt::format("cudaMallocAsync of {} bytes: {}", bytes, cudaGetErrorString(status)));
    return memory;
  }
#endif
  (void)device;
  const std::size_t rounded = (bytes + 255) / 256 * 256;
  void* memory = std::aligned_alloc(256, rounded);
  if (!memory) throw DeviceError(fmt::format("out of memory: {} bytes", bytes));
  return memory;
}

void release(const Device& device, void* memory) noexcept {
#if COPSE_CUDA
  if (device.isCuda()) {
    cudaFreeAsync(memory, streamOf(device));
    return;
  }
#endif
  (void)device;
  std::free(memory);
}

namespace {
void copy([[maybe_unused]] const Device& device, void* to, const void* from, std::size_t bytes,
          [[maybe_unused]] bool wait) {
#if COPSE_CUDA
  if (device.isCuda()) {
    check(cudaMemcpyAsync(to, from, bytes, cudaMemcpyDefault, streamOf(device)), "cudaMemcpyAsync");
    if (wait) check(cudaStreamSynchronize(streamOf(device)), "cudaStreamSynchronize");
    return;
  }
#endif
  std::memcpy(to, from, bytes);
}
}  // namespace

void copyToDevice(const Device& device, void* to, const void* from, std::size_t bytes) {
  copy(device, to, from, bytes, true);
}
void copyToHost(const Device& device, void* to, const void* from, std::size_t bytes) {
  copy(device, to, from, bytes, true);
}
void copyOnDevice(const Device& device, void* to, const void* from, std::size_t bytes) {
  copy(device, to, from, bytes, false);
}
void fillBytes([[maybe_unused]] const Device& device, void* memory, unsigned char value, std::size_t bytes) {
#if COPSE_CUDA
  if (device.isCuda()) {
    check(cudaMemsetAsync(memory, value, bytes, streamOf(device)), "cudaMemsetAsync");
    return;
  }
#endif
  std::memset(memory, value, bytes);
}

namespace detail {
void checkLaunch([[maybe_unused]] const Device& device, [[maybe_unused]] const char* launch) {
#if COPSE_CUDA
  if (device.isCuda()) check(cudaGetLastError(), launch);
#endif
}
}  // namespace detail

}  // namespace copse
