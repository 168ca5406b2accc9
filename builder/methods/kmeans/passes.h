// The kernels of one pass: every open task of the k-ary tree is split into k clusters at once. Tasks own segments of
// the boxes, segments are cut into chunks, and a team takes a chunk: it keeps the representatives and its own sums in
// shared memory and adds these to the task's once. Meister and Bittner 2016, section 5, figure 3.
#pragma once

#include "builder/methods/kmeans/refine.h"

namespace copse::kmeans {

/// The number of chunks of a segment of `count` triangles.
HD inline uint32_t chunksOf(uint32_t count, uint32_t chunkSize) { return (count + chunkSize - 1) / chunkSize; }
/// Triangles per chunk: `settings.chunkSize`, or by the number of triangles where that is 0. On a GPU a warp goes
/// through its chunk row by row, so below some two million triangles large chunks leave most of the card idle. Chunks
/// of fewer than 256 would lose more than they gain, since each adds its sums to the same few addresses. A CPU has few
/// teams and keeps representatives in its cache.
inline uint32_t chunkSizeFor(const Device& device, const Settings& settings, uint32_t triangles) {
  if (settings.chunkSize) return (settings.chunkSize + 31) / 32 * 32;  // Whole warps.
  return device.isCuda() && triangles < 2'000'000 ? 256 : 1024;
}

/// A node of the k-ary tree that is to be split.
struct Task {
  uint32_t first, count;  ///< Its segment.
  uint32_t node;          ///< The binary node that will stand for it.
  uint32_t firstChunk;    ///< Chunks of all tasks are numbered through.
};

/// What a pass works on. Arrays with a row per task have k columns.
struct Pass {
  Settings settings;
  uint32_t chunkSize;  ///< Triangles that a team takes at a time. The tree does not depend on it.
  const UnitBox* boxes;
  uint8_t* cluster;  ///< A place's cluster, after the last assignment.
  const Task* tasks;
  uint32_t taskCount, chunkCount;
  UnitBox* reps;
  Sums* sums;
  uint32_t* lastMove;  ///< Per task: one more than the last iteration in which a triangle changed its cluster.
  uint32_t* counts;    ///< Before the scan: triangles by (task, cluster, chunk); after: places, counted over all tasks.

  HD uint32_t chunksOf(const Task& task) const { return kmeans::chunksOf(task.count, chunkSize); }
  HD uint32_t taskOf(uint32_t chunk) const {
    uint32_t low = 0, high = taskCount;
    while (high - low > 1) {
      const uint32_t middle = (low + high) / 2;
      (tasks[middle].firstChunk <= chunk ? low : high) = middle;
    }
    return low;
  }
  HD std::size_t row(uint32_t task) const { return std::size_t{task} * settings.k; }
  /// Column of (cluster, chunk of the task) in `counts`; cluster k is the next task's first.
  HD std::size_t countAt(const Task& task, uint32_t c, uint32_t chunk) const {
    return std::size_t{task.firstChunk} * settings.k + std::size_t{c} * chunksOf(task) + chunk;
  }
  HD uint32_t sizeOf(const Task& task, uint32_t c) const {
    return counts[countAt(task, c + 1, 0)] - counts[countAt(task, c, 0)];
  }
  /// All triangles in one cluster: no mean tells them apart. Then the segment is halved, in Morton order.
  HD bool undivided(const Task& task) const {
    for (uint32_t c = 0; c < settings.k; ++c)
      if (const uint32_t size = sizeOf(task, c)) return size == task.count;
    return true;
  }
  HD uint32_t splitSize(const Task& task, uint32_t c, bool halves) const {
    if (!halves) return sizeOf(task, c);
    return c == 0 ? task.count / 2 : c == 1 ? task.count - task.count / 2 : 0;
  }
  HD bool staysOpen(uint32_t size) const { return size >= settings.leafQueueBelow; }
  /// Nothing moved in the iteration before `iteration`: the means stayed, and so does all that follows.
  HD bool settled(uint32_t task, uint32_t iteration) const {
    return iteration > 0 && atomicLoadRelaxed(lastMove + task) < iteration;
  }
  template <class Lanes>
  HD void loadReps(Lanes& lanes, uint32_t task, Workspace& w) const {
    share(lanes, settings.k, [&](uint32_t c) { w.reps[c] = reps[row(task) + c]; });
    lanes.sync();
  }
};

/// A team's part of a pass.
struct Chunk {
  uint32_t task, local;  ///< Its task, and its number in there.
  Task of;
  Part part;
  HD Chunk(const Pass& pass, uint32_t index) : task(pass.taskOf(index)), of(pass.tasks[task]) {
    local = index - of.firstChunk;
    const uint32_t begin = local * pass.chunkSize;
    const uint32_t count = of.count - begin < pass.chunkSize ? of.count - begin : pass.chunkSize;
    part = {pass.boxes + of.first + begin, pass.cluster + of.first + begin, count, begin, of.count};
  }
};

struct DrawAll : Pass {
  template <class Lanes>
  HD void operator()(Lanes& lanes, uint32_t index) const {
    Workspace& w = *static_cast<Workspace*>(lanes.shared());
    const Task& t = tasks[index];
    drawRepresentatives(lanes, settings, settings.k, boxes + t.first, t.first, t.count, w);
    share(lanes, settings.k, [&](uint32_t c) {
      reps[row(index) + c] = w.reps[c];
      sums[row(index) + c] = Sums{};
    });
    if (lanes.lane() == 0) lastMove[index] = 0;
  }
};

struct AssignAndSum : Pass {
  uint32_t iteration;
  static constexpr int residentBlocks = 7;  ///< With four warps each: shared memory leaves room for one more.

  template <class Lanes>
  HD void operator()(Lanes& lanes, uint32_t index) const {
    Workspace& w = *static_cast<Workspace*>(lanes.shared());
    const Chunk chunk(*this, index);
    if (settled(chunk.task, iteration)) return;
    loadReps(lanes, chunk.task, w);
    clearSums(lanes, settings.k, w);
    if (!assign(lanes, settings.metric, settings.k, chunk.part, iteration == 0, true, fixedScale(chunk.of.count), w))
      return;
    if (lanes.lane() == 0) atomicStoreRelaxed(lastMove + chunk.task, iteration + 1);
    Sums* const total = sums + row(chunk.task);
    share(lanes, settings.k * 8, [&](uint32_t j) {
      const double value = w.sums[j / 8].at[j % 8];
      if (value != 0) atomicAddRelaxed(&total[j / 8].at[j % 8], value);
    });
  }
};

/// Index: a task's cluster.
struct Normalise : Pass {
  uint32_t iteration;
  HD void operator()(uint32_t index) const {
    if (lastMove[index / settings.k] == iteration + 1) moveToMean(reps[index], sums[index].at);
  }
};

/// The last assignment, and how many triangles of each chunk each cluster has.
struct ClusterSizes : Pass {
  template <class Lanes>
  HD void operator()(Lanes& lanes, uint32_t index) const {
    Workspace& w = *static_cast<Workspace*>(lanes.shared());
    const Chunk chunk(*this, index);
    if (!settled(chunk.task, settings.iterations)) {
      loadReps(lanes, chunk.task, w);
      assign(lanes, settings.metric, settings.k, chunk.part, settings.iterations == 0, false, 0, w);
    }
    share(lanes, settings.k, [&](uint32_t c) { w.cursors[c] = 0; });
    lanes.sync();
    for (uint32_t base = 0; base < chunk.part.count; base += Lanes::size) {
      const uint32_t i = base + lanes.lane();
      takePlace(lanes, w.cursors, i < chunk.part.count ? chunk.part.cluster[i] : 0, i < chunk.part.count);
    }
    share(lanes, settings.k, [&](uint32_t c) { counts[countAt(chunk.of, c, chunk.local)] = w.cursors[c]; });
  }
};

/// Counts per task of what its clusters become. The five arrays lie in one buffer, followed by their total, so that a
/// single scan turns all of them into offsets.
struct Children {
  enum Row : uint32_t {
    kids,        ///< Clusters that are not empty.
    open,        ///< … of these, tasks of the next pass,
    queued,      ///< … and tasks of the leaf queue.
    nodes,       ///< Inner nodes of the binary tree that this task allocates.
    openChunks,  ///< Chunks of the next pass's tasks.
    rows
  };
  uint32_t* numbers;
  uint32_t tasks;

  HD uint32_t& at(uint32_t row, uint32_t task) const { return numbers[std::size_t{row} * tasks + task]; }
  /// After the scan: over the tasks before.
  HD uint32_t before(Row row, uint32_t task) const { return at(row, task) - at(row, 0); }
  /// The total over all tasks.
  HD uint32_t total(Row row) const { return before(row, tasks); }
};

/// The host reads these, for the next pass.
struct Totals {
  uint32_t open, queued, nodes, openChunks;
};

struct CountChildren : Pass {
  Children out;
  HD void operator()(uint32_t index) const {
    const Task& t = tasks[index];
    const bool halves = undivided(t);
    uint32_t kids = 0, open = 0, queued = 0, nodes = 0, chunks = 0;
    for (uint32_t c = 0; c < settings.k; ++c) {
      const uint32_t size = splitSize(t, c, halves);
      kids += size > 0;
      if (staysOpen(size)) {
        ++open;
        chunks += kmeans::chunksOf(size, chunkSize);
      } else if (size > 1) {
        ++queued;
        nodes += size - 1;
      }
    }
    out.at(Children::kids, index) = kids;
    out.at(Children::open, index) = open;
    out.at(Children::queued, index) = queued;
    // The treelet of `kids` children has its root already.
    out.at(Children::nodes, index) = nodes + open + kids - 2;
    out.at(Children::openChunks, index) = chunks;
  }
};

/// What the agglomeration needs of a pass once it is over. Arrays have a number a task.
struct Level {
  uint32_t* roots;       ///< The binary node that stands for the task.
  uint32_t* firstKid;    ///< Into `kidNodes`, and one more than there are tasks.
  uint32_t* kidNodes;    ///< One row per task, packed: binary nodes of the children.
  uint32_t* extraNodes;  ///< The first of the treelet's inner nodes but the root.
  uint32_t taskCount;
};

/// Writes the next pass's tasks, the leaf queue, and each task's children for the agglomeration.
struct CreateTasks : Pass {
  Children children;   ///< After the scan.
  uint32_t nodeBase;   ///< The first binary node that this pass allocates.
  uint32_t queueBase;  ///< The leaf queue's length before this pass.
  uint32_t leafNodes;
  Task* nextTasks;
  LeafTask* leafQueue;
  Level level;
  Totals* totals;

  HD void operator()(uint32_t index) const {
    const Task& t = tasks[index];
    const bool halves = undivided(t);
    uint32_t node = nodeBase + children.before(Children::nodes, index), first = t.first;
    uint32_t kid = children.before(Children::kids, index), open = children.before(Children::open, index);
    uint32_t queued = queueBase + children.before(Children::queued, index);
    uint32_t chunk = children.before(Children::openChunks, index);
    uint32_t* const kidNodes = level.kidNodes;
    level.roots[index] = t.node;
    level.firstKid[index] = kid;
    if (index == 0) {
      level.firstKid[taskCount] = children.total(Children::kids);
      *totals = {children.total(Children::open), children.total(Children::queued), children.total(Children::nodes),
                 children.total(Children::openChunks)};
    }
    for (uint32_t c = 0; c < settings.k; ++c) {
      const uint32_t size = splitSize(t, c, halves);
      if (size == 0) continue;
      if (staysOpen(size)) {
        nextTasks[open++] = {first, size, node, chunk};
        chunk += kmeans::chunksOf(size, chunkSize);
        kidNodes[kid++] = node++;
      } else if (size > 1) {
        leafQueue[queued++] = {first, size, node};
        kidNodes[kid++] = node;
        node += size - 1;
      } else {
        kidNodes[kid++] = leafNodes + first;
      }
      first += size;
    }
    level.extraNodes[index] = node;
  }
};

/// Moves each box to its cluster's range, keeping the order within a cluster.
struct Reorder : Pass {
  UnitBox* next;  ///< For tasks of the next pass.
  UnitBox* done;  ///< For what this phase has finished with.
  template <class Lanes>
  HD void operator()(Lanes& lanes, uint32_t index) const {
    Workspace& w = *static_cast<Workspace*>(lanes.shared());
    const Chunk chunk(*this, index);
    const Task& t = chunk.of;
    const bool halves = undivided(t);
    const uint32_t start = counts[countAt(t, 0, 0)];
    share(lanes, settings.k, [&](uint32_t c) {
      w.cursors[c] = t.first + counts[countAt(t, c, chunk.local)] - start;
      w.candidate[c] = staysOpen(splitSize(t, c, halves));
    });
    lanes.sync();
    for (uint32_t base = 0; base < chunk.part.count; base += Lanes::size) {
      const uint32_t i = base + lanes.lane();
      const bool valid = i < chunk.part.count;
      const uint32_t cluster = valid ? chunk.part.cluster[i] : 0;
      uint32_t place = takePlace(lanes, w.cursors, cluster, valid);
      if (!valid) continue;
      if (halves) place = t.first + chunk.part.first + i;
      const uint32_t target = halves ? chunk.part.first + i >= t.count / 2 : cluster;
      (w.candidate[target] ? next : done)[place] = chunk.part.boxes[i];
    }
  }
};
static_assert(maxDraws >= maxK);

}  // namespace copse::kmeans
