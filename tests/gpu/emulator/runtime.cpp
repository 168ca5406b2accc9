// The functions of the CUDA runtime that Copse and CUB call, over the machine. Work on the stream is deferred until the
// host waits, so that a host that reads too early reads poison. There is one stream, as in Copse.
#include <cuda_runtime_api.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <deque>
#include <functional>
#include <map>
#include <mutex>
#include <string>
#include <unordered_map>
#include <utility>

#include "grid.h"

namespace {

using namespace emulator;

constexpr int multiprocessors = 2, defaultShared = 48 * 1024;
constexpr size_t memoryBytes = size_t(80) << 30, largestBlock = size_t(8) << 30;

struct Event {
  double milliseconds = 0;
  bool recorded = false;
};

struct Configuration {
  dim3 grid, block;
  size_t shared;
  void* stream;
};

struct Runtime {
  std::recursive_mutex mutex;
  std::unordered_map<const void*, std::string> names;      ///< Kernel names, by the host's function.
  std::unordered_map<const void*, size_t> dynamicAllowed;  ///< Shared memory that was requested.
  std::deque<std::function<void()>> stream;
  std::vector<Configuration> configurations;
  size_t inUse = 0, highest = 0;
  cudaError_t last = cudaSuccess, lost = cudaSuccess;  ///< A lost device returns nothing else.
};

Runtime& runtime() {
  static Runtime* const only = new Runtime;
  return *only;
}

using Lock = std::lock_guard<std::recursive_mutex>;

cudaError_t answer(cudaError_t status) {
  if (runtime().lost != cudaSuccess) status = runtime().lost;
  if (status != cudaSuccess) runtime().last = status;
  return status;
}

void put(std::function<void()> work) { runtime().stream.push_back(std::move(work)); }

void drain() {
  auto& stream = runtime().stream;
  while (!stream.empty()) {
    const auto work = std::move(stream.front());
    stream.pop_front();
    work();
  }
}

const Kernel* kernelOf(const void* host) {
  const auto name = runtime().names.find(host);
  if (name == runtime().names.end()) return nullptr;
  const Kernel* kernel = findKernel(name->second);
  if (!kernel) std::fprintf(stderr, "emulator: no translation of %s\n", name->second.c_str());
  return kernel;
}

cudaError_t launch(const void* host, dim3 grid, dim3 block, void** arguments, size_t shared, bool cooperative) {
  const Lock lock(runtime().mutex);
  count("launch");
  const Kernel* kernel = kernelOf(host);
  if (!kernel) return answer(cudaErrorInvalidDeviceFunction);
  const size_t blocks = size_t(grid.x) * grid.y * grid.z, threads = size_t(block.x) * block.y * block.z;
  if (blocks == 0 || threads == 0 || threads > maxThreads || grid.y > 65535 || grid.z > 65535)
    return answer(cudaErrorInvalidConfiguration);
  if (threads > kernel->maxThreads) return answer(cudaErrorLaunchOutOfResources);
  const size_t allowed = std::max<size_t>(runtime().dynamicAllowed[host], defaultShared - kernel->staticShared);
  if (shared > allowed) return answer(cudaErrorInvalidValue);
  if (cooperative && blocks > size_t(multiprocessors) * setting("RESIDENT", 2))
    return answer(cudaErrorCooperativeLaunchTooLarge);
  Launch work{kernel,
              {grid.x, grid.y, grid.z},
              {block.x, block.y, block.z},
              static_cast<uint32_t>(shared),
              cooperative,
              std::vector<uint8_t>(kernel->parameterBytes + 64, 0xee)};
  for (uint32_t i = 0; i < kernel->parameterCount; ++i)
    std::memcpy(work.parameters.data() + kernel->offsets[i], arguments[i], kernel->sizes[i]);
  put([work = std::move(work)] {
    if (runtime().lost == cudaSuccess && !run(work)) runtime().lost = cudaErrorIllegalAddress;
  });
  return answer(cudaSuccess);
}

/// Whether memory is the device's or pinned; the first byte decides.
cudaError_t take(void** block, size_t bytes, bool ofHost) {
  const Lock lock(runtime().mutex);
  count("allocation");
  *block = bytes > largestBlock ? nullptr : allocate(bytes, ofHost);
  if (!*block) return answer(cudaErrorMemoryAllocation);
  if (!ofHost) runtime().inUse += bytes;
  runtime().highest = std::max(runtime().highest, runtime().inUse);
  return answer(cudaSuccess);
}

cudaError_t wait() {
  const Lock lock(runtime().mutex);
  count("wait");
  drain();
  checkAllBlocks();
  return answer(cudaSuccess);
}

cudaError_t copy(void* to, const void* from, size_t bytes) {
  const Lock lock(runtime().mutex);
  count("copy");
  const Place target = placeOf(to, bytes);
  if (target.found && placeOf(from, bytes).found) {
    if (target.ofHost) std::memset(to, 0xcb, bytes);  // What a host reads that does not wait.
    put([=] { std::memcpy(to, from, bytes); });
  } else {
    count("wait for a copy of pageable memory");
    drain();
    if (runtime().lost == cudaSuccess) std::memcpy(to, from, bytes);
  }
  return answer(cudaSuccess);
}

cudaError_t giveBack(void* block, bool now) {
  const Lock lock(runtime().mutex);
  if (!block) return answer(cudaSuccess);
  const auto bytes = sizeAt(block);
  if (!bytes) {
    std::fprintf(stderr, "emulator: free of memory that was not allocated\n");
    std::abort();
  }
  runtime().inUse -= *bytes;
  put([=] { release(block); });
  if (now) drain();
  return answer(cudaSuccess);
}

}  // namespace

extern "C" {

void** __cudaRegisterFatBinary(void*) {
  static void* handle = nullptr;
  return &handle;
}
void __cudaRegisterFatBinaryEnd(void**) {}
void __cudaUnregisterFatBinary(void**) {}
void __cudaRegisterVar(void**, char*, char*, const char*, int, size_t, int, int) {}
void __cudaRegisterFunction(void**, const char* host, char*, const char* name, int, uint3*, uint3*, dim3*, dim3*,
                            int*) {
  runtime().names[host] = name;
}
unsigned __cudaPushCallConfiguration(dim3 grid, dim3 block, size_t shared, struct CUstream_st* stream) {
  runtime().configurations.push_back({grid, block, shared, stream});
  return 0;
}
cudaError_t __cudaPopCallConfiguration(dim3* grid, dim3* block, size_t* shared, void* stream) {
  const Configuration last = runtime().configurations.back();
  runtime().configurations.pop_back();
  *grid = last.grid;
  *block = last.block;
  *shared = last.shared;
  *static_cast<void**>(stream) = last.stream;
  return cudaSuccess;
}
cudaError_t __cudaGetKernel(cudaKernel_t* kernel, const void* host) {
  *kernel = static_cast<cudaKernel_t>(const_cast<void*>(host));
  return cudaSuccess;
}
cudaError_t __cudaLaunchKernel(cudaKernel_t kernel, dim3 grid, dim3 block, void** arguments, size_t shared,
                               cudaStream_t) {
  return launch(kernel, grid, block, arguments, shared, false);
}
cudaError_t cudaLaunchKernel(const void* kernel, dim3 grid, dim3 block, void** arguments, size_t shared, cudaStream_t) {
  return launch(kernel, grid, block, arguments, shared, false);
}
cudaError_t cudaLaunchKernelExC(const cudaLaunchConfig_t* config, const void* kernel, void** arguments) {
  return launch(kernel, config->gridDim, config->blockDim, arguments, config->dynamicSmemBytes, false);
}
cudaError_t cudaLaunchCooperativeKernel(const void* kernel, dim3 grid, dim3 block, void** arguments, size_t shared,
                                        cudaStream_t) {
  return launch(kernel, grid, block, arguments, shared, true);
}

cudaError_t cudaGetLastError() { return std::exchange(runtime().last, runtime().lost); }
cudaError_t cudaPeekAtLastError() { return runtime().last; }
const char* cudaGetErrorName(cudaError_t status) {
  switch (status) {
    case cudaSuccess:
      return "cudaSuccess";
    case cudaErrorInvalidValue:
      return "cudaErrorInvalidValue";
    case cudaErrorMemoryAllocation:
      return "cudaErrorMemoryAllocation";
    case cudaErrorInvalidConfiguration:
      return "cudaErrorInvalidConfiguration";
    case cudaErrorInvalidDeviceFunction:
      return "cudaErrorInvalidDeviceFunction";
    case cudaErrorInvalidDevice:
      return "cudaErrorInvalidDevice";
    case cudaErrorIllegalAddress:
      return "cudaErrorIllegalAddress";
    case cudaErrorCooperativeLaunchTooLarge:
      return "cudaErrorCooperativeLaunchTooLarge";
    case cudaErrorNotSupported:
      return "cudaErrorNotSupported";
    case cudaErrorNotReady:
      return "cudaErrorNotReady";
    case cudaErrorLaunchOutOfResources:
      return "cudaErrorLaunchOutOfResources";
    default:
      return "cudaErrorUnknown";
  }
}
const char* cudaGetErrorString(cudaError_t status) {
  switch (status) {
    case cudaSuccess:
      return "no error";
    case cudaErrorMemoryAllocation:
      return "out of memory";
    case cudaErrorInvalidValue:
      return "invalid argument";
    case cudaErrorIllegalAddress:
      return "an illegal memory access was encountered";
    default:
      return cudaGetErrorName(status);
  }
}

cudaError_t cudaGetDeviceCount(int* devices) {
  *devices = setting("DEVICES", 1);
  return cudaSuccess;
}
cudaError_t cudaGetDevice(int* device) {
  *device = 0;
  return cudaSuccess;
}
cudaError_t cudaSetDevice(int device) {
  return device >= 0 && device < setting("DEVICES", 1) ? answer(cudaSuccess) : answer(cudaErrorInvalidDevice);
}
cudaError_t cudaDriverGetVersion(int* version) {
  *version = CUDART_VERSION;
  return cudaSuccess;
}
cudaError_t cudaDeviceGetAttribute(int* value, cudaDeviceAttr attribute, int) {
  switch (attribute) {
    case cudaDevAttrMultiProcessorCount:
      *value = multiprocessors;
      break;
    case cudaDevAttrComputeCapabilityMajor:
      *value = 9;
      break;
    case cudaDevAttrComputeCapabilityMinor:
      *value = 0;
      break;
    case cudaDevAttrMaxGridDimX:
      *value = 0x7fffffff;
      break;
    case cudaDevAttrMaxSharedMemoryPerBlock:
      *value = defaultShared;
      break;
    case cudaDevAttrMaxSharedMemoryPerBlockOptin:
      *value = maxShared;
      break;
    case cudaDevAttrMaxThreadsPerMultiProcessor:
      *value = 2048;
      break;
    case cudaDevAttrMaxThreadsPerBlock:
      *value = maxThreads;
      break;
    case cudaDevAttrWarpSize:
      *value = 32;
      break;
    case cudaDevAttrMemoryPoolsSupported:
      *value = setting("POOLS", 1);
      break;
    case cudaDevAttrCooperativeLaunch:
      *value = 1;
      break;
    default:
      *value = 1;
  }
  return answer(cudaSuccess);
}
cudaError_t cudaGetDeviceProperties(cudaDeviceProp* properties, int) {
  std::memset(properties, 0, sizeof *properties);
  std::strcpy(properties->name, "emulated");
  properties->major = 9;
  properties->multiProcessorCount = multiprocessors;
  properties->totalGlobalMem = memoryBytes;
  return answer(cudaSuccess);
}
cudaError_t cudaOccupancyMaxActiveBlocksPerMultiprocessorWithFlags(int* blocks, const void* kernel, int, size_t,
                                                                   unsigned) {
  *blocks = setting("RESIDENT", 2);
  return kernelOf(kernel) ? answer(cudaSuccess) : answer(cudaErrorInvalidDeviceFunction);
}
cudaError_t cudaOccupancyMaxActiveBlocksPerMultiprocessor(int* blocks, const void* kernel, int threads, size_t shared) {
  count("occupancy query");
  return cudaOccupancyMaxActiveBlocksPerMultiprocessorWithFlags(blocks, kernel, threads, shared, 0);
}
cudaError_t cudaFuncSetAttribute(const void* kernel, cudaFuncAttribute attribute, int value) {
  if (attribute != cudaFuncAttributeMaxDynamicSharedMemorySize) return answer(cudaSuccess);
  if (value > static_cast<int>(maxShared)) return answer(cudaErrorInvalidValue);
  runtime().dynamicAllowed[kernel] = value;
  return answer(cudaSuccess);
}
cudaError_t cudaFuncGetAttributes(cudaFuncAttributes* attributes, const void* kernel) {
  std::memset(attributes, 0, sizeof *attributes);
  attributes->ptxVersion = attributes->binaryVersion = 90;
  attributes->maxThreadsPerBlock = maxThreads;
  return kernelOf(kernel) ? answer(cudaSuccess) : answer(cudaErrorInvalidDeviceFunction);
}

cudaError_t cudaDeviceGetDefaultMemPool(cudaMemPool_t* pool, int) {
  *pool = nullptr;
  return answer(setting("POOLS", 1) ? cudaSuccess : cudaErrorNotSupported);
}
cudaError_t cudaMemPoolSetAttribute(cudaMemPool_t, cudaMemPoolAttr attribute, void*) {
  if (attribute == cudaMemPoolAttrUsedMemHigh) runtime().highest = runtime().inUse;
  return answer(cudaSuccess);
}
cudaError_t cudaMemPoolGetAttribute(cudaMemPool_t, cudaMemPoolAttr attribute, void* value) {
  const uint64_t bytes = attribute == cudaMemPoolAttrUsedMemHigh ? runtime().highest : runtime().inUse;
  std::memcpy(value, &bytes, sizeof bytes);
  return answer(cudaSuccess);
}
cudaError_t cudaMemGetInfo(size_t* free, size_t* total) {
  *free = memoryBytes - runtime().inUse;
  *total = memoryBytes;
  return answer(cudaSuccess);
}
cudaError_t cudaMallocAsync(void** block, size_t bytes, cudaStream_t) {
  if (!setting("POOLS", 1)) return answer(cudaErrorNotSupported);
  return take(block, bytes, false);
}
cudaError_t cudaFreeAsync(void* block, cudaStream_t) { return giveBack(block, false); }
cudaError_t cudaMalloc(void** block, size_t bytes) { return take(block, bytes, false); }
cudaError_t cudaFree(void* block) { return giveBack(block, true); }
cudaError_t cudaHostAlloc(void** block, size_t bytes, unsigned) { return take(block, bytes, true); }

cudaError_t cudaMemcpyAsync(void* to, const void* from, size_t bytes, cudaMemcpyKind, cudaStream_t) {
  return copy(to, from, bytes);
}
cudaError_t cudaMemsetAsync(void* to, int value, size_t bytes, cudaStream_t) {
  const Lock lock(runtime().mutex);
  count("memset");
  if (bytes > 0 && !placeOf(to, bytes).found) return answer(cudaErrorInvalidValue);
  put([=] { std::memset(to, value, bytes); });
  return answer(cudaSuccess);
}

cudaError_t cudaStreamSynchronize(cudaStream_t) { return wait(); }
cudaError_t cudaDeviceSynchronize() { return wait(); }

cudaError_t cudaEventCreate(cudaEvent_t* event) {
  *event = reinterpret_cast<cudaEvent_t>(new Event);
  return answer(cudaSuccess);
}
cudaError_t cudaEventCreateWithFlags(cudaEvent_t* event, unsigned) { return cudaEventCreate(event); }
cudaError_t cudaEventDestroy(cudaEvent_t event) {
  const Lock lock(runtime().mutex);
  put([=] { delete reinterpret_cast<Event*>(event); });
  return answer(cudaSuccess);
}
cudaError_t cudaEventRecord(cudaEvent_t event, cudaStream_t) {
  const Lock lock(runtime().mutex);
  count("event");
  reinterpret_cast<Event*>(event)->recorded = false;
  put([=] {
    const auto now = std::chrono::steady_clock::now().time_since_epoch();
    *reinterpret_cast<Event*>(event) = {std::chrono::duration<double, std::milli>(now).count(), true};
  });
  return answer(cudaSuccess);
}
cudaError_t cudaEventSynchronize(cudaEvent_t) { return wait(); }
cudaError_t cudaEventElapsedTime(float* milliseconds, cudaEvent_t from, cudaEvent_t to) {
  const auto &first = *reinterpret_cast<const Event*>(from), &second = *reinterpret_cast<const Event*>(to);
  if (!first.recorded || !second.recorded) return answer(cudaErrorNotReady);
  *milliseconds = static_cast<float>(second.milliseconds - first.milliseconds);
  return answer(cudaSuccess);
}

}  // extern "C"
