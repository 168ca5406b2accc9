// k-means++ (Arthur and Vassilvitskii 2007): each next representative is a triangle drawn with a chance in proportion
// to its distance from the nearest representative so far. The paper tried it and found it too slow: it reads all
// triangles for each representative. Distances enter the sums as whole numbers, so that a draw does not depend on their
// order.
#pragma once

#include "builder/methods/kmeans/segment.h"

namespace copse::kmeans {

/// A distance as a share of the segment's largest, in 2^-32.
HD inline uint64_t shareOf(float distance, float largest) {
  return largest > 0
             ? static_cast<uint64_t>(static_cast<double>(distance) / static_cast<double>(largest) * 4294967296.0)
             : 0;
}

/// Representative c's own draw from a segment: a number below `total`.
HD inline uint64_t drawBelow(const Settings& s, uint32_t c, uint32_t first, uint32_t count, uint64_t total) {
  Draws draws(s.seed + c, first, count);
  const uint64_t high = draws.below(0xffffffffu), low = draws.below(0xffffffffu);
  return (high << 32 | low) % total;
}

HD inline float distanceTo(Metric metric, const UnitBox& box, const UnitBox& representative) {
  BoxesOf<float> b;
  for (int d = 0; d < 3; ++d) {
    b.lo[d] = box.lo[d];
    b.hi[d] = box.hi[d];
  }
  return nearest(metric, b, &representative, 1).distance;
}

/// Both representatives of a small segment, k = 2: by one lane.
template <class Lanes, class Work>
HD inline void drawTwoPlusPlus(Lanes& lanes, const Settings& s, const UnitBox* boxes, uint32_t first, uint32_t count,
                               Work& w) {
  if (lanes.lane() == 0) {
    w.reps[0] = boxes[Draws(s.seed, first, count).below(count)];
    const auto distance = [&](uint32_t i) { return distanceTo(s.metric, boxes[i], w.reps[0]); };
    float largest = 0;
    for (uint32_t i = 0; i < count; ++i) largest = maxOf(distance(i), largest);
    uint64_t total = 0;
    for (uint32_t i = 0; i < count; ++i) total += shareOf(distance(i), largest);
    uint32_t at = 0;
    uint64_t rest = drawBelow(s, 1, first, count, total ? total : count);
    if (total == 0)
      at = static_cast<uint32_t>(rest);
    else
      for (; rest >= shareOf(distance(at), largest); ++at) rest -= shareOf(distance(at), largest);
    w.reps[1] = boxes[at];
  }
  lanes.sync();
}

}  // namespace copse::kmeans
