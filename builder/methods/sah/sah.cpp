// The full sweep: at every node all splits along all three axes, in the order of the boxes' centres, and the one of
// minimum surface area cost. MacDonald and Booth: Heuristics for ray tracing using space subdivision (1990).
// The orders are sorted once and partitioned stably from node to node, so it is O(n log n); runs on the CPU's threads.
#include <omp.h>

#include <algorithm>
#include <bit>
#include <vector>

#include "builder/method.h"
#include "builder/methods/on_host.h"
#include "builder/methods/sah/sah_sweep.h"
#include "builder/parallel/primitives.h"
#include "builder/parallel/timeline.h"
#include "builder/phases.h"

namespace copse {

namespace {

constexpr PhaseGroup sweepGroup{"sweep"};
constexpr PhaseName sweepPhase{"sweep", &sweepGroup};

using sweep::prefetchDistance;
using sweep::SignedBox;
using sweep::Split;

/// Below this depth nodes are halved, which bounds the depth of any tree by this and log2 n.
constexpr uint32_t deepest = 64;
/// Fewer boxes than this are one task.
constexpr uint32_t taskSize = 4096;
/// From here on the axes and directions of one node are swept at the same time.
constexpr uint32_t wideSize = 32768;

/// A number that sorts like the float; -0 like 0, NaN last.
uint32_t sortable(float x) {
  if (x != x) return ~0u;
  const auto bits = std::bit_cast<uint32_t>(x + 0.0f);
  return bits & 0x80000000u ? ~bits : bits | 0x80000000u;
}

struct Sweep {
  uint32_t count;
  int threads;
  std::vector<SignedBox> boxes;
  Buffer<uint32_t> orders[3];  ///< Indices of boxes, ascending by centre, within each node's range.
  Buffer<uint32_t> moved;      ///< Scratch of the partitions: one range's worth for each of two axes.
  Buffer<float> costs;         ///< Scratch of the sweeps: two directions on three axes where they run at once.
  std::vector<uint8_t> goesLeft;
  BvhNode* nodes;

  Sweep(const Device& host, const Box* from, uint32_t n, BvhNode* to)
      : count(n), threads(host.threads), boxes(n), moved(host, 2 * std::size_t{n}), goesLeft(n), nodes(to) {
    const bool wide = threads > 1 && n >= wideSize;
    costs = Buffer<float>(host, (wide ? 6 : 1) * std::size_t{n});
#pragma omp parallel for num_threads(threads) if (n > taskSize)
    for (uint32_t i = 0; i < n; ++i) boxes[i] = SignedBox(from[i]);
  }

  void sort(const Device& host) {
    Buffer<uint64_t> keys(host, count), keyScratch(host, count);
    Buffer<uint32_t> scratch(host, count);
    for (int axis = 0; axis < 3; ++axis) {
      orders[axis] = Buffer<uint32_t>(host, count);
      uint32_t* order = orders[axis].data();
      uint64_t* key = keys.data();
#pragma omp parallel for num_threads(threads) if (count > taskSize)
      for (uint32_t i = 0; i < count; ++i) {
        key[i] = sortable(boxes[i].centre2(axis));
        order[i] = i;
      }
      radixSort(host, "sort centres", count, 32, keys, orders[axis], keyScratch, scratch);
    }
  }

  float* costsOf(int which) { return costs.data() + which * std::size_t{count}; }

  float spread(int axis, uint32_t begin, uint32_t end) const {
    const uint32_t* order = orders[axis].data();
    return boxes[order[end - 1]].centre2(axis) - boxes[order[begin]].centre2(axis);
  }

  Split sweepInTurn(int firstAxis, uint32_t begin, uint32_t end) {
    Split best;
    for (int turn = 0; turn < 3; ++turn) {
      const int axis = (firstAxis + turn) % 3;
      sweep::sweepAxis(boxes.data(), orders[axis].data(), begin, end, axis, costsOf(0), best);
    }
    return best;
  }

  Split sweepAtOnce(uint32_t begin, uint32_t end) {
    Split best[3];
#pragma omp taskgroup
    for (int axis = 0; axis < 3; ++axis) {
#pragma omp task default(shared) firstprivate(axis)
      sweep::sweepRight(boxes.data(), orders[axis].data(), begin, end, costsOf(2 * axis));
#pragma omp task default(shared) firstprivate(axis)
      sweep::sweepLeft(boxes.data(), orders[axis].data(), begin, end, costsOf(2 * axis + 1));
    }
#pragma omp taskgroup
    for (int axis = 0; axis < 3; ++axis) {
#pragma omp task default(shared) firstprivate(axis)
      {
        const float *right = costsOf(2 * axis), *left = costsOf(2 * axis + 1);
        Split bestHere;
        for (uint32_t i = begin + 1; i < end; ++i) sweep::improve(bestHere, left[i] + right[i], begin, i, end, axis);
        best[axis] = bestHere;
      }
    }
    return std::min({best[0], best[1], best[2]});
  }

  Split choose(uint32_t begin, uint32_t end, uint32_t depth) {
    int widest = 0;
    float spreads[3];
    for (int axis = 0; axis < 3; ++axis) {
      spreads[axis] = spread(axis, begin, end);
      if (spreads[axis] > spreads[widest]) widest = axis;
    }
    // Where all centres are equal the order says nothing and the costs differ by rounding alone.
    if (depth < deepest && spreads[widest] > 0) {
      const bool wide = threads > 1 && end - begin >= wideSize;
      const Split best = wide ? sweepAtOnce(begin, end) : sweepInTurn(widest, begin, end);
      if (best.found()) return best;
    }
    return sweep::splitAt(0, begin, begin + (end - begin) / 2, end, widest);
  }

  /// Brings what goes left to the front of the range in the order along `axis`, each side keeping its order.
  void partition(int axis, uint32_t begin, uint32_t end, uint32_t* aside) {
    uint32_t* order = orders[axis].data();
    uint32_t left = begin, right = begin;
    for (uint32_t i = begin; i < end; ++i) {
      if (end - i > prefetchDistance) prefetch(&goesLeft[order[i + prefetchDistance]]);
      const uint32_t box = order[i];
      const uint32_t stays = goesLeft[box];
      order[left] = box;
      aside[right] = box;
      left += stays;
      right += 1 - stays;
    }
    std::copy(aside + begin, aside + right, order + left);
  }

  void partitionOthers(const Split& split, uint32_t begin, uint32_t end) {
    const uint32_t* along = orders[split.axis].data();
    for (uint32_t i = begin; i < end; ++i) {
      if (end - i > prefetchDistance) prefetchForStore(&goesLeft[along[i + prefetchDistance]]);
      goesLeft[along[i]] = i < split.at;
    }
    const int second = (split.axis + 1) % 3, third = (split.axis + 2) % 3;
    uint32_t* aside = moved.data();
#pragma omp taskgroup
    {
#pragma omp task default(shared) if (threads > 1 && end - begin >= wideSize)
      partition(second, begin, end, aside);
      partition(third, begin, end, aside + count);
    }
  }

  /// The tree of the boxes begin … end-1 in nodes at, at+1, … in depth-first order.
  void build(uint32_t at, uint32_t begin, uint32_t end, uint32_t depth) {
    const uint32_t size = end - begin;
    if (size == 1) {
      nodes[at] = BvhNode::leaf(boxes[orders[0].data()[begin]].box(), begin, 1);
      return;
    }
    uint32_t middle = begin + 1;  // Two boxes have one split.
    if (size > 2) {
      const Split split = choose(begin, end, depth);
      partitionOthers(split, begin, end);
      middle = split.at;
    }
    const uint32_t left = at + 1, right = at + 2 * (middle - begin);
    if (size > taskSize && threads > 1) {
#pragma omp taskgroup
      {
#pragma omp task
        build(left, begin, middle, depth + 1);
        build(right, middle, end, depth + 1);
      }
    } else {
      build(left, begin, middle, depth + 1);
      build(right, middle, end, depth + 1);
    }
    nodes[at] = BvhNode::inner(unite(nodes[left].box(), nodes[right].box()), left, right);
  }
};

OpenTree buildSah(const Device& device, const Primitives& input, const Parameters&) {
  const uint32_t n = input.count;
  OpenTree bvh;
  if (n == 0) return bvh;
  const HostInput from(device, input);
  Buffer<BvhNode> nodes(from.host, 2 * n - 1);
  Sweep sweep(from.host, from.input.boxes, n, nodes.data());
  {
    Phase phase(device, phases::sort);
    sweep.sort(from.host);
  }
  {
    Phase phase(device, sweepPhase);
#pragma omp parallel num_threads(sweep.threads) if (n > taskSize)
#pragma omp single
    sweep.build(0, 0, n, 0);
  }
  bvh.referenceCount = n;
  bvh.nodeCount = 2 * n - 1;
  bvh.nodes = onDevice(device, std::move(nodes));
  bvh.order = onDevice(device, std::move(sweep.orders[0]));
  return bvh;
}

}  // namespace

namespace methods {

Method sah() {
  return {.name = "sah",
          .source = "MacDonald and Booth 1990",
          .meaning = "full sweep: the split of lowest surface area cost at each node",
          .page = "docs/builders/sah.md",
          .build = buildSah,
          .onCpuOnly = true,
          .phases = {sweepPhase}};
}

}  // namespace methods

}  // namespace copse
