// builder/parallel: exceptions in a warp's kernel on fibers. Not a .cu file, since device code cannot throw.
#include <atomic>
#include <stdexcept>
#include <string>

#include "builder/parallel/device.h"
#include "builder/parallel/warp.h"
#include "tests/support/catch.h"

using namespace copse;

namespace {

struct Counted {
  std::atomic<int>& alive;
  explicit Counted(std::atomic<int>& alive) : alive(alive) { ++alive; }
  ~Counted() { --alive; }
};

struct Throws {
  uint32_t lane, atOrAbove;
  std::atomic<int>& alive;
  void operator()(Warp& warp, uint32_t index) const {
    const Counted counted(alive);
    warp.sync();
    if (index >= atOrAbove && warp.lane() == lane) throw std::runtime_error("warp " + std::to_string(index));
    warp.sync();
  }
};

void runThrows(const void* kernel, Warp& warp, uint32_t index) { (*static_cast<const Throws*>(kernel))(warp, index); }

}  // namespace

TEST_CASE("an exception in a kernel leaves launchWarps, the lowest warp's first, and unwinds every lane") {
  for (const int threads : {1, 2, 3})
    for (const uint32_t lane : {0u, 11u, 31u}) {
      std::atomic<int> alive = 0;
      std::string message;
      try {
        const Throws kernel{lane, 20, alive};
        detail::runWarpsOnFibers(openDevice("cpu", threads), "throws", 50, 0, &kernel, &runThrows);
      } catch (const std::runtime_error& error) {
        message = error.what();
      }
      REQUIRE(message == "warp 20");
      REQUIRE(alive == 0);
    }
}
