// The leaf queue: segments of fewer than m k triangles are split in two by k-means (k = 2) until one triangle is left.
// One team a segment does the whole recursion near its cache, where the paper runs further passes over all triangles;
// the splits are the same.
#pragma once

#include "builder/bvh.h"
#include "builder/methods/kmeans/plusplus.h"

namespace copse::kmeans {

/// A segment of the leaf queue: its binary tree takes count-1 inner nodes from `base` on, the first being its root.
struct LeafTask {
  uint32_t first, count, base;
};

template <bool plusPlus>
struct Refine {
  Settings settings;
  UnitBox* boxes;    ///< Sorted in place.
  UnitBox* scratch;  ///< As long as `boxes`.
  uint8_t* cluster;
  const LeafTask* tasks;
  BvhNode* nodes;  ///< Links; and the box of each segment's root, in the scene's unit.
  uint32_t* parents;
  uint32_t leafNodes;  ///< The leaf of place p in the order is node leafNodes + p.

  struct Open {
    uint32_t first, count, node;
  };
  using Workspace = WorkspaceFor<2>;
  struct Shared {
    Workspace work;
    Open stack[32];  // The smaller part is split first, so the stack grows with the logarithm of the segment.
  };

  /// Blocks have four warps. Each warp has some ten triangles and waits for its own shuffles most of the time, so more
  /// warps help; 48 registers leave room for so many, and cost four words of memory that are read once per split.
  static constexpr int residentBlocks = 10;

  template <class Lanes>
  HD void operator()(Lanes& lanes, uint32_t index) const {
    Shared& shared = *static_cast<Shared*>(lanes.shared());
    const LeafTask task = tasks[index];
    if (lanes.lane() == 0) shared.stack[0] = {task.first, task.count, task.base};
    lanes.sync();
    uint32_t top = 1, used = 1;
    while (top > 0) {
      const uint32_t left = split(lanes, shared.stack[top - 1], shared.work);
      const Open open = shared.stack[--top];  // Read again, so that no register holds it meanwhile.
      lanes.sync();
      const uint32_t right = open.count - left;
      const Open a{open.first, left, left == 1 ? leafNodes + open.first : task.base + used++};
      const Open b{open.first + left, right, right == 1 ? leafNodes + open.first + left : task.base + used++};
      if (lanes.lane() == 0) {
        nodes[open.node] = BvhNode::inner(Box{}, a.node, b.node);
        parents[a.node] = parents[b.node] = open.node;
        shared.stack[top] = left > right ? a : b;
        shared.stack[top + 1] = left > right ? b : a;
      }
      top += (left > 1) + (right > 1);  // Where one of them is a leaf, it is the second.
      lanes.sync();
    }
    const Box all = boxOf(lanes, task);
    if (lanes.lane() == 0) {
      nodes[task.base].lo = all.lo;
      nodes[task.base].hi = all.hi;
    }
  }

  template <class Lanes>
  HD Box boxOf(Lanes& lanes, const LeafTask& task) const {
    Box all;
    share(lanes, task.count, [&](uint32_t i) { all.grow(boxes[task.first + i].box()); });
    return lanes.reduce(all, UniteBoxes{});
  }

  /// Orders the segment by cluster; returns how many belong to the first.
  template <class Lanes>
  HD uint32_t split(Lanes& lanes, Open open, Workspace& w) const {
    if (open.count == 2) return 1;
    const Part part{boxes + open.first, cluster + open.first, open.count, 0, open.count};
    if constexpr (plusPlus)
      drawTwoPlusPlus(lanes, settings, part.boxes, open.first, open.count, w);
    else
      drawRepresentatives(lanes, settings, 2, part.boxes, open.first, open.count, w);
    if (settings.iterations) clearSums(lanes, 2, w);
    const double scale = fixedScale(open.count);
    for (uint32_t t = 0;; ++t) {  // Where nothing moves, the means stay, and so would all that follows.
      const bool last = t == settings.iterations;
      if (!assign(lanes, settings.metric, 2, part, t == 0, !last, scale, w) || last) break;
      share(lanes, 2, [&](uint32_t c) { moveToMean(w.reps[c], w.sums[c].at); });
      lanes.sync();
    }
    const uint32_t left = partition(lanes, part, w);
    return left == 0 || left == open.count ? open.count / 2 : left;  // No mean tells them apart: Morton's halves.
  }

  /// The first cluster's boxes to the front, each in the old order; returns how many they are.
  template <class Lanes>
  HD uint32_t partition(Lanes& lanes, const Part& part, Workspace& w) const {
    UnitBox* const spare = scratch + (part.boxes - boxes);
    UnitBox* const own = boxes + (part.boxes - boxes);
    share(lanes, 2, [&](uint32_t c) { w.cursors[c] = 0; });
    lanes.sync();
    for (uint32_t base = 0; base < part.count; base += Lanes::size) {  // The front is never ahead of what is read.
      const uint32_t i = base + lanes.lane();
      const bool valid = i < part.count;
      const uint32_t c = valid ? part.cluster[i] : 0;
      const UnitBox box = own[valid ? i : base];
      const uint32_t place = takePlace<2>(lanes, w.cursors, c, valid);
      if (valid) (c ? spare : own)[place] = box;
      lanes.sync();
    }
    const uint32_t left = w.cursors[0];
    share(lanes, part.count - left, [&](uint32_t i) { own[left + i] = spare[i]; });
    lanes.sync();
    return left;
  }
};

}  // namespace copse::kmeans
