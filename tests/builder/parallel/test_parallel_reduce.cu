// builder/parallel: reduce gives the same bits on any number of threads and on both devices.
#include <random>

#include "builder/parallel/memory_traffic.h"
#include "builder/parallel/reduce.h"
#include "tests/support/catch.h"
#include "tests/support/devices.h"

using namespace copse;

namespace {

struct Load {
  const float* values;
  HD float operator()(uint32_t i) const { return values[i]; }
};
struct AddFloats {
  HD float operator()(const float& a, const float& b) const { return a + b; }
};

struct Interval {
  float low[3], high[3];
  uint32_t count;
};
struct ToInterval {
  const float* values;
  HD Interval operator()(uint32_t i) const {
    const float v = values[i];
    return {{v, -v, 2 * v}, {v, -v, 2 * v}, 1};
  }
};
struct Join {
  HD Interval operator()(const Interval& a, const Interval& b) const {
    Interval joined{};
    for (int axis = 0; axis < 3; ++axis) {
      joined.low[axis] = b.low[axis] < a.low[axis] ? b.low[axis] : a.low[axis];
      joined.high[axis] = b.high[axis] > a.high[axis] ? b.high[axis] : a.high[axis];
    }
    joined.count = a.count + b.count;
    return joined;
  }
};

std::vector<float> randomFloats(uint32_t n) {
  std::mt19937 random(n);
  std::vector<float> values(n);
  for (float& value : values) value = static_cast<float>(random()) * 0x1p-30f - 1.5f;
  return values;
}

const std::vector<uint32_t> sizes = {0, 1, 2, 255, 257, 4095, 4096, 4097, 100003, (1u << 20) + 7, (1u << 24) + 5};

}  // namespace

TEST_CASE("reduce finds the bounds and the number of values at every size") {
  for (const Device& device : test::devices())
    for (const uint32_t n : sizes) {
      const auto values = randomFloats(n);
      const Buffer<float> in(device, values);
      const Interval empty{{1e9f, 1e9f, 1e9f}, {-1e9f, -1e9f, -1e9f}, 0};
      const Interval got = reduce(device, "bounds", n, empty, ToInterval{in.data()}, Join{});
      float low = 1e9f, high = -1e9f;
      for (const float v : values) low = std::min(low, v), high = std::max(high, v);
      CAPTURE(n);
      REQUIRE(got.count == n);
      REQUIRE(got.low[0] == low);
      REQUIRE(got.high[0] == high);
      REQUIRE(got.low[1] == (n ? -high : low));
      REQUIRE(got.high[2] == (n ? 2 * high : high));
    }
}

TEST_CASE("a float sum has the same bits on any number of threads and on every device") {
  for (const uint32_t n : sizes) {
    const auto values = randomFloats(n);
    const float expected = reduce(openDevice("cpu", 1), "sum", n, 0.0f, Load{values.data()}, AddFloats{});
    double exact = 0;
    for (const float v : values) exact += v;
    REQUIRE(expected == Approx(exact).margin(1e-2));
    for (const Device& device : test::devices()) {
      const Buffer<float> in(device, values);
      for (const int threads : {1, 2, 3, 7}) {
        Device some = device;
        some.threads = threads;
        CAPTURE(n, device.name, threads);
        REQUIRE(reduce(some, "sum", n, 0.0f, Load{in.data()}, AddFloats{}) == expected);
      }
    }
  }
}

TEST_CASE("waits for the device and its allocations are counted") {
  for (const Device& device : copse::test::devices()) {
    const copse::MemoryTraffic before = copse::memoryTraffic();
    Buffer<uint32_t> numbers(device, 100);
    numbers.fill(0);
    REQUIRE(numbers.read(5) == 0);
    copse::synchronise(device);
    const copse::MemoryTraffic after = copse::memoryTraffic();
    CHECK(after.allocations - before.allocations == 1);
    CHECK(after.waits - before.waits == 2);
  }
}
