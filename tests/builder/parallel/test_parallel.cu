// builder/parallel: devices, buffers, launches, atomics and timelines.
#include <algorithm>
#include <chrono>
#include <limits>
#include <numeric>
#include <thread>

#include "builder/base/error.h"
#include "builder/parallel/atomics.h"
#include "builder/parallel/bits.h"
#include "builder/parallel/buffer.h"
#include "builder/parallel/launch.h"
#include "tests/support/catch.h"
#include "tests/support/devices.h"

using namespace copse;

namespace {

struct CountCalls {
  uint32_t* calls;
  HD void operator()(uint32_t i) const { ++calls[i]; }
};

template <class T>
struct Accumulate {
  const T* in;
  T* sum;
  T* least;
  T* most;
  HD void operator()(uint32_t i) const {
    atomicAddRelaxed(sum, in[i]);
    atomicMinRelaxed(least, in[i]);
    atomicMaxRelaxed(most, in[i]);
  }
};

/// Each index takes a ticket in two ways; every ticket must be given out once.
struct Tickets {
  uint32_t* counters;
  uint32_t* taken;  // Two rows of n.
  uint32_t n;
  HD void operator()(uint32_t) const {
    atomicAddRelaxed(&taken[atomicAddRelaxed(&counters[0], 1u)], 1u);
    atomicAddRelaxed(&taken[n + atomicAddAcqRel(&counters[1], 1u)], 1u);
  }
};

/// Passes a chain of values on: what each index leaves is taken by exactly one other.
struct Swap {
  uint32_t* slot;
  uint32_t* got;
  HD void operator()(uint32_t i) const {
    const uint32_t before = atomicExchangeRelaxed(slot, i + 1);
    got[before] = i + 1;
  }
};

/// The first to come writes and the last to come reads: both threads' writes are there.
struct Meet {
  uint32_t* written;
  uint32_t* flags;
  uint32_t* sums;
  HD void operator()(uint32_t i) const {
    const uint32_t pair = i / 2;
    written[i] = i + 7;
    if (atomicAddAcqRel(&flags[pair], 1u) == 1) sums[pair] = written[2 * pair] + written[2 * pair + 1];
  }
};

struct Flags {
  uint32_t* out;
  HD void operator()(uint32_t i) const {
    atomicStoreRelaxed(&out[i], i);
    atomicStoreRelaxed(&out[i], atomicLoadRelaxed(&out[i]) + 1);
  }
};

struct Bits {
  uint32_t* out;  // Four per index.
  HD void operator()(uint32_t i) const {
    const uint32_t bits = i == 0 ? 0 : 1u << (i - 1) | 1u << (i / 2);
    out[4 * i] = popCount(bits);
    out[4 * i + 1] = lowestBit(bits);
    out[4 * i + 2] = leadingZeros(bits);
    out[4 * i + 3] = leadingZeros(uint64_t{bits} << 7);
  }
};

template <class T>
void checkAccumulate(const Device& device) {
  std::vector<T> in(50000);
  for (uint32_t i = 0; i < in.size(); ++i) in[i] = static_cast<T>(i * 7919 % 50000) - static_cast<T>(100);
  Buffer<T> values(device, in), results(device, std::vector<T>{T{0}, in[0], in[0]});
  launch(device, "accumulate", 50000,
         Accumulate<T>{values.data(), results.data(), results.data() + 1, results.data() + 2}, 64);
  const auto host = results.toHost();
  REQUIRE(host[1] == *std::min_element(in.begin(), in.end()));
  REQUIRE(host[2] == *std::max_element(in.begin(), in.end()));
  const double sum = std::accumulate(in.begin(), in.end(), 0.0);
  if (std::is_integral_v<T>)
    REQUIRE(host[0] == std::accumulate(in.begin(), in.end(), T{0}));
  else
    REQUIRE(static_cast<double>(host[0]) == Approx(sum));
}

void sleepMs(int ms) { std::this_thread::sleep_for(std::chrono::milliseconds(ms)); }

}  // namespace

TEST_CASE("launch runs every index once") {
  for (const Device& device : test::devices())
    for (const uint32_t n : {0u, 1u, 2u, 255u, 256u, 257u, 1023u, 1024u, 1025u, (1u << 20) + 3}) {
      Buffer<uint32_t> calls(device, n + 1);
      calls.fill(0);
      launch(device, "count", n, CountCalls{calls.data()});
      auto expected = std::vector<uint32_t>(n, 1);
      expected.push_back(0);
      REQUIRE(calls.toHost() == expected);
    }
}

TEST_CASE("a device is opened by name and anything else is refused") {
  REQUIRE_FALSE(openDevice("cpu").isCuda());
  REQUIRE(openDevice("cpu", 3).threads == 3);
  REQUIRE(openDevice("cpu").threads >= 1);
  REQUIRE_THROWS_WITH(openDevice("gpu"), "unknown device 'gpu' (expected auto, cuda or cpu)");
  REQUIRE_THROWS_AS(openDevice("cpu", -1), InputError);
  REQUIRE_THROWS_AS(openDevice("auto", 1000000), InputError);
  const auto all = listDevices();
  REQUIRE_FALSE(all.front().isCuda());
  if (all.size() == 1) {
    REQUIRE_THROWS_AS(openDevice("cuda"), DeviceError);
    REQUIRE_FALSE(openDevice("auto").isCuda());
  } else {
    REQUIRE(openDevice("auto").isCuda());
  }
}

TEST_CASE("a buffer carries data to the device and back") {
  for (const Device& device : test::devices()) {
    std::vector<uint64_t> in(1001);
    std::iota(in.begin(), in.end(), uint64_t{1} << 40);
    Buffer<uint64_t> buffer(device, in);
    REQUIRE(reinterpret_cast<std::uintptr_t>(buffer.data()) % 256 == 0);
    REQUIRE(buffer.bytes() == 8008);
    REQUIRE(buffer.toHost() == in);
    REQUIRE(buffer.read(1000) == in[1000]);
    REQUIRE(buffer.toHost(3) == std::vector<uint64_t>(in.begin(), in.begin() + 3));
    Buffer<uint64_t> moved = std::move(buffer);
    REQUIRE(buffer.empty());
    REQUIRE(buffer.data() == nullptr);
    REQUIRE(moved.toHost() == in);
    moved.fill(0xff);
    REQUIRE(moved.read(500) == ~uint64_t{0});
    moved.upload(in);
    REQUIRE(moved.toHost() == in);
    moved = Buffer<uint64_t>(device, 0);
    REQUIRE(moved.toHost().empty());
    REQUIRE(Buffer<uint32_t>().toHost().empty());
  }
}

TEST_CASE("memory that is not there is an error that says how much was wanted") {
  for (const Device& device : test::devices()) {
    REQUIRE_THROWS_AS(Buffer<uint64_t>(device, std::numeric_limits<std::size_t>::max()), DeviceError);
    REQUIRE_THROWS_WITH(Buffer<uint64_t>(device, std::size_t{1} << 61),
                        copse::test::Contains("2305843009213693952 elements of 8 bytes"));
    REQUIRE_THROWS_WITH(Buffer<char>(device, std::size_t{1} << 50), copse::test::Contains("1125899906842624 bytes"));
  }
}

TEST_CASE("atomic sums, minima and maxima are those of a loop") {
  for (const Device& device : test::devices()) {
    checkAccumulate<uint32_t>(device);
    checkAccumulate<int32_t>(device);
    checkAccumulate<uint64_t>(device);
    checkAccumulate<float>(device);
    checkAccumulate<double>(device);
  }
}

TEST_CASE("NaN never replaces a number in an atomic minimum or maximum") {
  for (const Device& device : test::devices()) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const Buffer<float> in(device, std::vector<float>{nan, -2, nan, 5, nan});
    const Buffer<float> out(device, std::vector<float>{0, 1, 1});
    launch(device, "accumulate", 5, Accumulate<float>{in.data(), out.data(), out.data() + 1, out.data() + 2});
    REQUIRE(out.read(1) == -2);
    REQUIRE(out.read(2) == 5);
  }
}

TEST_CASE("atomic additions hand out each ticket once") {
  for (const Device& device : test::devices()) {
    const uint32_t n = 20000;
    Buffer<uint32_t> counters(device, 2), taken(device, 2 * n);
    counters.fill(0);
    taken.fill(0);
    launch(device, "tickets", n, Tickets{counters.data(), taken.data(), n}, 16);
    REQUIRE(taken.toHost() == std::vector<uint32_t>(2 * n, 1));
  }
}

TEST_CASE("atomic exchanges lose and double nothing") {
  for (const Device& device : test::devices()) {
    const uint32_t n = 20000;
    Buffer<uint32_t> slot(device, 1), got(device, n + 1);
    slot.fill(0);
    got.fill(0);
    launch(device, "swap", n, Swap{slot.data(), got.data()}, 16);
    auto chain = got.toHost();
    uint32_t at = 0, links = 0;
    while (chain[at] != 0 && links <= n) at = std::exchange(chain[at], 0), ++links;
    REQUIRE(links == n);
    REQUIRE(at == slot.read(0));
  }
}

TEST_CASE("the second to arrive sees what the first wrote") {
  for (const Device& device : test::devices()) {
    const uint32_t n = 40000;
    Buffer<uint32_t> written(device, n), flags(device, n / 2), sums(device, n / 2);
    flags.fill(0);
    launch(device, "meet", n, Meet{written.data(), flags.data(), sums.data()}, 1);
    const auto host = sums.toHost();
    for (uint32_t i = 0; i < n / 2; ++i) REQUIRE(host[i] == 4 * i + 15);
  }
}

TEST_CASE("atomic stores and loads carry the value") {
  for (const Device& device : test::devices()) {
    Buffer<uint32_t> out(device, 100);
    launch(device, "flags", 100, Flags{out.data()});
    const auto host = out.toHost();
    for (uint32_t i = 0; i < 100; ++i) REQUIRE(host[i] == i + 1);
  }
}

TEST_CASE("bits are counted the same on both devices") {
  for (const Device& device : test::devices()) {
    Buffer<uint32_t> out(device, 33 * 4);
    launch(device, "bits", 33, Bits{out.data()});
    const auto host = out.toHost();
    REQUIRE(std::vector<uint32_t>(host.begin(), host.begin() + 4) == std::vector<uint32_t>{0, 0, 32, 64});
    for (uint32_t i = 1; i < 33; ++i) {
      const uint32_t high = std::max(i - 1, i / 2), low = std::min(i - 1, i / 2);
      REQUIRE(host[4 * i] == (high == low ? 1u : 2u));
      REQUIRE(host[4 * i + 1] == low);
      REQUIRE(host[4 * i + 2] == 31 - high);
      REQUIRE(host[4 * i + 3] == 56 - high);
    }
  }
}

namespace {
constexpr PhaseGroup waits{"waits"};
}

TEST_CASE("a timeline gives each phase its time, in order of first use, and the span with its gaps") {
  for (const Device& plain : test::devices()) {
    Timeline timeline(plain);
    REQUIRE(timeline.spanMs() == 0);
    REQUIRE(timeline.phases().empty());
    const Device device = plain.recording(timeline);
    Buffer<uint32_t> calls(device, 10);
    {
      Phase phase(device, {"outer", &waits});
      launch(device, "inner", 10, CountCalls{calls.data()});
      launch(device, "inner", 10, CountCalls{calls.data()});
      sleepMs(20);
    }
    sleepMs(30);
    launch(device, "alone", 10, CountCalls{calls.data()});
    {
      Phase phase(device, "outer");
      sleepMs(10);
    }
    const auto rows = timeline.phases();
    REQUIRE(rows.size() == 2);
    REQUIRE(rows[0].name == "outer");
    REQUIRE(rows[0].launches == 2);
    REQUIRE(rows[0].group == &waits);
    REQUIRE(rows[1].name == "alone");
    REQUIRE(rows[1].group == nullptr);
    REQUIRE(rows[1].launches == 1);
    // Sleeps last at least as long as they are asked to: on the CPU these bounds hold on any machine.
    if (!device.isCuda()) {
      REQUIRE(rows[0].ms >= 30);
      REQUIRE(timeline.spanMs() >= rows[0].ms + rows[1].ms + 30);
    } else {
      REQUIRE(rows[0].ms > 0);
      REQUIRE(timeline.spanMs() >= rows[0].ms + rows[1].ms);
    }
    REQUIRE(timeline.phases().size() == 2);
    REQUIRE(timeline.phases()[0].ms == rows[0].ms);
  }
}

TEST_CASE("phases that follow each other at once share an event, and one around all takes two") {
  for (const Device& plain : test::devices()) {
    Buffer<uint32_t> calls(plain, 1);
    const auto eventsOf = [&](const auto& work) {
      Timeline timeline(plain);
      work(plain.recording(timeline));
      timeline.phases();
      REQUIRE((timeline.spanMs() > 0 || !plain.isCuda()));
      return timeline.eventsRecorded();
    };
    const auto launches = [&](const Device& device) {
      for (int i = 0; i < 1000; ++i) launch(device, i % 2 ? "odd" : "even", 1, CountCalls{calls.data()});
    };
    const int apart = eventsOf(launches);
    const int within = eventsOf([&](const Device& device) {
      const Phase all(device, "all");
      launches(device);
    });
    const int filled = eventsOf([&](const Device& device) {
      for (int i = 0; i < 100; ++i) {
        calls.fill(0);
        launch(device, "count", 1, CountCalls{calls.data()});
      }
    });
    if (!plain.isCuda()) {
      CHECK(apart + within + filled == 0);
      continue;
    }
    CHECK(apart >= 1001);
    CHECK(apart < 1500);  // The host may be held up between some.
    CHECK(within == 2);
    CHECK(filled == 200);
  }
}

TEST_CASE("a timeline of more phases than are kept at a time loses none") {
  for (const Device& plain : test::devices()) {
    Timeline timeline(plain);
    const Device device = plain.recording(timeline);
    Buffer<uint32_t> calls(device, 1);
    for (int i = 0; i < 5000; ++i) launch(device, i % 2 ? "odd" : "even", 1, CountCalls{calls.data()});
    const auto rows = timeline.phases();
    REQUIRE(rows.size() == 2);
    REQUIRE(rows[0].launches == 2500);
    REQUIRE(rows[1].launches == 2500);
    REQUIRE(rows[0].ms > 0);
  }
}
