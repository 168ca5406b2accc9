// Kernels with a planted race beside the same kernels without it. Built with ThreadSanitizer alone, which must report
// the first kind and stay silent on the second: `planted_races NAME`, one of those in main.
#include <cstdio>
#include <cstring>

#include "builder/parallel/atomics.h"
#include "builder/parallel/buffer.h"
#include "builder/parallel/launch.h"
#include "builder/parallel/launch_warps.h"

using namespace copse;

/// Lanes hand a value to their neighbour through shared memory.
struct NeighbourWithoutSync {
  uint32_t* out;
  HD void operator()(Warp& warp, uint32_t index) const {
    uint32_t* shared = static_cast<uint32_t*>(warp.shared());
    shared[warp.lane()] = index + warp.lane();
    out[index * Warp::size + warp.lane()] = shared[(warp.lane() + 1) % Warp::size];
  }
};
struct NeighbourWithSync {
  uint32_t* out;
  HD void operator()(Warp& warp, uint32_t index) const {
    uint32_t* shared = static_cast<uint32_t*>(warp.shared());
    shared[warp.lane()] = index + warp.lane();
    warp.sync();
    out[index * Warp::size + warp.lane()] = shared[(warp.lane() + 1) % Warp::size];
  }
};

/// A ballot gathers votes and orders no memory, on a GPU as here.
struct NeighbourWithBallot {
  uint32_t* out;
  HD void operator()(Warp& warp, uint32_t index) const {
    uint32_t* shared = static_cast<uint32_t*>(warp.shared());
    shared[warp.lane()] = index + warp.lane();
    if (warp.any(shared[warp.lane()] == ~0u)) return;
    out[index * Warp::size + warp.lane()] = shared[(warp.lane() + 1) % Warp::size];
  }
};

/// Shared memory that is written again before all lanes have read it.
struct ReuseWithoutSync {
  uint32_t* out;
  HD void operator()(Warp& warp, uint32_t index) const {
    uint32_t* shared = static_cast<uint32_t*>(warp.shared());
    uint32_t sum = 0;
    for (uint32_t step = 0; step < 4; ++step) {
      shared[warp.lane()] = step + warp.lane();
      warp.sync();
      sum += shared[(warp.lane() + 1) % Warp::size];
    }
    out[index * Warp::size + warp.lane()] = sum;
  }
};
struct ReuseWithSync {
  uint32_t* out;
  HD void operator()(Warp& warp, uint32_t index) const {
    uint32_t* shared = static_cast<uint32_t*>(warp.shared());
    uint32_t sum = 0;
    for (uint32_t step = 0; step < 4; ++step) {
      shared[warp.lane()] = step + warp.lane();
      warp.sync();
      sum += shared[(warp.lane() + 1) % Warp::size];
      warp.sync();
    }
    out[index * Warp::size + warp.lane()] = sum;
  }
};

/// A walk from the leaves of a complete binary tree to its root: the second thread that comes to a node sums its
/// children.
template <bool ordered>
struct WalkUp {
  uint32_t* sums;  // Node i's children are 2i + 1 and 2i + 2; leaves from leaves - 1 on.
  uint32_t* arrivals;
  uint32_t leaves;
  HD void operator()(uint32_t leaf) const {
    uint32_t node = leaves - 1 + leaf;
    sums[node] = leaf;
    while (node > 0) {
      node = (node - 1) / 2;
      const uint32_t before = ordered ? atomicAddAcqRel(&arrivals[node], 1u) : atomicAddRelaxed(&arrivals[node], 1u);
      if (before == 0) return;
      sums[node] = sums[2 * node + 1] + sums[2 * node + 2];
    }
  }
};

template <class Kernel>
bool runWarps(const Device& device) {
  Buffer<uint32_t> out(device, 64 * Warp::size);
  launchWarps(device, "planted", 64, Kernel{out.data()}, Warp::size * sizeof(uint32_t));
  return true;
}

template <bool ordered>
bool runWalk(const Device& device) {
  constexpr uint32_t leaves = 1 << 14;
  Buffer<uint32_t> sums(device, 2 * leaves), arrivals(device, leaves);
  arrivals.fill(0);
  launch(device, "walk up", leaves, WalkUp<ordered>{sums.data(), arrivals.data(), leaves}, 1);
  return sums.read(0) == leaves / 2 * (leaves - 1);
}

int main(int argc, char** argv) {
  const Device device = openDevice("cpu", 4);
  struct Row {
    const char* name;
    bool (*run)(const Device&);
  };
  const Row rows[] = {{"missing-sync", runWarps<NeighbourWithoutSync>},
                      {"ballot-for-sync", runWarps<NeighbourWithBallot>},
                      {"missing-second-sync", runWarps<ReuseWithoutSync>},
                      {"relaxed-walk", runWalk<false>},
                      {"sync", runWarps<NeighbourWithSync>},
                      {"second-sync", runWarps<ReuseWithSync>},
                      {"ordered-walk", runWalk<true>}};
  for (const Row& row : rows)
    if (argc == 2 && std::strcmp(argv[1], row.name) == 0) return row.run(device) ? 0 : 1;
  std::fprintf(stderr, "usage: planted_races NAME\n");
  return 2;
}
