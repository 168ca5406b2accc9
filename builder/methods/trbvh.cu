// Treelet restructuring: the tree of lbvh, its treelets of seven leaves each rebuilt at their best, in three rounds.
// Karras and Aila: Fast Parallel Construction of High-Quality Bounding Volume Hierarchies (HPG 2013). O(n).
#include "builder/methods/methods.h"
#include "builder/methods/treelets/exact.h"
#include "builder/methods/treelets/rounds.h"

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

Bvh buildTrbvh(const Device& device, const BuildInput& input, const Parameters& parameters) {
  Bvh bvh = buildLbvh(device, input, parameters);
  const auto size = static_cast<uint32_t>(parameters.integer("trbvh.treelet"));
  const auto schedules = treelets::laneSchedules();
  const Buffer<treelets::LaneSchedule> onDevice(device, schedules);
  treelets::restructure(device, bvh, treelets::costsOf(parameters), treelets::ExactTreelets{size, onDevice.data()},
                        static_cast<int>(parameters.integer("trbvh.rounds")), size);
  return bvh;
}

}  // namespace copse
