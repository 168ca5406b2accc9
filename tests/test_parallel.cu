// builder/parallel: launches, warps, buffers, atomics, sort, scan, compaction, timelines.
#include <catch2/catch.hpp>

#include "builder/parallel/buffer.h"
#include "builder/parallel/launch.h"
#include "tests/support/devices.h"

using namespace copse;

namespace {
struct Square {
  uint32_t* out;
  HD void operator()(uint32_t i) const { out[i] = i * i; }
};
}  // namespace

TEST_CASE("launch runs every index once") {
  for (const Device& device : test::devices()) {
    Buffer<uint32_t> out(device, 10000);
    launch(device, "square", 10000, Square{out.data()});
    const auto host = out.toHost();
    for (uint32_t i = 0; i < 10000; ++i) REQUIRE(host[i] == i * i);
  }
}
