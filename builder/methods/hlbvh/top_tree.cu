// A queue of tasks per level: each is a node and the clusters below it. Clusters are counted into the task's bins, one
// per grid cell and axis; a task sweeps its bins; clusters go to the task of their side, or hang from the node where
// they are alone. Garanzha, Pantaleoni, McAllister: Simpler and Faster HLBVH with Work Queues (HPG 2011). Tasks and
// nodes get their numbers by scans, and boxes grow by minimum and maximum, so nothing depends on threads. How many
// tasks a level has stays on the device: launches are as large as the maximum possible number.
#include "builder/methods/hlbvh/top_tree.h"

#include <algorithm>
#include <bit>
#include <cfloat>

#include "builder/bottom_up.h"
#include "builder/parallel/bits.h"
#include "builder/parallel/launch.h"
#include "builder/parallel/one_lane.h"
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

/// The tasks of a level and its nodes, one per task.
struct Level {
  uint32_t tasks, firstNode;
};

/// The box, the clusters and the primitives of one cell, or of several; 32 bytes, loaded as two words of 16.
struct alignas(16) Bin {
  vec3 lo{FLT_MAX, FLT_MAX, FLT_MAX};
  uint32_t clusters = 0;
  vec3 hi{-FLT_MAX, -FLT_MAX, -FLT_MAX};
  uint32_t primitives = 0;

  HD void add(const Bin& other) {
    lo = minOf(other.lo, lo);
    hi = maxOf(other.hi, hi);
    clusters += other.clusters;
    primitives += other.primitives;
  }
  HD float cost() const {
    Box box;
    box.lo = lo;
    box.hi = hi;
    return box.area() * static_cast<float>(primitives);
  }
};
static_assert(sizeof(Bin) == 32);

/// How a task's clusters part: up to cell `last` along `axis` they go to child 0.
struct Parting {
  uint32_t axis, last;
  uint32_t clusters[2];
  CellRange range[2];
  uint32_t task[2];  ///< In the next level, or noTask where the child is one cluster.
};

/// The first level: one task of all clusters, where there are two at least. Index: a bin.
struct StartTask {
  Clusters clusters;
  Task whole;
  Task* tasks;
  Bin* bins;
  Level* level;

  HD void operator()(uint32_t i) const {
    bins[i] = Bin{};
    if (i > 0) return;
    tasks[0] = whole;
    *level = {*clusters.counted > 1, 0};
  }
};

/// Clusters leave their tasks of the level before and are counted into those of this one.
struct PlaceClusters {
  Clusters clusters;
  const Parting* partings;  ///< From the level before.
  const Level* level;       ///< Where it is not the first, the one before stands before it.
  const Task* tasks;
  Bin* bins;
  uint32_t* taskOf;
  BvhNode* nodes;
  uint32_t* parents;
  bool isFirst;

  HD void prepare() { clusters.load(); }
  HD void operator()(uint32_t c) const {
    if (c >= clusters.count) return;
    uint32_t task = !isFirst ? taskOf[c] : level->tasks ? 0 : noTask;
    if (task == noTask) {
      taskOf[c] = noTask;
      return;
    }
    const Cell cell = clusters.cells[c];
    if (!isFirst) {
      const Parting& parting = partings[task];
      const bool right = cell[static_cast<int>(parting.axis)] > parting.last;
      const uint32_t at = level[-1].firstNode + task;
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
        atomicMinRelaxed(&bin.lo[k], box.lo[k]);
        atomicMaxRelaxed(&bin.hi[k], box.hi[k]);
      }
      atomicAddRelaxed(&bin.clusters, 1u);
      atomicAddRelaxed(&bin.primitives, primitives);
      first += task.range.width(axis);
    }
  }
};

/// A plane between the cells of a task along an axis, and how it compares.
struct Plane {
  float cost = FLT_MAX;
  uint32_t unevenness = ~0u, axis = 0, last = 0;  ///< Cells up to `last` are on the left,
  uint32_t left = 0, right = 0;                   ///< where as many clusters are.

  /// Where planes have equal costs the first one wins; x comes before y, y before z.
  HD bool operator<(const Plane& o) const {
    if (cost != o.cost) return cost < o.cost;
    if (unevenness != o.unevenness) return unevenness < o.unevenness;
    return axis != o.axis ? axis < o.axis : last < o.last;
  }
};

struct BetterPlane {
  HD Plane operator()(const Plane& a, const Plane& b) const { return b < a ? b : a; }
};

/// One task a team: on CUDA each lane has a bin of an axis, and all planes are tried at once; a CPU thread sweeps.
struct ChooseSplits {
  const Task* tasks;
  const Bin* bins;
  Parting* partings;
  const Level* level;
  uint32_t* childTasks;
  uint32_t* childBins;

  template <class Lanes>
  HD void operator()(Lanes& lanes, uint32_t t) const {
    if (t >= level->tasks) {
      if (lanes.lane() == 0) childTasks[t] = childBins[t] = 0;
      return;
    }
    const Task task = tasks[t];
    Plane best;
    uint32_t occupied[3];  // For each axis, a bit mask of the cells that have clusters.
    const Bin* of[3] = {bins + task.firstBin};
    for (int axis = 1; axis < 3; ++axis) of[axis] = of[axis - 1] + task.range.width(axis - 1);
    if constexpr (Lanes::size == 1) {
      for (int axis = 0; axis < 3; ++axis)
        occupied[axis] = sweep(axis, task.range.lo[axis], task.range.width(axis), of[axis], best);
    } else {
      const auto binOf = [&](int axis) { return of[axis][lanes.lane() < task.range.width(axis) ? lanes.lane() : 0]; };
      const Bin own[3] = {binOf(0), binOf(1), binOf(2)};  // Before the first shuffle, so that all three wait together.
      for (int axis = 0; axis < 3; ++axis)
        occupied[axis] = tryPlanes(lanes, axis, task.range.lo[axis],
                                   lanes.lane() < task.range.width(axis) ? own[axis] : Bin{}, best);
    }
    best = lanes.reduce(best, BetterPlane{});
    if (lanes.lane() == 0) part(t, task.range, occupied, best);
  }

  /// Σ area × primitives of the two sides of each plane of one axis; a plane has clusters on both sides. Costs that are
  /// no number, of boxes that reach to infinity, count as the largest. Returns which cells have clusters.
  template <class Lanes>
  HD static uint32_t tryPlanes(Lanes& lanes, int axis, uint32_t cell, Bin left, Plane& best) {
    const uint32_t own = lanes.lane();
    const uint32_t occupied = lanes.ballot(left.clusters > 0);
    Bin right = left;
    for (uint32_t step = 1; step < Lanes::size; step *= 2) {
      const Bin below = lanes.shfl(left, own - step), above = lanes.shfl(right, own + step);
      if (own >= step) left.add(below);
      if (own + step < Lanes::size) right.add(above);
    }
    const float rightCost = lanes.shfl(right.cost(), own + 1);
    const uint32_t all = lanes.shfl(left.clusters, Lanes::size - 1);
    if (occupied >> own & 1 && left.clusters < all) offer(axis, cell + own, left, all, rightCost, best);
    return occupied;
  }
  HD static uint32_t sweep(int axis, uint32_t cell, uint32_t width, const Bin* of, Plane& best) {
    float rightCost[maxCells];
    uint32_t occupied = 0;
    Bin left, right;
    for (uint32_t i = width; i-- > 0;) {
      if (of[i].clusters) {
        occupied |= 1u << i;
        right.add(of[i]);
      }
      rightCost[i] = right.cost();
    }
    for (uint32_t cells = occupied; cells & (cells - 1); cells &= cells - 1) {
      const uint32_t i = lowestBit(cells);
      left.add(of[i]);
      offer(axis, cell + i, left, right.clusters, rightCost[i + 1], best);
    }
    return occupied;
  }
  HD static void offer(int axis, uint32_t last, const Bin& left, uint32_t clusters, float rightCost, Plane& best) {
    const float sum = left.cost() + rightCost;
    const uint32_t right = clusters - left.clusters;
    const uint32_t unevenness = left.clusters > right ? left.clusters - right : right - left.clusters;
    const Plane plane{
        sum < FLT_MAX ? sum : FLT_MAX, unevenness, static_cast<uint32_t>(axis), last, left.clusters, right};
    if (plane < best) best = plane;
  }

  /// The children's cells are the task's own without empty ones at the border, parted.
  HD void part(uint32_t t, const CellRange& range, const uint32_t occupied[3], const Plane& plane) const {
    CellRange tight{{0}, {0}};
    uint32_t behind = 0;  // The first cell behind the plane that has clusters.
    for (int axis = 0; axis < 3; ++axis) {
      const uint32_t cell = range.lo[axis];
      tight.lo.packed |= (cell + lowestBit(occupied[axis])) << 8 * axis;
      tight.hi.packed |= (cell + 31 - leadingZeros(occupied[axis])) << 8 * axis;
      if (static_cast<uint32_t>(axis) == plane.axis)
        behind = plane.last + 1 + lowestBit(occupied[axis] >> (plane.last + 1 - cell));
    }
    const uint32_t shift = 8 * plane.axis, others = ~(0xffu << shift);
    Parting parting{plane.axis, plane.last, {plane.left, plane.right}, {}, {}};
    parting.range[0] = {tight.lo, {(tight.hi.packed & others) | plane.last << shift}};
    parting.range[1] = {{(tight.lo.packed & others) | behind << shift}, tight.hi};
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
};
static_assert(maxCells <= Warp::size);

struct WriteNodes {
  Parting* partings;
  /// Child tasks before each of `row` tasks, then child bins and all tasks, then the sum of all.
  const uint32_t* ranks;
  uint32_t row;
  Task* nextTasks;
  Bin* bins;  ///< For the next level: nobody needs this one's any more.
  BvhNode* nodes;
  uint32_t* parents;
  Level* level;  ///< The next one stands behind it.

  HD void operator()(uint32_t t) const {
    const uint32_t nextLevel = level->firstNode + level->tasks;
    if (t == 0) level[1] = {ranks[row], nextLevel};
    if (t >= level->tasks) return;
    Parting& parting = partings[t];
    const uint32_t at = level->firstNode + t;
    uint32_t task = ranks[t], bin = ranks[row + t] - ranks[row], child[2];
    for (const int side : {0, 1}) {
      const bool isTask = parting.clusters[side] > 1;
      parting.task[side] = isTask ? task : noTask;
      child[side] = isTask ? nextLevel + task : noTask;  // A lone cluster puts itself there.
      if (!isTask) continue;
      nextTasks[task] = {parting.range[side], bin};
      parents[child[side]] = at;
      for (const uint32_t end = bin + parting.range[side].bins(); bin < end; ++bin) bins[bin] = Bin{};
      ++task;
    }
    nodes[at] = BvhNode::inner(Box{}, child[0], child[1]);
  }
};

/// The maximum number of bins of `tasks` tasks. Their ranges have no cell in common, and one of b bins has b-2 cells at
/// least.
std::size_t maxBins(std::size_t tasks, std::size_t gridCells) {
  constexpr std::size_t ofOne = 3 * maxCells;
  return std::max(ofOne, std::min(ofOne * tasks, gridCells + 2 * tasks));
}

}  // namespace

void buildTopTree(const Device& device, const Clusters& clusters, uint32_t gridCells, BvhNode* nodes, uint32_t* parents,
                  bool onFibers) {
  // Every level of a task narrows its range, which is three times maxCells-1 cells wide at first, by one or more. The
  // host looks whether any task is left where a tree may be done, and then at every other level: one too many costs
  // less than a look.
  constexpr uint32_t maxLevels = 3 * maxCells;
  const auto firstLook = static_cast<uint32_t>(std::bit_width(clusters.maxCount - 1));
  const uint32_t maxTasks = clusters.maxCount / 2 + 1;  // A task has two clusters at least.
  Buffer<Task> tasks(device, maxTasks), nextTasks(device, maxTasks);
  Buffer<Parting> partings(device, maxTasks);
  Buffer<Level> levels(device, maxLevels + 2);
  Buffer<uint32_t> ranks(device, 2 * std::size_t{maxTasks} + 1), taskOf(device, clusters.maxCount);
  Buffer<Bin> bins(device, maxBins(maxTasks, gridCells));
  const uint32_t last = maxCells - 1;
  const Task whole{{{0}, {last | last << 8 | last << 16}}, 0};
  launch(device, "start task", whole.range.bins(),
         StartTask{clusters, whole, tasks.data(), bins.data(), levels.data()});

  for (uint32_t at = 0;; ++at) {
    Level* const level = levels.data() + at;
    launch(device, "place clusters", indicesFor(device, clusters.maxCount, clusters.counted),
           PlaceClusters{clusters, partings.data(), level, tasks.data(), bins.data(), taskOf.data(), nodes, parents,
                         at == 0});
    if (at >= firstLook && (at - firstLook) % 2 == 0 && levels.read(at).tasks == 0) break;
    const uint32_t row =
        std::max(1u, indicesFor(device, at < 31 ? std::min(maxTasks, 1u << at) : maxTasks, &level->tasks));
    const ChooseSplits choose{tasks.data(), bins.data(), partings.data(), level, ranks.data(), ranks.data() + row};
    if (onFibers)
      launchWarps(device, "choose splits", row, choose);
    else
      launchTeams(device, "choose splits", row, choose, 0, 64);
    exclusiveScan(device, "rank tasks and bins", 2 * row, ranks.data(), ranks.data(), ranks.data() + 2 * row);
    launch(device, "write nodes", row,
           WriteNodes{partings.data(), ranks.data(), row, nextTasks.data(), bins.data(), nodes, parents, level});
    tasks.swap(nextTasks);
  }
}

}  // namespace copse::hlbvh
