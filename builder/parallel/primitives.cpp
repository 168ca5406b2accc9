// Scan and compaction on the CPU's threads; a CUDA device is passed on to cub. The sort is in radix_sort.cpp.
// Each cuts the input into blocks of neighbours, counts per block, scans the counts and writes: where an element goes
// depends on the elements alone, not on how many blocks or threads there are.
#include "builder/parallel/primitives.h"

#include <utility>
#include <vector>

#include "builder/parallel/blocks.h"
#include "builder/parallel/timeline.h"

namespace copse {

using detail::Blocks;

namespace {

template <class T>
void scan(const Device& device, PhaseName name, uint32_t n, const T* in, T* out, T* total) {
  Phase phase(device, name);
  if (device.timeline) device.timeline->countLaunch();
#if COPSE_CUDA
  if (device.isCuda()) return detail::exclusiveScanCub(device, n, in, out, total);
#endif
  const Blocks blocks(device, 0, n);
  std::vector<T> sums(blocks.count);
#pragma omp parallel for schedule(static) num_threads(blocks.count) if (blocks.count > 1)
  for (int b = 0; b < blocks.count; ++b) {
    T sum = 0;
    for (uint32_t i = blocks.begin(b), end = blocks.end(b); i < end; ++i) sum += in[i];
    sums[b] = sum;
  }
  T sum = 0;
  for (T& block : sums) sum += std::exchange(block, sum);
#pragma omp parallel for schedule(static) num_threads(blocks.count) if (blocks.count > 1)
  for (int b = 0; b < blocks.count; ++b) {
    T before = sums[b];
    for (uint32_t i = blocks.begin(b), end = blocks.end(b); i < end; ++i) {
      const T value = in[i];
      out[i] = before;
      before += value;
    }
  }
  if (total) *total = sum;
}

}  // namespace

void exclusiveScan(const Device& device, PhaseName name, uint32_t n, const uint32_t* in, uint32_t* out,
                   uint32_t* total) {
  scan(device, name, n, in, out, total);
}

void exclusiveScan(const Device& device, PhaseName name, uint32_t n, const uint64_t* in, uint64_t* out,
                   uint64_t* total) {
  scan(device, name, n, in, out, total);
}

void compact(const Device& device, PhaseName name, uint32_t n, const uint32_t* flags, uint32_t* out, uint32_t* count) {
  Phase phase(device, name);
  if (device.timeline) device.timeline->countLaunch();
#if COPSE_CUDA
  if (device.isCuda()) return detail::compactCub(device, n, flags, out, count);
#endif
  const Blocks blocks(device, 0, n);
  std::vector<uint32_t> starts(blocks.count);
#pragma omp parallel for schedule(static) num_threads(blocks.count) if (blocks.count > 1)
  for (int b = 0; b < blocks.count; ++b) {
    uint32_t kept = 0;
    for (uint32_t i = blocks.begin(b), end = blocks.end(b); i < end; ++i) kept += flags[i] != 0;
    starts[b] = kept;
  }
  uint32_t sum = 0;
  for (uint32_t& block : starts) sum += std::exchange(block, sum);
#pragma omp parallel for schedule(static) num_threads(blocks.count) if (blocks.count > 1)
  for (int b = 0; b < blocks.count; ++b) {
    uint32_t to = starts[b];
    for (uint32_t i = blocks.begin(b), end = blocks.end(b); i < end; ++i)
      if (flags[i]) out[to++] = i;
  }
  *count = sum;
}

}  // namespace copse
