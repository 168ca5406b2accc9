// Kernels with a planted race beside the same kernels without it: `planted_races NAME [DEVICE]`, one of those in main.
// Ends with 1 where a result is wrong. ThreadSanitizer must report the first kind and stay silent on the second; on the
// emulated device the first kind must give wrong results, but for the ballot, which keeps threads in step there.
#include <cstdio>
#include <cstring>
#include <vector>

#include "builder/base/error.h"
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

/// A lane that leaves before the others of its warp meet.
struct LeaveEarly {
  uint32_t* out;
  HD void operator()(Warp& warp, uint32_t index) const {
    if (warp.lane() == 7) return;
    warp.sync();
    out[index * Warp::size + warp.lane()] = index + (warp.lane() + 1) % Warp::size;
  }
};

/// A word behind the last.
struct WriteBehind {
  uint32_t* out;
  HD void operator()(Warp& warp, uint32_t index) const {
    out[index * Warp::size + warp.lane() + (index == 63 ? 1 : 0)] = index + (warp.lane() + 1) % Warp::size;
  }
};

/// A walk from the leaves of a complete binary tree to its root: the second thread that comes to a node sums its
/// children.
template <bool ordered>
struct WalkUp {
  uint32_t* sums;  // Node i's children are 2i + 1 and 2i + 2; leaves from leaves - 1 on.
  uint32_t* arrivals;
  uint32_t leaves;
  HD void operator()(uint32_t index) const {
    // Leaves of neighbouring threads lie far apart, so that a block comes back to words that its cache has had before.
    const uint32_t leaf = index * 40503u % leaves;
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
std::vector<uint32_t> resultsOf(const Device& device) {
  Buffer<uint32_t> out(device, 64 * Warp::size);
  launchWarps(device, "planted", 64, Kernel{out.data()}, Warp::size * sizeof(uint32_t));
  return out.toHost();
}

uint32_t neighbour(uint32_t i) { return (i % Warp::size + 1) % Warp::size; }

template <class Kernel>
bool runNeighbours(const Device& device) {
  const std::vector<uint32_t> results = resultsOf<Kernel>(device);
  for (uint32_t i = 0; i < results.size(); ++i)
    if (results[i] != i / Warp::size + neighbour(i)) return false;
  return true;
}

template <class Kernel>
bool runReuse(const Device& device) {
  const std::vector<uint32_t> results = resultsOf<Kernel>(device);
  for (uint32_t i = 0; i < results.size(); ++i)
    if (results[i] != 0 + 1 + 2 + 3 + 4 * neighbour(i)) return false;
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
  const Device device = openDevice(argc == 3 ? argv[2] : "cpu", 4);
  struct Row {
    const char* name;
    bool (*run)(const Device&);
  };
  const Row rows[] = {{"missing-sync", runNeighbours<NeighbourWithoutSync>},
                      {"ballot-for-sync", runNeighbours<NeighbourWithBallot>},
                      {"missing-second-sync", runReuse<ReuseWithoutSync>},
                      {"relaxed-walk", runWalk<false>},
                      {"leave-early", runNeighbours<LeaveEarly>},
                      {"write-behind", runNeighbours<WriteBehind>},
                      {"sync", runNeighbours<NeighbourWithSync>},
                      {"second-sync", runReuse<ReuseWithSync>},
                      {"ordered-walk", runWalk<true>}};
  for (const Row& row : rows)
    if (argc >= 2 && std::strcmp(argv[1], row.name) == 0) {
      try {
        const bool right = row.run(device);
        std::printf("%s: %s results\n", row.name, right ? "right" : "wrong");
        return right ? 0 : 1;
      } catch (const DeviceError& error) {
        std::fprintf(stderr, "error: %s\n", error.what());
        return 1;
      }
    }
  std::fprintf(stderr, "usage: planted_races NAME [DEVICE]\n");
  return 2;
}
