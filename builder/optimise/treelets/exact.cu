// Treelet restructuring: a tree's treelets of seven leaves each rebuilt at minimum cost, in three rounds.
// Karras and Aila: Fast Parallel Construction of High-Quality Bounding Volume Hierarchies (HPG 2013). O(n).
#include "builder/optimise/treelets/exact.h"

#include <algorithm>

#include "builder/optimise/optimiser.h"
#include "builder/optimise/treelets/rounds.h"

namespace copse {

std::array<treelets::LaneSchedule, 32> treelets::laneSchedules() {
  std::array<LaneSchedule, 32> lanes{};
  const auto give = [&](uint32_t leaves, uint32_t turn, uint32_t lanesEach) {
    uint32_t lane = 0;
    for (uint64_t s = 0; s < SubsetCosts::subsets; ++s) {
      if (popCount(static_cast<uint32_t>(s)) != leaves) continue;
      for (uint32_t k = 0; k < lanesEach; ++k, ++lane) lanes[lane % 32].bytes |= s << (8 * (turn + lane / 32));
    }
  };
  give(2, 0, 1);
  give(3, 1, 1);
  give(4, 3, 1);
  give(5, 5, 1);
  give(6, 6, 4);
  return lanes;
}

namespace {

constexpr PhaseName storeSchedules{"store schedules", &groups::treelets};

/// The table travels with the launch, where a copy from the host would wait for the device.
struct StoreSchedules {
  treelets::LaneSchedule lanes[32];
  treelets::LaneSchedule* to;

  HD void operator()(uint32_t lane) const { to[lane] = lanes[lane]; }
};

void run(const Device& device, OpenTree& tree, const Primitives&, const Parameters& parameters) {
  const auto size = static_cast<uint32_t>(parameters.integer("trbvh.treelet"));
  const Buffer<treelets::LaneSchedule> schedules(device, 32);
  StoreSchedules store{{}, schedules.data()};
  std::ranges::copy(treelets::laneSchedules(), store.lanes);
  launch(device, storeSchedules, 32, store);
  treelets::restructure(device, tree, leafRuleOf(parameters), treelets::ExactTreelets{size, schedules.data()},
                        static_cast<int>(parameters.integer("trbvh.rounds")), size);
}

}  // namespace

namespace optimisers {

Optimiser treeletsExact() {
  return {.name = "treelets-exact",
          .source = "Karras and Aila 2013",
          .meaning = "treelets of seven leaves rebuilt at minimum cost",
          .run = run,
          .binaryOnly = true,
          .parameters = {{.name = "trbvh.rounds",
                          .standard = 3,
                          .min = 0,
                          .max = 25,
                          .meaning = "passes over the tree; each doubles the triangles below a treelet"},
                         {.name = "trbvh.treelet", .standard = 7, .min = 3, .max = 7, .meaning = "leaves per treelet"}},
          .phases = {storeSchedules}};
}

}  // namespace optimisers

}  // namespace copse
