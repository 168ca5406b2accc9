// Opening devices, their memory and copies. The CPU's memory is the host's own.
#include "builder/parallel/device.h"

#include <fmt/format.h>
#include <omp.h>
#include <sched.h>

#include <atomic>
#include <cstdint>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <latch>
#include <system_error>
#include <thread>

#include "builder/base/error.h"
#include "builder/parallel/host_memory.h"
#include "builder/parallel/memory_traffic.h"

#if COPSE_CUDA
#include "builder/parallel/cuda_check.h"
#endif

namespace copse {

#if COPSE_CUDA
namespace {
/// The launch that an error may come from; kept by value, since a caller's string may be gone by then.
thread_local char lastLaunch[64] = "";
}  // namespace

namespace detail {

void checkCuda(cudaError_t status, const char* call) {
  if (status == cudaSuccess) return;
  // The runtime keeps the error for the next who asks; a launch after this one's message was caught is not to blame.
  cudaGetLastError();
  const std::string after = *lastLaunch ? fmt::format("; last launch '{}'", lastLaunch) : "";
  throw DeviceError(fmt::format("{}: {} ({}){}", call, cudaGetErrorString(status), cudaGetErrorName(status), after));
}

void bind(const Device& device) { checkCuda(cudaSetDevice(device.ordinal), "cudaSetDevice"); }

void beforeLaunch(const Device& device, const char* launch) {
  std::strncpy(lastLaunch, launch, sizeof lastLaunch - 1);
  bind(device);
}

void checkLaunch(const Device&, const char* launch) {
  const cudaError_t status = cudaGetLastError();
  if (status != cudaSuccess)
    throw DeviceError(
        fmt::format("launch '{}': {} ({})", launch, cudaGetErrorString(status), cudaGetErrorName(status)));
}

}  // namespace detail

using detail::checkCuda;
using detail::streamOf;
#endif

namespace {

#if COPSE_CUDA
/// 0 where there is no driver or no device.
int cudaDeviceTotal() {
  int count = 0;
  return cudaGetDeviceCount(&count) == cudaSuccess ? count : 0;
}

Device cudaDevice(int ordinal) {
  cudaDeviceProp properties{};
  checkCuda(cudaGetDeviceProperties(&properties, ordinal), "cudaGetDeviceProperties");
  Device device;
  device.kind = DeviceKind::cuda;
  device.name = properties.name;
  device.ordinal = ordinal;
  int hasPools = 0;
  checkCuda(cudaDeviceGetAttribute(&hasPools, cudaDevAttrMemoryPoolsSupported, ordinal), "cudaDeviceGetAttribute");
  device.hasPools = hasPools != 0;
  if (!device.hasPools) return device;
  // The pool keeps what is released to it; returning memory to the driver at each synchronisation costs milliseconds.
  cudaMemPool_t pool = nullptr;
  checkCuda(cudaDeviceGetDefaultMemPool(&pool, ordinal), "cudaDeviceGetDefaultMemPool");
  uint64_t keepAll = UINT64_MAX;
  checkCuda(cudaMemPoolSetAttribute(pool, cudaMemPoolAttrReleaseThreshold, &keepAll), "cudaMemPoolSetAttribute");
  return device;
}
#endif

constexpr int maxThreads = 1024;

/// Starts `threads` at a time once: where the system refuses one, OpenMP would end the program with a status of its
/// own.
void checkThreads(int threads) {
  static std::atomic<int> known{1};
  if (threads <= known) return;
  std::vector<std::thread> started;
  std::latch all(1);
  std::string refused;
  try {
    while (static_cast<int>(started.size()) + 1 < threads) started.emplace_back([&all] { all.wait(); });
  } catch (const std::system_error& error) {
    refused = fmt::format("cannot start thread {} of {}: {}", started.size() + 2, threads, error.what());
  }
  all.count_down();
  for (std::thread& thread : started) thread.join();
  if (!refused.empty()) throw DeviceError(refused);
  known = threads;
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
  device.threads = threads > 0 ? threads : processorCount();
  return device;
}

}  // namespace

int processorCount() {
  cpu_set_t allowed;
  if (sched_getaffinity(0, sizeof allowed, &allowed) == 0) return CPU_COUNT(&allowed);
  return omp_get_num_procs();
}

Device Device::recording(Timeline& to) const {
  Device copy = *this;
  copy.timeline = &to;
  return copy;
}

std::optional<DeviceChoice> deviceChoice(std::string_view name) {
  if (name == "auto") return DeviceChoice::automatic;
  if (name == "cuda") return DeviceChoice::cuda;
  if (name == "cpu") return DeviceChoice::cpu;
  return {};
}

Device openDevice(const std::string& name, int threads) {
  const std::optional<DeviceChoice> choice = deviceChoice(name);
  if (!choice) throw InputError(fmt::format("unknown device '{}' (expected {})", name, deviceChoices));
  if (threads < 0 || threads > maxThreads)
    throw InputError(fmt::format("threads: expected 0 (every processor) to {}, got {}", maxThreads, threads));
  checkThreads(threads > 0 ? threads : processorCount());
#if COPSE_CUDA
  if (choice != DeviceChoice::cpu) {
    if (cudaDeviceTotal() > 0) {
      Device device = cudaDevice(0);
      device.threads = cpuDevice(threads).threads;
      detail::bind(device);
      return device;
    }
    if (choice == DeviceChoice::cuda) throw DeviceError("no CUDA device or driver found");
  }
#else
  if (choice == DeviceChoice::cuda) throw DeviceError("this build does not support CUDA");
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

namespace {
std::atomic<uint64_t> waits{0}, allocations{0}, transfers{0};
}  // namespace

MemoryTraffic memoryTraffic() {
  return {waits.load(std::memory_order_relaxed), allocations.load(std::memory_order_relaxed),
          transfers.load(std::memory_order_relaxed)};
}

void synchronise([[maybe_unused]] const Device& device) {
  detail::countWait();
#if COPSE_CUDA
  if (!device.isCuda()) return;
  detail::bind(device);
  checkCuda(cudaStreamSynchronize(streamOf(device)), "cudaStreamSynchronize");
#endif
}

namespace detail {
void countWait() { waits.fetch_add(1, std::memory_order_relaxed); }
void countTransfer() { transfers.fetch_add(1, std::memory_order_relaxed); }

std::size_t bytesOf(std::size_t count, std::size_t size) {
  if (count > SIZE_MAX / 2 / size)
    throw DeviceError(fmt::format("out of memory: {} elements of {} bytes", count, size));
  return count * size;
}
}  // namespace detail

void* allocate(const Device& device, std::size_t bytes) {
  allocations.fetch_add(1, std::memory_order_relaxed);
#if COPSE_CUDA
  if (device.isCuda()) {
    detail::bind(device);
    void* memory = nullptr;
    const cudaError_t status =
        device.hasPools ? cudaMallocAsync(&memory, bytes, streamOf(device)) : cudaMalloc(&memory, bytes);
    if (status != cudaSuccess)
      checkCuda(status,
                fmt::format("{} of {} bytes", device.hasPools ? "cudaMallocAsync" : "cudaMalloc", bytes).c_str());
    return memory;
  }
#endif
  (void)device;
  void* memory = detail::takeHostMemory(bytes);
  if (!memory) throw DeviceError(fmt::format("out of memory: {} bytes", bytes));
  return memory;
}

void release(const Device& device, void* memory) noexcept {
#if COPSE_CUDA
  if (device.isCuda()) {
    // A stream of 0 is that of the device that this thread has now, which another thread's buffer may not be of.
    cudaSetDevice(device.ordinal);
    if (device.hasPools) {
      cudaFreeAsync(memory, streamOf(device));
    } else {
      cudaStreamSynchronize(streamOf(device));  // What was launched may use it still.
      cudaFree(memory);
    }
    return;
  }
#endif
  (void)device;
  detail::giveHostMemory(memory);
}

namespace {
void copyAndWait([[maybe_unused]] const Device& device, void* to, const void* from, std::size_t bytes) {
  detail::countTransfer();
  detail::countWait();
#if COPSE_CUDA
  if (device.isCuda()) {
    detail::bind(device);
    checkCuda(cudaMemcpyAsync(to, from, bytes, cudaMemcpyDefault, streamOf(device)), "cudaMemcpyAsync");
    checkCuda(cudaStreamSynchronize(streamOf(device)), "cudaStreamSynchronize");
    return;
  }
#endif
  std::memcpy(to, from, bytes);
}
}  // namespace

void copyToDevice(const Device& device, void* to, const void* from, std::size_t bytes) {
  copyAndWait(device, to, from, bytes);
}
void copyToHost(const Device& device, void* to, const void* from, std::size_t bytes) {
  copyAndWait(device, to, from, bytes);
}
void fillBytes([[maybe_unused]] const Device& device, void* memory, unsigned char value, std::size_t bytes) {
  detail::countTransfer();
#if COPSE_CUDA
  if (device.isCuda()) {
    detail::bind(device);
    checkCuda(cudaMemsetAsync(memory, value, bytes, streamOf(device)), "cudaMemsetAsync");
    return;
  }
#endif
  std::memset(memory, value, bytes);
}

}  // namespace copse
