// A queue of tasks a level: each is a node and the clusters below it. Clusters are counted into the task's bins, one a
// grid cell an axis; a task sweeps its bins; clusters go to the task of their side, or hang from the node where they
// are alone. Garanzha, Pantaleoni, McAllister: Simpler and Faster HLBVH with Work Queues (HPG 2011).
// Tasks and nodes get their numbers by scans, and boxes grow by minimum and maximum, so nothing depends on threads.
#include "builder/methods/hlbvh/top_tree.h"

#include <cfloat>

#include "builder/bottom_up.h"
#include "builder/parallel/launch.h"
#include "builder/parallel/primitives.h"

namespace copse::hlbvh {

namespace {

constexpr uint32_t noTask = ~0u;

/// The cells between two corners, both included.
struct CellRange {
  Cell lo, hi;

  HD uint32_t width(int axis) const { return hi[axis] - lo[axis] + 1; }
  HD uint32_t bins() const { return width(0) + width(1) + width(2); }
};

struct Task {
  CellRange range;
  uint32_t firstBin;  ///< Those of x, then of y, then of z.
};

struct Bin {
  Box box;
  uint32_t clusters, primitives;
};

/// How a task's clusters part: up to cell `last` along `axis` they go to child 0.
struct Parting {
  uint32_t axis, last;
  uint32_t clusters[2];
  CellRange range[2];
  uint32_t task[2];  ///< Of the next level, or noTask where the child is one cluster.
};

struct ResetBins {
  Bin* bins;

  HD void operator()(uint32_t i) const { bins[i] = {Box{}, 0, 0}; }
};

/// Clusters leave their tasks of the level before and are counted into those of this one.
struct PlaceClusters {
  Clusters clusters;
  const Parting* partings;  ///< Of the level before.
  uint32_t levelBefore;     ///< The first node of it.
  const Task* tasks;
  Bin* bins;
  uint32_t* taskOf;
  BvhNode* nodes;
  uint32_t* parents;
  bool isFirst;

  HD void operator()(uint32_t c) const {
    uint32_t task = isFirst ? 0 : taskOf[c];
    if (task == noTask) return;
    const Cell cell = clusters.cells[c];
    if (!isFirst) {
      const Parting& parting = partings[task];
      const bool right = cell[static_cast<int>(parting.axis)] > parting.last;
      const uint32_t at = levelBefore + task;
      task = parting.task[right];
      if (task == noTask) {
        const uint32_t root = clusters.root(c);
        (right ? nodes[at].right : nodes[at].left) = root;
        parents[root] = at;
      }
    }
    taskOf[c] = task;
    if (task != noTask) count(tasks[task], cell, clusters.boxes[c], clusters.size(c));
  }

  HD void count(const Task& task, Cell cell, const Box& box, uint32_t primitives) const {
    uint32_t first = task.firstBin;
    for (int axis = 0; axis < 3; ++axis) {
      Bin& bin = bins[first + cell[axis] - task.range.lo[axis]];
      for (int k = 0; k < 3; ++k) {
        atomicMinRelaxed(&bin.box.lo[k], box.lo[k]);
        atomicMaxRelaxed(&bin.box.hi[k], box.hi[k]);
      }
      atomicAddRelaxed(&bin.clusters, 1u);
      atomicAddRelaxed(&bin.primitives, primitives);
      first += task.range.width(axis);
    }
  }
};

struct ChooseSplits {
  const Task* tasks;
  const Bin* bins;
  Parting* partings;
  uint32_t* childTasks;
  uint32_t* childBins;

  struct Best {
    float cost = 0;
    uint32_t unevenness = 0;
    bool found = false;
  };

  HD void operator()(uint32_t t) const {
    const Task task = tasks[t];
    CellRange tight{{0}, {0}};
    Parting parting{};
    Best best;
    uint32_t first = task.firstBin;
    for (int axis = 0; axis < 3; ++axis) {
      sweep(axis, task.range.lo[axis], task.range.width(axis), bins + first, tight, best, parting);
      first += task.range.width(axis);
    }
    narrow(bins + task.firstBin, task.range, tight, parting);
    uint32_t count = 0, width = 0;
    for (const int side : {0, 1}) {
      const bool isTask = parting.clusters[side] > 1;
      count += isTask;
      width += isTask ? parting.range[side].bins() : 0;
    }
    partings[t] = parting;
    childTasks[t] = count;
    childBins[t] = width;
  }

  /// Σ area × primitives of the two sides over all planes of one axis; a plane has clusters on both sides. Costs that
  /// are no number, of boxes that reach to infinity, count as the largest.
  HD void sweep(int axis, uint32_t cell, uint32_t width, const Bin* of, CellRange& tight, Best& best,
                Parting& parting) const {
    float rightCost[maxCells];
    Box box;
    uint32_t clusters = 0, primitives = 0, lo = 0, hi = 0;
    for (uint32_t i = width; i-- > 0;) {
      const Bin bin = of[i];
      if (bin.clusters) {
        if (clusters == 0) hi = i;
        lo = i;
        clusters += bin.clusters;
        primitives += bin.primitives;
        box.grow(bin.box);
      }
      rightCost[i] = box.area() * static_cast<float>(primitives);
    }
    tight.lo.packed |= (cell + lo) << 8 * axis;
    tight.hi.packed |= (cell + hi) << 8 * axis;
    box = Box{};
    uint32_t left = 0;
    primitives = 0;
    for (uint32_t i = lo; i < hi; ++i) {
      const Bin bin = of[i];
      if (bin.clusters == 0) continue;
      left += bin.clusters;
      primitives += bin.primitives;
      box.grow(bin.box);
      const float sum = box.area() * static_cast<float>(primitives) + rightCost[i + 1];
      const float cost = sum < FLT_MAX ? sum : FLT_MAX;
      const uint32_t right = clusters - left, unevenness = left > right ? left - right : right - left;
      if (best.found && (cost > best.cost || (cost == best.cost && unevenness >= best.unevenness))) continue;
      best = {cost, unevenness, true};
      parting.axis = static_cast<uint32_t>(axis);
      parting.last = cell + i;
      parting.clusters[0] = left;
      parting.clusters[1] = right;
    }
  }

  /// The children's cells: the task's own without empty ones at the border, parted.
  HD static void narrow(const Bin* of, const CellRange& range, const CellRange& tight, Parting& parting) {
    const int axis = static_cast<int>(parting.axis);
    for (int before = 0; before < axis; ++before) of += range.width(before);
    uint32_t next = parting.last + 1 - range.lo[axis];
    while (of[next].clusters == 0) ++next;
    const uint32_t others = ~(0xffu << 8 * axis);
    parting.range[0] = {tight.lo, {(tight.hi.packed & others) | parting.last << 8 * axis}};
    parting.range[1] = {{(tight.lo.packed & others) | (range.lo[axis] + next) << 8 * axis}, tight.hi};
  }
};

struct WriteNodes {
  Parting* partings;
  const uint32_t* taskRank;
  const uint32_t* binRank;
  Task* nextTasks;
  BvhNode* nodes;
  uint32_t* parents;
  uint32_t level, nextLevel;  ///< The first node of each.

  HD void operator()(uint32_t t) const {
    Parting& parting = partings[t];
    const uint32_t at = level + t;
    uint32_t task = taskRank[t], bin = binRank[t], child[2];
    for (const int side : {0, 1}) {
      const bool isTask = parting.clusters[side] > 1;
      parting.task[side] = isTask ? task : noTask;
      child[side] = isTask ? nextLevel + task : noTask;  // A lone cluster puts itself there.
      if (!isTask) continue;
      nextTasks[task] = {parting.range[side], bin};
      parents[child[side]] = at;
      bin += parting.range[side].bins();
      ++task;
    }
    nodes[at] = BvhNode::inner(Box{}, child[0], child[1]);
  }
};

}  // namespace

void buildTopTree(const Device& device, const Clusters& clusters, BvhNode* nodes, uint32_t* parents) {
  const uint32_t most = clusters.count / 2 + 1;  // A task has two clusters at least.
  Buffer<Task> tasks(device, most), nextTasks(device, most);
  Buffer<Parting> partings(device, most);
  Buffer<uint32_t> ranks(device, 2 * std::size_t{most}), totals(device, 2), taskOf(device, clusters.count);
  Buffer<Bin> bins;
  const uint32_t last = maxCells - 1;
  const Task whole{{{0}, {last | last << 8 | last << 16}}, 0};
  tasks.upload(std::span(&whole, 1));
  const uint32_t none = ParentLinks::none;
  copyToDevice(device, parents, &none, sizeof none);

  uint32_t count = 1, binCount = whole.range.bins(), levelBefore = 0, level = 0;
  for (bool isFirst = true;; isFirst = false) {
    if (bins.size() < binCount) bins = Buffer<Bin>(device, binCount);
    launch(device, "reset bins", binCount, ResetBins{bins.data()});
    launch(device, "place clusters", clusters.count,
           PlaceClusters{clusters, partings.data(), levelBefore, tasks.data(), bins.data(), taskOf.data(), nodes,
                         parents, isFirst});
    if (count == 0) break;
    uint32_t *const taskRank = ranks.data(), *const binRank = ranks.data() + most;
    launch(device, "choose splits", count, ChooseSplits{tasks.data(), bins.data(), partings.data(), taskRank, binRank},
           64);
    exclusiveScan(device, "rank tasks", count, taskRank, taskRank, totals.data());
    exclusiveScan(device, "rank bins", count, binRank, binRank, totals.data() + 1);
    launch(device, "write nodes", count,
           WriteNodes{partings.data(), taskRank, binRank, nextTasks.data(), nodes, parents, level, level + count});
    levelBefore = level;
    level += count;
    tasks.swap(nextTasks);
    const std::vector<uint32_t> next = totals.toHost();
    count = next[0];
    binCount = next[1];
  }
}

}  // namespace copse::hlbvh
