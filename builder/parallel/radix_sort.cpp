// A stable radix sort on the CPU's threads, most significant digit first; a CUDA device is passed on to cub.
// All threads split the input by the highest eight bits in which keys differ, and again what is left of great length;
// each range then is split further by one thread, in its cache, by fewer bits where it is small, until insertion
// finishes it. Elements move through memory about log256 n times, whatever the keys' width, where a sort by the least
// digit first moves them for each of its digits. At most one move a digit, of three bits at least, so O(n bits) for any
// keys.
#include <fmt/format.h>

#include <array>
#include <bit>
#include <utility>
#include <vector>

#include "builder/parallel/blocks.h"
#include "builder/parallel/error.h"
#include "builder/parallel/platform.h"
#include "builder/parallel/primitives.h"
#include "builder/parallel/timeline.h"

namespace copse {

namespace {

constexpr uint32_t radix = 256;
constexpr uint32_t insertionMost = 24;  ///< Elements that are cheaper inserted than split.
using Digits = std::array<uint32_t, radix>;

struct Elements {
  uint64_t* keys;
  uint32_t* values;
};

/// Elements begin … end-1, which lie in `from` of the sort's two arrays.
struct Range {
  uint32_t begin, end;
  int from;

  uint32_t size() const { return end - begin; }
};

class Sort {
 public:
  Sort(const Device& device, uint64_t mask, Elements data, Elements scratch)
      : device_(device), mask_(mask), arrays_{data, scratch} {}

  /// The result lies in the first array.
  void run(uint32_t n) {
    const uint32_t large = std::max(n / (8 * static_cast<uint32_t>(std::max(device_.threads, 1))), 1u << 16);
    std::vector<Range> waiting{{0, n, 0}}, ranges;
    while (!waiting.empty()) {
      const Range range = waiting.back();
      waiting.pop_back();
      if (range.size() <= large)
        ranges.push_back(range);
      else
        splitByAll(range, waiting);
    }
    const int count = static_cast<int>(ranges.size());
#pragma omp parallel for schedule(dynamic) num_threads(device_.threads) if (count > 1)
    for (int i = 0; i < count; ++i) sortByOne(ranges[i]);
  }

 private:
  /// The lowest bit of the digit to split by; none where all keys agree.
  static constexpr int none = -1;
  static int digitOf(uint64_t differing, int bits = 8) {
    return differing == 0 ? none : std::max(0, static_cast<int>(std::bit_width(differing)) - bits);
  }
  uint32_t digit(uint64_t key, int shift, uint32_t values = radix) const {
    return static_cast<uint32_t>((key & mask_) >> shift) & (values - 1);
  }

  /// The bits in which not all of a range's keys agree.
  uint64_t differing(const uint64_t* keys, uint32_t begin, uint32_t end, uint64_t first) const {
    uint64_t seen = 0;
    for (uint32_t i = begin; i < end; ++i) seen |= keys[i] ^ first;
    return seen & mask_;
  }

  /// One pass by all threads. Ranges that came of it are added to `parts`, in no order that matters.
  void splitByAll(const Range& range, std::vector<Range>& parts) {
    const Elements from = arrays_[range.from], to = arrays_[1 - range.from];
    const detail::Blocks blocks(device_, range.begin, range.end);
    uint64_t seen = 0;
#pragma omp parallel for schedule(static) num_threads(blocks.count) reduction(| : seen) if (blocks.count > 1)
    for (int b = 0; b < blocks.count; ++b)
      seen |= differing(from.keys, blocks.begin(b), blocks.end(b), from.keys[range.begin]);
    // Above the digit the keys agree: they differ nowhere, or were split by those bits before.
    const int shift = digitOf(seen);
    if (shift == none) {
      if (range.from != 0) copyByAll(blocks);
      return;
    }
    std::vector<Digits> offsets(blocks.count);
#pragma omp parallel for schedule(static) num_threads(blocks.count) if (blocks.count > 1)
    for (int b = 0; b < blocks.count; ++b) {
      Digits counts{};
      for (uint32_t i = blocks.begin(b), end = blocks.end(b); i < end; ++i) ++counts[digit(from.keys[i], shift)];
      offsets[b] = counts;
    }
    uint32_t sum = range.begin;
    for (uint32_t d = 0; d < radix; ++d) {
      const uint32_t begin = sum;
      for (Digits& block : offsets) sum += std::exchange(block[d], sum);
      if (sum > begin) parts.push_back({begin, sum, 1 - range.from});
    }
#pragma omp parallel for schedule(static) num_threads(blocks.count) if (blocks.count > 1)
    for (int b = 0; b < blocks.count; ++b) {
      Digits places = offsets[b];
      scatter(from, to, blocks.begin(b), blocks.end(b), shift, places);
    }
  }

  void copyByAll(const detail::Blocks& blocks) const {
#pragma omp parallel for schedule(static) num_threads(blocks.count) if (blocks.count > 1)
    for (int b = 0; b < blocks.count; ++b) copyToFirst(blocks.begin(b), blocks.end(b));
  }

  /// Wholly, in the first array. Deep by the digits of a key at most.
  void sortByOne(const Range& range) const {
    if (range.size() <= insertionMost) return insert(range);
    const Elements from = arrays_[range.from], to = arrays_[1 - range.from];
    // A few elements a value: more values than that take longer to go through than the elements.
    const int bits = std::min(8, static_cast<int>(std::bit_width(range.size())) - 2);
    const uint32_t values = 1u << bits;
    const int shift = digitOf(differing(from.keys, range.begin, range.end, from.keys[range.begin]), bits);
    if (shift == none) {
      if (range.from != 0) copyToFirst(range.begin, range.end);
      return;
    }
    Digits ends;
    std::fill_n(ends.begin(), values, 0u);
    for (uint32_t i = range.begin; i < range.end; ++i) ++ends[digit(from.keys[i], shift, values)];
    uint32_t sum = range.begin;
    for (uint32_t d = 0; d < values; ++d) sum += std::exchange(ends[d], sum);
    scatter(from, to, range.begin, range.end, shift, ends, values);
    uint32_t begin = range.begin;
    for (uint32_t d = 0; d < values; ++d) {
      const uint32_t end = ends[d];
      if (end > begin) sortByOne({begin, end, 1 - range.from});
      begin = end;
    }
  }

  /// Moves begin … end-1 to where `places` has their digits, and `places` past them.
  void scatter(const Elements& from, const Elements& to, uint32_t begin, uint32_t end, int shift,
               Digits& places, uint32_t values = radix) const {
    for (uint32_t i = begin; i < end; ++i) {
      const uint64_t key = from.keys[i];
      const uint32_t place = places[digit(key, shift, values)]++;
      prefetchForStore(to.keys + place + 8);  // The next lines of as many streams as there are digits.
      prefetchForStore(to.values + place + 16);
      to.keys[place] = key;
      to.values[place] = from.values[i];
    }
  }

  void insert(const Range& range) const {
    const Elements from = arrays_[range.from], to = arrays_[0];
    for (uint32_t i = range.begin; i < range.end; ++i) {
      const uint64_t key = from.keys[i];
      const uint32_t value = from.values[i];
      uint32_t at = i;
      for (; at > range.begin && (to.keys[at - 1] & mask_) > (key & mask_); --at) {
        to.keys[at] = to.keys[at - 1];
        to.values[at] = to.values[at - 1];
      }
      to.keys[at] = key;
      to.values[at] = value;
    }
  }

  void copyToFirst(uint32_t begin, uint32_t end) const {
    std::copy(arrays_[1].keys + begin, arrays_[1].keys + end, arrays_[0].keys + begin);
    std::copy(arrays_[1].values + begin, arrays_[1].values + end, arrays_[0].values + begin);
  }

  const Device& device_;
  uint64_t mask_;  ///< The bits that are sorted by.
  Elements arrays_[2];
};

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
  const uint64_t mask = ~uint64_t{0} >> (64 - bits);
  Sort(device, mask, {keys.data(), values.data()}, {keyScratch.data(), valueScratch.data()}).run(n);
}

}  // namespace copse
