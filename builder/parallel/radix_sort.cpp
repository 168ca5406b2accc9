// A stable radix sort on the CPU's threads, most significant digit first; a CUDA device is passed on to cub.
// All threads split the input by the highest eight bits in which keys differ, and again what is left of great length;
// each range then is split further by one thread, in its cache, by fewer bits where it is small, until insertion
// finishes it. Elements move through memory about log256 n times, whatever the keys' width, where a sort by the lowest
// digit first moves them for each of its digits. At most one move per digit of three bits or more, so O(n bits) for any
// keys.
#include <fmt/format.h>

#include <array>
#include <bit>
#include <span>
#include <utility>
#include <vector>

#include "builder/base/error.h"
#include "builder/parallel/blocks.h"
#include "builder/parallel/platform.h"
#include "builder/parallel/primitives.h"
#include "builder/parallel/timeline.h"

namespace copse {

namespace {

constexpr uint32_t radix = 256;
constexpr uint32_t insertionMax = 24;  ///< Elements that are cheaper inserted than split.
constexpr uint32_t smallMax = 4096;    ///< Elements that are split with a minimum of preparation.
using Digits = std::array<uint32_t, radix>;

struct Elements {
  uint64_t* keys;
  uint32_t* values;
};

/// Elements begin … end-1, which lie in `from` of the sort's two arrays. Their keys agree in all bits but the lowest
/// `bits`.
struct Range {
  uint32_t begin, end;
  int from, bits;

  uint32_t size() const { return end - begin; }
};

class Sort {
 public:
  Sort(const Device& device, uint64_t mask, Elements data, Elements scratch)
      : device_(device), mask_(mask), arrays_{data, scratch} {}

  /// The result lies in the first array.
  void run(uint32_t n) {
    const uint32_t large = std::max(n / (8 * static_cast<uint32_t>(std::max(device_.threads, 1))), 1u << 16);
    std::vector<Range> waiting{{0, n, 0, static_cast<int>(std::bit_width(mask_))}}, ranges;
    while (!waiting.empty()) {
      const Range range = waiting.back();
      waiting.pop_back();
      if (range.size() <= large)
        ranges.push_back(range);
      else
        split(range, detail::Blocks(device_, range.begin, range.end).count,
              [&](const Range& part) { waiting.push_back(part); });
    }
    const int count = static_cast<int>(ranges.size());
#pragma omp parallel for schedule(dynamic) num_threads(device_.threads) if (count > 1)
    for (int i = 0; i < count; ++i) sortByOne(ranges[i]);
  }

 private:
  /// The lowest bit of the digit to split by keys that agree in all but the lowest `bits`.
  static int lowestBit(int bits, int digitBits = 8) { return std::max(0, bits - digitBits); }
  uint32_t digit(uint64_t key, int shift, uint32_t values = radix) const {
    return static_cast<uint32_t>((key & mask_) >> shift) & (values - 1);
  }

  /// The bits in which not all keys of a range agree.
  uint64_t differingBits(const uint64_t* keys, const Range& range) const {
    uint64_t seen = 0;
    for (uint32_t i = range.begin; i < range.end; ++i) seen |= keys[i] ^ keys[range.begin];
    return seen & mask_;
  }

  /// Runs that a thread goes through side by side: neighbours often have the same digit, and the next increment of a
  /// count has to wait for the one before.
  static constexpr int sideBySide = 4;

  /// visit(r, i) for each element of runs begin + r, r = 0 … sideBySide-1, those of a run in their order.
  template <class Visit>
  static void visitRuns(const detail::Blocks& runs, int begin, const Visit& visit) {
    uint32_t at[sideBySide], steps = ~0u;
    for (int r = 0; r < sideBySide; ++r) {
      at[r] = runs.begin(begin + r);
      steps = std::min(steps, runs.end(begin + r) - at[r]);
    }
    for (uint32_t k = 0; k < steps; ++k)
      for (int r = 0; r < sideBySide; ++r) visit(r, at[r] + k);
    for (int r = 0; r < sideBySide; ++r)
      for (uint32_t i = at[r] + steps; i < runs.end(begin + r); ++i) visit(r, i);
  }

  /// Moves a range to the other array, split by its highest digit, and calls part() for each range that came of it. One
  /// whose keys agree is done: it is moved to the first array.
  template <class Part>
  void split(const Range& range, int threads, const Part& part) const {
    const Elements from = arrays_[range.from], to = arrays_[1 - range.from];
    const detail::Blocks runs(range.begin, range.end, threads * sideBySide);
    Digits ofOne[sideBySide];
    std::vector<Digits> ofAll(threads > 1 ? runs.count : 0);
    const std::span<Digits> offsets = threads > 1 ? std::span<Digits>(ofAll) : std::span<Digits>(ofOne);
    const auto count = [&](int shift) {
      const uint64_t first = from.keys[range.begin];
      uint64_t seen = 0;
#pragma omp parallel for schedule(static) num_threads(threads) reduction(| : seen) if (threads > 1)
      for (int b = 0; b < runs.count; b += sideBySide) {
        Digits counts[sideBySide]{};
        visitRuns(runs, b, [&](int r, uint32_t i) {
          seen |= from.keys[i] ^ first;
          ++counts[r][digit(from.keys[i], shift)];
        });
        std::copy_n(counts, sideBySide, offsets.begin() + b);
      }
      return static_cast<int>(std::bit_width(seen & mask_));
    };
    // The digit to split by is often the next below the one before, which spares a pass that only finds it out.
    int shift = lowestBit(range.bits);
    const int bits = count(shift);
    if (bits == 0) {
      if (range.from == 0) return;
#pragma omp parallel for schedule(static) num_threads(threads) if (threads > 1)
      for (int b = 0; b < runs.count; ++b) copyToFirst(runs.begin(b), runs.end(b));
      return;
    }
    if (lowestBit(bits) != shift) count(shift = lowestBit(bits));
    std::array<uint32_t, radix + 1> begins{};
    uint32_t sum = range.begin;
    for (uint32_t d = 0; d < radix; ++d) {
      begins[d] = sum;
      for (Digits& run : offsets) sum += std::exchange(run[d], sum);
    }
    begins[radix] = sum;
#pragma omp parallel for schedule(static) num_threads(threads) if (threads > 1)
    for (int b = 0; b < runs.count; b += sideBySide) {
      Digits places[sideBySide];
      std::copy_n(offsets.begin() + b, sideBySide, places);
      visitRuns(runs, b, [&](int r, uint32_t i) { move(from, to, i, places[r][digit(from.keys[i], shift)]++); });
    }
    for (uint32_t d = 0; d < radix; ++d)
      if (begins[d + 1] > begins[d]) part(Range{begins[d], begins[d + 1], 1 - range.from, shift});
  }

  /// Sorts it wholly, into the first array. The recursion is no deeper than a key has digits.
  void sortByOne(const Range& range) const {
    if (range.size() <= insertionMax) return insert(range);
    if (range.size() > smallMax) return split(range, 1, [this](const Range& part) { sortByOne(part); });
    const Elements from = arrays_[range.from], to = arrays_[1 - range.from];
    const uint64_t differing = differingBits(from.keys, range);
    if (differing == 0) {
      if (range.from != 0) copyToFirst(range.begin, range.end);
      return;
    }
    // A few elements per value: more values than that take longer to go through than the elements.
    const int digitBits = std::min(8, static_cast<int>(std::bit_width(range.size())) - 2);
    const uint32_t values = 1u << digitBits;
    const int shift = lowestBit(static_cast<int>(std::bit_width(differing)), digitBits);
    Digits ends;
    std::fill_n(ends.begin(), values, 0u);
    for (uint32_t i = range.begin; i < range.end; ++i) ++ends[digit(from.keys[i], shift, values)];
    uint32_t sum = range.begin;
    for (uint32_t d = 0; d < values; ++d) sum += std::exchange(ends[d], sum);
    for (uint32_t i = range.begin; i < range.end; ++i) move(from, to, i, ends[digit(from.keys[i], shift, values)]++);
    uint32_t begin = range.begin;
    for (uint32_t d = 0; d < values; ++d) {
      const uint32_t end = ends[d];
      if (end > begin) sortByOne({begin, end, 1 - range.from, shift});
      begin = end;
    }
  }

  static void move(const Elements& from, const Elements& to, uint32_t i, uint32_t place) {
    prefetchForStore(to.keys + place + 8);  // The next lines of as many streams as there are digits.
    prefetchForStore(to.values + place + 16);
    to.keys[place] = from.keys[i];
    to.values[place] = from.values[i];
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
    throw DeviceError(fmt::format("radixSort '{}': expected buffers of {} elements, got {}", name, n, buffer.size()));
}

}  // namespace

void radixSort(const Device& device, PhaseName name, uint32_t n, int bits, Buffer<uint64_t>& keys,
               Buffer<uint32_t>& values, Buffer<uint64_t>& keyScratch, Buffer<uint32_t>& valueScratch) {
  if (bits < 1 || bits > 64)
    throw DeviceError(fmt::format("radixSort '{}': expected 1 to 64 bits, got {}", name.text, bits));
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
