// k-means++ over the tasks of a pass: for each representative one pass that measures distances, one that adds them up
// by chunk, and one draw per task. O(n k) per level before the first assignment.
#pragma once

#include "builder/methods/kmeans/passes.h"

namespace copse::kmeans {

/// What the draws of a pass keep: a triangle's distance to its nearest representative, the largest such distance in
/// each task when it had one representative, and the sum of each chunk's shares.
struct PlusPlus : Pass {
  uint32_t c;  ///< The representative that is to be drawn.
  float* distances;
  float* largest;
  uint64_t* chunkSums;
};

struct DrawFirst : PlusPlus {
  HD void operator()(uint32_t index) const {
    const Task& t = tasks[index];
    reps[row(index)] = boxes[t.first + Draws(settings.seed, t.first, t.count).below(t.count)];
    for (uint32_t j = 0; j < settings.k; ++j) sums[row(index) + j] = Sums{};
    lastMove[index] = 0;
    largest[index] = 0;
  }
};

/// Distances to the representative before `c`.
struct MeasureFrom : PlusPlus {
  template <class Lanes>
  HD void operator()(Lanes& lanes, uint32_t index) const {
    const Chunk chunk(*this, index);
    const UnitBox representative = reps[row(chunk.task) + c - 1];
    float* const own = distances + chunk.of.first + chunk.part.first;
    float farthest = 0;
    share(lanes, chunk.part.count, [&](uint32_t i) {
      const float d = distanceTo(settings.metric, chunk.part.boxes[i], representative);
      own[i] = c == 1 ? d : minOf(d, own[i]);
      farthest = maxOf(own[i], farthest);
    });
    if (c == 1) atomicMaxRelaxed(largest + chunk.task, farthest);
  }
};

struct SumShares : PlusPlus {
  struct Add {
    HD uint64_t operator()(uint64_t a, uint64_t b) const { return a + b; }
  };
  template <class Lanes>
  HD void operator()(Lanes& lanes, uint32_t index) const {
    const Chunk chunk(*this, index);
    const float* const own = distances + chunk.of.first + chunk.part.first;
    uint64_t sum = 0;
    share(lanes, chunk.part.count, [&](uint32_t i) { sum += shareOf(own[i], largest[chunk.task]); });
    sum = lanes.reduce(sum, Add{});
    if (lanes.lane() == 0) chunkSums[index] = sum;
  }
};

/// Index: a task.
struct DrawNext : PlusPlus {
  HD void operator()(uint32_t index) const {
    const Task& t = tasks[index];
    uint64_t total = 0;
    for (uint32_t chunk = 0, end = chunksOf(t); chunk < end; ++chunk) total += chunkSums[t.firstChunk + chunk];
    uint32_t at;
    if (total == 0) {  // Every triangle's box is a representative.
      at = static_cast<uint32_t>(drawBelow(settings, c, t.first, t.count, t.count));
    } else {
      uint64_t rest = drawBelow(settings, c, t.first, t.count, total);
      uint32_t chunk = 0;
      for (; rest >= chunkSums[t.firstChunk + chunk]; ++chunk) rest -= chunkSums[t.firstChunk + chunk];
      at = chunk * chunkSize;
      for (; rest >= shareAt(index, t.first + at); ++at) rest -= shareAt(index, t.first + at);
    }
    reps[row(index) + c] = boxes[t.first + at];
  }
  HD uint64_t shareAt(uint32_t task, uint32_t place) const { return shareOf(distances[place], largest[task]); }
};

}  // namespace copse::kmeans
