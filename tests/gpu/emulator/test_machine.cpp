// What the emulated machine must report: kernels written by hand as translate.py would, each with one defect.
#include <cstdint>

#include "tests/gpu/emulator/grid.h"
#include "tests/support/catch.h"

using namespace emulator;

namespace {

Point somewhere = {"kernel", "test_machine.cpp", "a meeting"};
uint64_t word;  ///< What kernels write to.

/// False if the launch of 64 threads ended with a fault.
bool runs(void (*kernel)(Thread&, const uint8_t*), uint32_t threads = 64) {
  const Kernel entry{"kernel", kernel, 0, 0, maxThreads, 0, nullptr, nullptr};
  return run({&entry, {2, 1, 1}, {threads, 1, 1}, 0, false, {}});
}

}  // namespace

TEST_CASE("emulated lanes exchange values, vote and meet") {
  static uint32_t values[32], votes;
  REQUIRE(runs([](Thread& t, const uint8_t*) {
    bool within;
    const uint32_t value = shuffle(Shuffle::down, t.laneid, 1, 0x1f, ~0u, within, somewhere);
    if (t.tid[0] < 32) values[t.laneid] = within ? value : 99;
    votes = ballot(t.laneid % 2 == 1, ~0u, somewhere);
    warpBarrier(~0u, somewhere);
    blockBarrier(false, somewhere);
  }));
  CHECK(values[0] == 1);
  CHECK(values[30] == 31);
  CHECK(values[31] == 99);
  CHECK(votes == 0xaaaaaaaau);
}

TEST_CASE("a partial warp at the block's end meets without its missing lanes") {
  REQUIRE(runs([](Thread&, const uint8_t*) { word = ballot(true, ~0u, somewhere); }, 40));
  CHECK((word == 0xffu || word == ~0u));
}

TEST_CASE("the emulated machine ends lanes that wait forever") {
  CHECK_FALSE(runs([](Thread& t, const uint8_t*) {  // Half of them wait for the other half.
    if (t.laneid < 16)
      warpBarrier(~0u, somewhere);
    else
      blockBarrier(false, somewhere);
  }));
  CHECK_FALSE(runs([](Thread& t, const uint8_t*) {
    if (t.laneid == 3) return;
    warpBarrier(~0u, somewhere);
  }));
}

TEST_CASE("the emulated machine ends an infinite spin") {
  CHECK_FALSE(runs(
      [](Thread&, const uint8_t*) {
        while (word != 1234567) yield();
      },
      1));
}

TEST_CASE("the emulated machine ends a shuffle from outside its mask") {
  CHECK_FALSE(runs([](Thread& t, const uint8_t*) {
    bool within;
    if (t.laneid < 16) shuffle(Shuffle::idx, 0, 20, 0x1f, 0xffffu, within, somewhere);
  }));
}

TEST_CASE("the emulated machine ends accesses to memory that is not a kernel's") {
  static uint64_t block;
  block = reinterpret_cast<uint64_t>(allocate(512, false));
  CHECK(runs([](Thread&, const uint8_t*) { store<uint64_t>(block + 504, 1); }));
  CHECK_FALSE(runs([](Thread&, const uint8_t*) { store<uint64_t>(block + 512, 1); }));
  CHECK(describe(block + 513) == "513 bytes behind the begin of a block of 512");
  CHECK_FALSE(runs([](Thread&, const uint8_t*) { store<uint32_t>(aligned<4>(block + 2), 1); }));
  CHECK_FALSE(runs([](Thread& t, const uint8_t*) { store<uint32_t>(t.shared + 128, 1); }));
  release(reinterpret_cast<void*>(block));
  CHECK_FALSE(runs([](Thread&, const uint8_t*) { word = load<uint64_t>(block); }));
  CHECK(runs([](Thread&, const uint8_t*) {}));
}
