// Sort, scan and compaction on the CPU's threads; a CUDA device is passed on to cub.
// Each cuts the input into blocks of neighbours, counts per block, scans the counts and writes: where an element goes
// depends on the elements alone, not on how many blocks or threads there are.
#include "builder/parallel/primitives.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <vector>

#include "builder/parallel/error.h"
#include "builder/parallel/timeline.h"

namespace copse {

namespace {

constexpr uint32_t radix = 256;
using Digits = std::array<uint32_t, radix>;

/// Cuts 0 … n-1 into about equal runs, one a thread and none so short that starting a thread costs more.
struct Blocks {
  uint64_t n;
  int count;

  Blocks(const Device& device, uint32_t n)
      : n(n), count(static_cast<int>(std::clamp<uint64_t>(n / 8192, 1, std::max(device.threads, 1)))) {}
  uint32_t begin(int block) const { return static_cast<uint32_t>(n * block / count); }
  uint32_t end(int block) const { return begin(block + 1); }
};

/// The bits in which not all keys agree.
uint64_t differingBits(const Blocks& blocks, const uint64_t* keys) {
  uint64_t differing = 0;
#pragma omp parallel for schedule(static) num_threads(blocks.count) reduction(| : differing) if (blocks.count > 1)
  for (int b = 0; b < blocks.count; ++b) {
    const uint64_t first = keys[0];
    uint64_t seen = 0;
    for (uint32_t i = blocks.begin(b), end = blocks.end(b); i < end; ++i) seen |= keys[i] ^ first;
    differing |= seen;
  }
  return differing;
}

/// One stable pass by the digit at `shift`.
void scatterByDigit(const Blocks& blocks, int shift, uint64_t mask, const uint64_t* keys, const uint32_t* values,
                    uint64_t* keysOut, uint32_t* valuesOut, std::vector<Digits>& offsets) {
#pragma omp parallel for schedule(static) num_threads(blocks.count) if (blocks.count > 1)
  for (int b = 0; b < blocks.count; ++b) {
    Digits counts{};
    for (uint32_t i = blocks.begin(b), end = blocks.end(b); i < end; ++i) ++counts[keys[i] >> shift & mask];
    offsets[b] = counts;
  }
  uint32_t sum = 0;
  for (uint32_t digit = 0; digit < radix; ++digit)
    for (Digits& block : offsets) sum += std::exchange(block[digit], sum);
#pragma omp parallel for schedule(static) num_threads(blocks.count) if (blocks.count > 1)
  for (int b = 0; b < blocks.count; ++b) {
    Digits to = offsets[b];
    for (uint32_t i = blocks.begin(b), end = blocks.end(b); i < end; ++i) {
      const uint64_t key = keys[i];
      const uint32_t place = to[key >> shift & mask]++;
      keysOut[place] = key;
      valuesOut[place] = values[i];
    }
  }
}

template <class T>
void requireSize(const char* name, const Buffer<T>& buffer, uint32_t n) {
  if (buffer.size() < n)
    throw DeviceError(fmt::format("radixSort '{}': a buffer of {} elements for {}", name, buffer.size(), n));
}

}  // namespace

void radixSort(const Device& device, const char* name, uint32_t n, int bits, Buffer<uint64_t>& keys,
               Buffer<uint32_t>& values, Buffer<uint64_t>& keyScratch, Buffer<uint32_t>& valueScratch) {
  if (bits < 1 || bits > 64) throw DeviceError(fmt::format("radixSort '{}': {} bits, not 1 to 64", name, bits));
  requireSize(name, keys, n);
  requireSize(name, values, n);
  requireSize(name, keyScratch, n);
  requireSize(name, valueScratch, n);
  if (n < 2) return;
  Phase phase(device, name);
  if (device.timeline) device.timeline->countLaunch();
#if COPSE_CUDA
  if (device.isCuda()) return detail::radixSortCub(device, n, bits, keys, values, keyScratch, valueScratch);
#endif
  const Blocks blocks(device, n);
  const uint64_t differing = differingBits(blocks, keys.data());
  std::vector<Digits> offsets(blocks.count);
  for (int shift = 0; shift < bits; shift += 8) {
    const uint64_t mask = (uint64_t{1} << std::min(8, bits - shift)) - 1;
    if ((differing >> shift & mask) == 0) continue;
    scatterByDigit(blocks, shift, mask, keys.data(), values.data(), keyScratch.data(), valueScratch.data(), offsets);
    keys.swap(keyScratch);
    values.swap(valueScratch);
  }
}

void exclusiveScan(const Device& device, const char* name, uint32_t n, const uint32_t* in, uint32_t* out,
                   uint32_t* total) {
  Phase phase(device, name);
  if (device.timeline) device.timeline->countLaunch();
#if COPSE_CUDA
  if (device.isCuda()) return detail::exclusiveScanCub(device, n, in, out, total);
#endif
  const Blocks blocks(device, n);
  std::vector<uint32_t> sums(blocks.count);
#pragma omp parallel for schedule(static) num_threads(blocks.count) if (blocks.count > 1)
  for (int b = 0; b < blocks.count; ++b) {
    uint32_t sum = 0;
    for (uint32_t i = blocks.begin(b), end = blocks.end(b); i < end; ++i) sum += in[i];
    sums[b] = sum;
  }
  uint32_t sum = 0;
  for (uint32_t& block : sums) sum += std::exchange(block, sum);
#pragma omp parallel for schedule(static) num_threads(blocks.count) if (blocks.count > 1)
  for (int b = 0; b < blocks.count; ++b) {
    uint32_t before = sums[b];
    for (uint32_t i = blocks.begin(b), end = blocks.end(b); i < end; ++i) {
      const uint32_t value = in[i];
      out[i] = before;
      before += value;
    }
  }
  if (total) *total = sum;
}

void compact(const Device& device, const char* name, uint32_t n, const uint32_t* flags, uint32_t* out,
             uint32_t* count) {
  Phase phase(device, name);
  if (device.timeline) device.timeline->countLaunch();
#if COPSE_CUDA
  if (device.isCuda()) return detail::compactCub(device, n, flags, out, count);
#endif
  const Blocks blocks(device, n);
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
