// Sort, scan and compaction on CUDA. The only file that includes cub: it costs seconds wherever it is included.
#include "builder/parallel/primitives.h"

#if COPSE_CUDA
#include <thrust/iterator/counting_iterator.h>
#include <thrust/iterator/tabulate_output_iterator.h>
#include <thrust/iterator/transform_iterator.h>
#include <cub/block/block_scan.cuh>
#include <cub/device/device_radix_sort.cuh>
#include <cub/device/device_scan.cuh>
#include <cub/device/device_select.cuh>

#include "builder/parallel/cuda_check.h"
#include "builder/parallel/launch.h"

namespace copse::detail {

namespace {

/// cub's way: asked first for the size of its temporary memory, then to run.
template <class Call>
void withTemporaryMemory(const Device& device, const char* what, Call call) {
  beforeLaunch(device, what);
  std::size_t bytes = 0;
  checkCuda(call(nullptr, bytes), what);
  Buffer<unsigned char> memory(device, bytes ? bytes : 1);
  checkCuda(call(memory.data(), bytes), what);
}

struct IsSet {
  const uint32_t* flags;
  __device__ bool operator()(uint32_t i) const { return flags[i] != 0; }
};

/// What is scanned, and behind it the nothing before which the sum of all stands.
template <class T>
struct InOrNothing {
  const T* in;
  uint32_t n;
  __device__ T operator()(uint32_t i) const { return i < n ? in[i] : 0; }
};
template <class T>
struct OutOrTotal {
  T *out, *total;
  uint32_t n;
  __device__ void operator()(uint32_t i, T value) const { *(i < n ? out + i : total) = value; }
};

// Few numbers are scanned by one block, tile after tile: one launch and no temporary memory, where cub has two and
// takes some. A thread's numbers of a tile, 32 bytes, stay in registers.
constexpr uint32_t scanThreads = 1024, scanMax = 40960;

template <class T>
__global__ void __launch_bounds__(scanThreads) scanInOneBlock(const T* in, T* out, uint32_t n, T* total) {
  constexpr uint32_t perThread = 32 / sizeof(T);
  using Scan = cub::BlockScan<T, scanThreads, cub::BLOCK_SCAN_WARP_SCANS>;
  __shared__ typename Scan::TempStorage shared;
  T before = 0;
  for (uint32_t tile = 0; tile < n; tile += scanThreads * perThread) {
    const uint32_t first = tile + threadIdx.x * perThread;
    T values[perThread], sum;
#pragma unroll
    for (uint32_t k = 0; k < perThread; ++k) values[k] = first + k < n ? in[first + k] : 0;
    Scan(shared).ExclusiveSum(values, values, sum);
#pragma unroll
    for (uint32_t k = 0; k < perThread; ++k)
      if (first + k < n) out[first + k] = before + values[k];
    before += sum;
    __syncthreads();  // The next tile's scan uses the same shared memory.
  }
  if (total && threadIdx.x == 0) *total = before;
}

template <class T>
void scan(const Device& device, uint32_t n, const T* in, T* out, T* total) {
  beforeLaunch(device, "exclusiveScan");
  if (n <= scanMax) {
    scanInOneBlock<<<1, scanThreads, 0, streamOf(device)>>>(in, out, n, total);
    return checkLaunch(device, "exclusiveScan");
  }
  withTemporaryMemory(device, "cub::DeviceScan::ExclusiveSum", [&](void* memory, std::size_t& bytes) {
    if (!total) return cub::DeviceScan::ExclusiveSum(memory, bytes, in, out, n, streamOf(device));
    const auto withEnd = thrust::make_transform_iterator(thrust::counting_iterator<uint32_t>(0), InOrNothing<T>{in, n});
    return cub::DeviceScan::ExclusiveSum(memory, bytes, withEnd,
                                         thrust::make_tabulate_output_iterator(OutOrTotal<T>{out, total, n}),
                                         std::size_t{n} + 1, streamOf(device));
  });
}

}  // namespace

void radixSortCub(const Device& device, uint32_t n, int bits, Buffer<uint64_t>& keys, Buffer<uint32_t>& values,
                  Buffer<uint64_t>& keyScratch, Buffer<uint32_t>& valueScratch) {
  cub::DoubleBuffer<uint64_t> twoKeys(keys.data(), keyScratch.data());
  cub::DoubleBuffer<uint32_t> twoValues(values.data(), valueScratch.data());
  withTemporaryMemory(device, "cub::DeviceRadixSort::SortPairs", [&](void* memory, std::size_t& bytes) {
    return cub::DeviceRadixSort::SortPairs(memory, bytes, twoKeys, twoValues, n, 0, bits, streamOf(device));
  });
  if (twoKeys.Current() != keys.data()) keys.swap(keyScratch);
  if (twoValues.Current() != values.data()) values.swap(valueScratch);
}

void exclusiveScanCub(const Device& device, uint32_t n, const uint32_t* in, uint32_t* out, uint32_t* total) {
  scan(device, n, in, out, total);
}

void exclusiveScanCub(const Device& device, uint32_t n, const uint64_t* in, uint64_t* out, uint64_t* total) {
  scan(device, n, in, out, total);
}

void compactCub(const Device& device, uint32_t n, const uint32_t* flags, uint32_t* out, uint32_t* count) {
  if (n == 0) return fillBytes(device, count, 0, sizeof *count);
  const thrust::counting_iterator<uint32_t> indices(0);
  withTemporaryMemory(device, "cub::DeviceSelect::If", [&](void* memory, std::size_t& bytes) {
    return cub::DeviceSelect::If(memory, bytes, indices, out, count, n, IsSet{flags}, streamOf(device));
  });
}

}  // namespace copse::detail
#endif
