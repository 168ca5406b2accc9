// builder/parallel: sort, scan, compaction and reduction against the standard library, at sizes round block boundaries.
#include <algorithm>
#include <map>
#include <numeric>
#include <random>

#include "builder/base/error.h"
#include "builder/parallel/primitives.h"
#include "tests/support/catch.h"
#include "tests/support/devices.h"

using namespace copse;

namespace {

const std::vector<uint32_t> sizes = {0, 1, 2, 3, 255, 256, 257, 8191, 8193, 40960, 40961, 99999, (1u << 20) + 3};

/// The devices, the CPU with several numbers of threads.
std::vector<Device> devicesAndThreads() {
  std::vector<Device> all;
  for (const Device& device : test::devices())
    for (const int threads : {1, 2, 3, 8}) {
      all.push_back(device);
      all.back().threads = threads;
      if (device.isCuda()) break;
    }
  return all;
}

struct Pairs {
  std::vector<uint64_t> keys;
  std::vector<uint32_t> values;
};

Pairs sortOnDevice(const Device& device, const Pairs& in, int bits) {
  const auto n = static_cast<uint32_t>(in.keys.size());
  Buffer<uint64_t> keys(device, in.keys), keyScratch(device, n);
  Buffer<uint32_t> values(device, in.values), valueScratch(device, n);
  radixSort(device, "sort", n, bits, keys, values, keyScratch, valueScratch);
  return {keys.toHost(), values.toHost()};
}

Pairs sortOnHost(const Pairs& in, int bits) {
  const uint64_t mask = bits == 64 ? ~uint64_t{0} : (uint64_t{1} << bits) - 1;
  std::vector<uint32_t> order(in.keys.size());
  std::iota(order.begin(), order.end(), 0u);
  std::stable_sort(order.begin(), order.end(),
                   [&](uint32_t a, uint32_t b) { return (in.keys[a] & mask) < (in.keys[b] & mask); });
  Pairs out;
  for (const uint32_t i : order) {
    out.keys.push_back(in.keys[i]);
    out.values.push_back(in.values[i]);
  }
  return out;
}

Pairs randomPairs(uint32_t n, uint64_t keyMask) {
  std::mt19937_64 random(n + keyMask);
  Pairs pairs;
  for (uint32_t i = 0; i < n; ++i) {
    pairs.keys.push_back(random() & keyMask);
    pairs.values.push_back(i);
  }
  return pairs;
}

}  // namespace

TEST_CASE("radixSort sorts as a stable sort does at every size") {
  std::map<uint32_t, Pairs> expected;
  for (const Device& device : devicesAndThreads())
    for (const uint32_t n : sizes) {
      if (n > 100'000 && test::isEmulated(device)) continue;
      const Pairs in = randomPairs(n, ~uint64_t{0});
      const Pairs out = sortOnDevice(device, in, 64);
      CAPTURE(device.name, device.threads, n);
      if (device.threads == 1 || device.isCuda()) expected[n] = sortOnHost(in, 64);
      REQUIRE(out.keys == expected[n].keys);
      REQUIRE(out.values == expected[n].values);
    }
}

TEST_CASE("radixSort keeps the order of equal keys") {
  for (const Device& device : devicesAndThreads())
    for (const uint64_t mask : {uint64_t{0}, uint64_t{3}, uint64_t{0xff00}, uint64_t{7} << 60}) {
      const Pairs in = randomPairs(50001, mask);
      const Pairs out = sortOnDevice(device, in, 64), expected = sortOnHost(in, 64);
      CAPTURE(device.name, device.threads, mask);
      REQUIRE(out.keys == expected.keys);
      REQUIRE(out.values == expected.values);
    }
}

TEST_CASE("radixSort puts back what one split leaves as long runs of equal keys") {
  for (const uint64_t keyMask : {uint64_t{1}, uint64_t{1} << 63, uint64_t{1} << 63 | 1, uint64_t{1} << 40 | 1 << 20}) {
    const Pairs in = randomPairs(400'000, keyMask);
    const Pairs expected = sortOnHost(in, 64);
    for (const Device& device : devicesAndThreads()) {
      CAPTURE(device.name, device.threads, keyMask);
      const Pairs out = sortOnDevice(device, in, 64);
      REQUIRE((out.keys == expected.keys && out.values == expected.values));
    }
  }
}

TEST_CASE("radixSort looks at the lowest bits alone and carries the others along") {
  for (const Device& device : devicesAndThreads())
    for (const int bits : {1, 7, 8, 9, 30, 60, 63}) {
      const Pairs in = randomPairs(20011, ~uint64_t{0});
      const Pairs out = sortOnDevice(device, in, bits), expected = sortOnHost(in, bits);
      CAPTURE(device.name, device.threads, bits);
      REQUIRE(out.keys == expected.keys);
      REQUIRE(out.values == expected.values);
    }
}

TEST_CASE("radixSort leaves what lies beyond n alone") {
  for (const Device& device : test::devices()) {
    Pairs in = randomPairs(1000, ~uint64_t{0});
    Buffer<uint64_t> keys(device, in.keys), keyScratch(device, 600);
    Buffer<uint32_t> values(device, in.values), valueScratch(device, 600);
    radixSort(device, "sort", 600, 64, keys, values, keyScratch, valueScratch);
    in.keys.resize(600);
    in.values.resize(600);
    REQUIRE(keys.toHost(600) == sortOnHost(in, 64).keys);
  }
}

TEST_CASE("radixSort refuses buffers that are too short and numbers of bits that keys do not have") {
  for (const Device& device : test::devices()) {
    Buffer<uint64_t> keys(device, 10), keyScratch(device, 9);
    Buffer<uint32_t> values(device, 10), valueScratch(device, 10);
    REQUIRE_THROWS_AS(radixSort(device, "sort", 10, 64, keys, values, keyScratch, valueScratch), DeviceError);
    for (const int bits : {0, 65})
      REQUIRE_THROWS_AS(radixSort(device, "sort", 9, bits, keys, values, keyScratch, valueScratch), DeviceError);
  }
}

/// A scan of numbers of which both words of eight bytes are full.
template <class T>
void checkScan(const Device& device, uint32_t n) {
  std::mt19937_64 random(n);
  std::vector<T> in(n), expected(n);
  for (T& value : in) value = static_cast<T>(random());
  std::exclusive_scan(in.begin(), in.end(), expected.begin(), T{0});
  const T sum = std::accumulate(in.begin(), in.end(), T{0});
  Buffer<T> from(device, in), to(device, n), total(device, 1);
  total.fill(0xff);
  exclusiveScan(device, "scan", n, from.data(), to.data(), total.data());
  REQUIRE(to.toHost() == expected);
  REQUIRE(total.read(0) == sum);
  exclusiveScan(device, "scan", n, from.data(), from.data(), total.data());
  REQUIRE(from.toHost() == expected);
  REQUIRE(total.read(0) == sum);
  exclusiveScan(device, "scan", n, to.data(), to.data(), static_cast<T*>(nullptr));
}

TEST_CASE("exclusiveScan sums what comes before, in place as well, and gives the total") {
  for (const Device& device : devicesAndThreads())
    for (const uint32_t n : sizes) {
      CAPTURE(device.name, device.threads, n);
      checkScan<uint32_t>(device, n);
      checkScan<uint64_t>(device, n);
    }
}

TEST_CASE("compact gives the flagged indices in ascending order and their number") {
  for (const Device& device : devicesAndThreads())
    for (const uint32_t n : sizes)
      for (const uint32_t oneIn : {1u, 2u, 1000u, ~0u}) {
        std::mt19937 random(n);
        std::vector<uint32_t> flags(n), expected;
        for (uint32_t i = 0; i < n; ++i)
          if ((flags[i] = oneIn != ~0u && random() % oneIn == 0 ? random() | 1 : 0)) expected.push_back(i);
        Buffer<uint32_t> on(device, flags), out(device, n), count(device, 1);
        count.fill(0xff);
        compact(device, "compact", n, on.data(), out.data(), count.data());
        CAPTURE(device.name, device.threads, n, oneIn);
        REQUIRE(count.read(0) == expected.size());
        REQUIRE(out.toHost(expected.size()) == expected);
      }
}
