// A fiber and what it waits for, a block of them, and the counters: shared by the files of the machine.
#pragma once

#include <array>
#include <boost/context/detail/fcontext.hpp>
#include <cstdint>
#include <map>
#include <string>
#include <unordered_map>
#include <utility>
#include <vector>

#include "grid.h"

namespace emulator {

enum class Wait : uint8_t { nothing, yielded, shuffle, vote, warpBarrier, blockBarrier, left };

struct Block;

struct Fiber {
  boost::context::detail::fcontext_t context;
  uint8_t* stack;
  Block* block;
  Fiber** warp;  ///< The threads of its warp, `lanesOfWarp` of them.
  uint32_t lanesOfWarp;
  Thread thread;
  Wait wait;
  // Arguments of the barrier, vote or shuffle that the thread is waiting in, and its result.
  Point* point;
  Shuffle mode;
  uint32_t members, value, source, clamp;
  bool vote, within;
  uint32_t result;

  bool ready() const { return wait == Wait::nothing || wait == Wait::yielded; }
};

struct Block {
  std::vector<Fiber*> threads;
  uint8_t* arena;  ///< Shared memory; the block's part ends where the arena ends.
  uint32_t alive, atBarrier = 0;
  std::unordered_map<uint64_t, std::array<uint32_t, 8>> l1;  ///< Per sector of 32 bytes.
};

struct KernelCount {
  uint64_t launches = 0, threads = 0, staleReads = 0, meetingsAtTwoPoints = 0;
  double seconds = 0;
};

/// What lives until the last destructor of the program.
struct State {
  std::unordered_map<std::string, Kernel> kernels;
  std::vector<std::pair<Point*, size_t>> points;
  std::map<std::string, KernelCount> counts;
  std::map<std::string, uint64_t> calls;
  std::vector<Fiber*> freeFibers;
  std::vector<uint8_t*> freeArenas;
  const Launch* launch = nullptr;
  KernelCount* counting = nullptr;
  boost::context::detail::fcontext_t scheduler = nullptr;
  Fiber* running = nullptr;
  bool failed = false;
};

State& state();
/// Leaves the running fiber; the scheduler comes back to it when it is ready.
void toScheduler();
/// Releases a block's barrier when all live threads have arrived.
void openBarrier(Block& block);

/// A lane of a thread's warp, or null where the block ends before it.
inline Fiber* lane(const Fiber& of, uint32_t which) { return which < of.lanesOfWarp ? of.warp[which] : nullptr; }

}  // namespace emulator
