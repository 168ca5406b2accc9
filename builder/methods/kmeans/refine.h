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
  struct Shared {
    Workspace work;
    Open stack[32];  // The smaller part is split first, so the stack grows with the logarithm of the segment.
  };

  template <class Lanes>
  HD void operator()(Lanes& lanes, uint32_t index) const {
    Shared& shared = *static_cast<Shared*>(lanes.shared());
    const LeafTask task = tasks[index];
    const Box all = boxOf(lanes, task);
    uint32_t top = 0, used = 1;
    Open open{task.first, task.count, task.base};
    for (;;) {
      const uint32_t left = split(lanes, open, shared.work);
      Open parts[2] = {{open.first, left, 0}, {open.first + left, open.count - left, 0}};
      for (Open& part : parts) part.node = part.count == 1 ? leafNodes + part.first : task.base + used++;
      if (lanes.lane() == 0) {
        nodes[open.node] = BvhNode::inner(open.node == task.base ? all : Box{}, parts[0].node, parts[1].node);
        parents[parts[0].node] = parents[parts[1].node] = open.node;
      }
      const uint32_t small = parts[0].count > parts[1].count;
      if (parts[small].count > 1) {
        if (lanes.lane() == 0) shared.stack[top] = parts[1 - small];
        lanes.sync();
        ++top;
        open = parts[small];
      } else if (parts[1 - small].count > 1) {
        open = parts[1 - small];
      } else {
        if (top == 0) return;
        open = shared.stack[--top];
        lanes.sync();
      }
    }
  }

  struct Unite {
    HD Box operator()(const Box& a, const Box& b) const { return unite(a, b); }
  };
  template <class Lanes>
  HD Box boxOf(Lanes& lanes, const LeafTask& task) const {
    Box all;
    share(lanes, task.count, [&](uint32_t i) { all.grow(boxes[task.first + i].box()); });
    return lanes.reduce(all, Unite{});
  }

  /// Orders the segment by cluster; returns how many belong to the first.
  template <class Lanes>
  HD uint32_t split(Lanes& lanes, const Open& open, Workspace& w) const {
    if (open.count == 2) return 1;
    const Part part{boxes + open.first, cluster + open.first, open.count, 0, open.count};
    if (settings.plusPlus)
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
      const uint32_t place = takePlace(lanes, w.cursors, c, valid);
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
