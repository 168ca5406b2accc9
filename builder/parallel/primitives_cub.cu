// Sort, scan and compaction on CUDA. The only file that includes cub: it costs seconds wherever it is included.
#include "builder/parallel/primitives.h"

#if COPSE_CUDA
#include <cub/device/device_radix_sort.cuh>
#include <cub/device/device_scan.cuh>
#include <cub/device/device_select.cuh>
#include <thrust/iterator/counting_iterator.h>

#include "builder/parallel/cuda_check.h"
#include "builder/parallel/launch.h"

namespace copse::detail {

namespace {

/// cub's way: asked first for the size of its temporary memory, then to run.
template <class Call>
void withTemporaryMemory(const Device& device, const char* what, Call call) {
  std::size_t bytes = 0;
  checkCuda(call(nullptr, bytes), what);
  Buffer<unsigned char> memory(device, bytes ? bytes : 1);
  checkCuda(call(memory.data(), bytes), what);
}

struct IsSet {
  const uint32_t* flags;
  __device__ bool operator()(uint32_t i) const { return flags[i] != 0; }
};

/// The scan alone forgets the last element, and `in` may be overwritten by it: keep that element, then add.
__global__ void keepLast(const uint32_t* in, uint32_t n, uint32_t* total) { *total = n ? in[n - 1] : 0; }
__global__ void addLast(const uint32_t* out, uint32_t n, uint32_t* total) {
  if (n) *total += out[n - 1];
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
  if (total) keepLast<<<1, 1, 0, streamOf(device)>>>(in, n, total);
  if (n)
    withTemporaryMemory(device, "cub::DeviceScan::ExclusiveSum", [&](void* memory, std::size_t& bytes) {
      return cub::DeviceScan::ExclusiveSum(memory, bytes, in, out, n, streamOf(device));
    });
  if (total) addLast<<<1, 1, 0, streamOf(device)>>>(out, n, total);
  checkLaunch(device, "exclusiveScan");
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
