// builder/parallel: what spares the host waits and allocations does what the plain way does.
#include <vector>

#include "builder/parallel/arena.h"
#include "builder/parallel/launch.h"
#include "builder/parallel/memory_traffic.h"
#include "builder/parallel/pending_read.h"
#include "builder/parallel/reduce.h"
#include "tests/support/catch.h"
#include "tests/support/devices.h"

using namespace copse;

namespace {

/// Multiplies by a number that only the device knows.
struct Scale {
  const uint32_t* factor;
  uint32_t* to;
  uint32_t own = 0;

  HD void prepare() { own = *factor; }
  HD void operator()(uint32_t i) const { to[i] = i * own; }
};

struct Set {
  uint32_t* to;
  uint32_t value;
  HD void operator()(uint32_t i) const { to[i] = value; }
};

struct Sum {
  HD uint32_t operator()(const uint32_t& a, const uint32_t& b) const { return a + b; }
};
struct Same {
  HD uint32_t operator()(uint32_t i) const { return i; }
};

MemoryTraffic since(const MemoryTraffic& before) {
  const MemoryTraffic now = memoryTraffic();
  return {now.waits - before.waits, now.allocations - before.allocations};
}

}  // namespace

TEST_CASE("a kernel prepares itself from the device's memory, and nobody waits") {
  for (const Device& device : test::devices()) {
    Buffer<uint32_t> factor(device, 1), products(device, 5000);
    const MemoryTraffic before = memoryTraffic();
    launch(device, "set", 1, Set{factor.data(), 7});
    launch(device, "scale", 5000, Scale{factor.data(), products.data()});
    CHECK(since(before).waits == 0);
    const auto got = products.toHost();
    for (uint32_t i = 0; i < 5000; ++i) REQUIRE(got[i] == 7 * i);
  }
}

TEST_CASE("reduceInto leaves its result on the device, and nobody waits") {
  for (const Device& device : test::devices())
    for (const uint32_t n : {1u, 4096u, 4097u, 20000u, (1u << 24) + 1}) {
      Buffer<uint32_t> result(device, 2);
      result.fill(0);
      const MemoryTraffic before = memoryTraffic();
      reduceInto(device, "sum", n, 0u, Same{}, Sum{}, result.data());
      CHECK(since(before).waits == 0);
      CAPTURE(n);
      CHECK(result.toHost() == std::vector<uint32_t>{static_cast<uint32_t>(uint64_t{n} * (n - 1) / 2), 0});
    }
}

TEST_CASE("no more indices are launched than the host knows to be enough") {
  for (const Device& device : test::devices()) {
    Buffer<uint32_t> count(device, 1);
    launch(device, "set", 1, Set{count.data(), 3});
    CHECK(indicesFor(device, 10, count.data()) == (device.isCuda() ? 10 : 3));
    CHECK(indicesFor(device, 2, count.data()) == 2);
  }
}

TEST_CASE("an arena's arrays keep to themselves and come of few allocations") {
  for (const Device& device : test::devices()) {
    const MemoryTraffic before = memoryTraffic();
    Arena arena(device, 1000);
    for (int round = 0; round < 3; ++round) {
      if (round > 0) arena.clear(300 * Arena::bytesOf<uint32_t>(101));
      std::vector<uint32_t*> arrays;
      for (uint32_t k = 0; k < 300; ++k) {
        arrays.push_back(arena.take<uint32_t>(101));
        REQUIRE(reinterpret_cast<std::uintptr_t>(arrays.back()) % 256 == 0);
        launch(device, "set", 101, Set{arrays.back(), k});
      }
      for (uint32_t k = 0; k < 300; ++k) {
        std::vector<uint32_t> got(101);
        copyToHost(device, got.data(), arrays[k], 101 * sizeof(uint32_t));
        REQUIRE(got == std::vector<uint32_t>(101, k));
      }
      REQUIRE(arena.take<uint32_t>(0) != nullptr);
    }
    // Three blocks, a larger one, and one per round for what does not fit in there.
    CHECK(since(before).allocations <= 6);
  }
}

TEST_CASE("an arena that was cleared begins anew, and gives as much as it was told of out of one block") {
  for (const Device& device : test::devices()) {
    Arena arena(device, 1000);
    arena.take<char>(1);  // From a block that is too small for what comes.
    const std::size_t each = Arena::bytesOf<char>(40000);
    const char* first = nullptr;
    for (int round = 0; round < 2; ++round) {
      arena.clear(10 * each);
      if (round == 0) first = arena.take<char>(40000);
      for (std::size_t k = round == 0; k < 10; ++k) REQUIRE(arena.take<char>(40000) == first + k * each);
    }
  }
}

TEST_CASE("a pending read has what was there when it started, whatever is launched after it") {
  for (const Device& device : test::devices()) {
    Buffer<uint32_t> numbers(device, 2);
    PendingRead one(device), other(device);
    for (uint32_t k = 0; k < 20; ++k) {
      launch(device, "set", 2, Set{numbers.data(), k});
      one.start(numbers.data());
      launch(device, "set", 2, Set{numbers.data(), k + 100});
      other.start(numbers.data() + 1);
      launch(device, "set", 2, Set{numbers.data(), ~0u});
      const MemoryTraffic before = memoryTraffic();
      REQUIRE(one.wait<uint32_t>() == k);
      REQUIRE(other.wait<uint32_t>() == k + 100);
      CHECK(since(before).waits == 2);
    }
    PendingRead(device).start(numbers.data());  // Nobody asks for it.
  }
}
