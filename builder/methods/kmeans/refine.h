// The leaf queue: segments of fewer than m k triangles are split in two by k-means (k = 2) until one triangle is left.
// One team a segment does the whole recursion near its cache, where the paper runs further passes over all triangles;
// the splits are the same.
#pragma once

#include "builder/bvh.h"
#include "builder/methods/kmeans/segment.h"

namespace copse::kmeans {

/// A segment of the leaf queue: its binary tree takes count-1 inner nodes from `base` on, the first being its root.
struct LeafTask {
  uint32_t first, count, base;
};

struct Refine {
  Settings settings;
  const UnitBox* boxes;
  uint32_t* order;    ///< In place.
  uint32_t* scratch;  ///< As long as `order`.
  uint8_t* cluster;
  const LeafTask* tasks;
  BvhNode* nodes;      ///< Links only; boxes follow in LeafBoxes.
  uint32_t leafNodes;  ///< The leaf of place p in the order is node leafNodes + p.

  struct Open {
    uint32_t first, count, node;
  };
  struct Shared {
    Workspace work;
    Open stack[32];  // The smaller part is split first, so the stack grows with the logarithm of the segment.
  };

  HD void operator()(const Team& team, uint32_t index) const {
    Shared& shared = *static_cast<Shared*>(team.shared());
    const LeafTask task = tasks[index];
    uint32_t top = 0, used = 1;
    Open open{task.first, task.count, task.base};
    for (;;) {
      const uint32_t left = split(team, open, shared.work);
      Open parts[2] = {{open.first, left, 0}, {open.first + left, open.count - left, 0}};
      for (Open& part : parts) part.node = part.count == 1 ? leafNodes + part.first : task.base + used++;
      team.single([&] {
        nodes[open.node].left = parts[0].node;
        nodes[open.node].right = parts[1].node;
      });
      const uint32_t small = parts[0].count > parts[1].count;
      const bool push = parts[small].count > 1;
      if (push) {
        team.single([&] { shared.stack[top] = parts[1 - small]; });
        ++top;
        open = parts[small];
      } else if (parts[1 - small].count > 1) {
        open = parts[1 - small];
      } else {
        if (top == 0) return;
        open = shared.stack[--top];
        team.sync();
      }
    }
  }

  /// Orders the segment by cluster; returns how many belong to the first.
  HD uint32_t split(const Team& team, const Open& open, Workspace& w) const {
    if (open.count == 2) return 1;
    const Segment segment{boxes, order + open.first, open.count};
    drawRepresentatives(team, settings, 2, segment, open.node, w);
    const double scale = fixedScale(open.count);
    for (uint32_t t = 0; t < settings.iterations; ++t) {
      clearSums(team, 2, w);
      assignAndSum(team, settings.metric, 2, segment, 0, open.count, w);
      team.forEach(12, [&](uint32_t j) {
        const uint32_t c = j / 6, d = j % 6;
        w.reps.at[d][c] = meanOf(w.sums[c], d, scale, w.reps.at[d][c]);
      });
    }
    team.forEach(2, [&](uint32_t c) { w.cursors[c] = 0; });
    team.forEach(open.count, [&](uint32_t i) {
      const uint32_t c = clusterOf(settings.metric, segment[i], w.reps, 2, i, open.count);
      cluster[open.first + i] = static_cast<uint8_t>(c);
      Team::add(&w.cursors[c], 1u);
    });
    const uint32_t left = w.cursors[0];
    team.sync();
    if (left == 0 || left == open.count) return open.count / 2;  // No mean tells them apart: halves, in Morton order.
    team.forEach(2, [&](uint32_t c) { w.cursors[c] = c * left; });
    team.partition(
        open.count, w.cursors, [&](uint32_t i) { return uint32_t{cluster[open.first + i]}; },
        [&](uint32_t i, uint32_t place) { scratch[open.first + place] = order[open.first + i]; });
    team.forEach(open.count, [&](uint32_t i) { order[open.first + i] = scratch[open.first + i]; });
    return left;
  }
};

/// Boxes of the trees that Refine made: a child's node stands after its parent's, so one walk backwards is enough.
struct LeafBoxes {
  const LeafTask* tasks;
  BvhNode* nodes;

  HD void operator()(uint32_t index) const {
    const LeafTask task = tasks[index];
    for (uint32_t node = task.base + task.count - 1; node-- > task.base;) {
      const Box box = unite(nodes[nodes[node].left].box(), nodes[nodes[node].right].box());
      nodes[node].lo = box.lo;
      nodes[node].hi = box.hi;
    }
  }
};

}  // namespace copse::kmeans
