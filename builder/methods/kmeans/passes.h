// The kernels of one pass: every open task of the k-ary tree is split into k clusters at once. Tasks own segments of
// the order, segments are cut into chunks, and a team takes a chunk: it keeps the representatives and its own sums in
// shared memory and adds these to the task's once. Meister and Bittner 2016, section 5, figure 3.
#pragma once

#include "builder/methods/kmeans/agglomerate.h"
#include "builder/methods/kmeans/refine.h"
#include "builder/parallel/atomics.h"

namespace copse::kmeans {

constexpr uint32_t chunkSize = 1024;

/// A node of the k-ary tree that is to be split.
struct Task {
  uint32_t first, count;  ///< Its segment of the order.
  uint32_t node;          ///< The binary node that will stand for it.
  uint32_t firstChunk;    ///< Chunks of all tasks are numbered through.
  HD uint32_t chunks() const { return (count + chunkSize - 1) / chunkSize; }
};

/// What a pass works on. Arrays with a row a task have k columns.
struct Pass {
  Settings settings;
  const UnitBox* boxes;
  const uint32_t* order;
  uint8_t* cluster;  ///< A place's cluster, after the last assignment.
  const Task* tasks;
  uint32_t taskCount, chunkCount;
  float* reps;       ///< Row: six coordinates of padded(k) representatives.
  Sums* sums;        ///< Row: k sums.
  uint32_t* counts;  ///< Before the scan: triangles by (task, cluster, chunk); after: places, counted over all tasks.

  HD uint32_t taskOf(uint32_t chunk) const {
    uint32_t low = 0, high = taskCount;
    while (high - low > 1) {
      const uint32_t middle = (low + high) / 2;
      (tasks[middle].firstChunk <= chunk ? low : high) = middle;
    }
    return low;
  }
  HD float* repsOf(uint32_t task) const { return reps + std::size_t{task} * 6 * padded(settings.k); }
  /// Column of (cluster, chunk of the task) in `counts`; cluster k is the next task's first.
  HD std::size_t countAt(const Task& task, uint32_t c, uint32_t chunk) const {
    return std::size_t{task.firstChunk} * settings.k + std::size_t{c} * task.chunks() + chunk;
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
  HD void loadReps(const Team& team, uint32_t task, Workspace& w) const {
    const uint32_t columns = padded(settings.k);
    const float* row = repsOf(task);
    team.forEach(6 * columns, [&](uint32_t j) { w.reps.at[j / columns][j % columns] = row[j]; });
  }
};

/// A team's part of a pass.
struct Chunk {
  uint32_t task, local, begin, count;
  Segment segment;
  HD Chunk(const Pass& pass, uint32_t index) {
    task = pass.taskOf(index);
    const Task& t = pass.tasks[task];
    local = index - t.firstChunk;
    begin = local * chunkSize;
    count = t.count - begin < chunkSize ? t.count - begin : chunkSize;
    segment = {pass.boxes, pass.order + t.first, t.count};
  }
};

struct DrawAll : Pass {
  HD void operator()(const Team& team, uint32_t index) const {
    Workspace& w = *static_cast<Workspace*>(team.shared());
    const Task& t = tasks[index];
    drawRepresentatives(team, settings, settings.k, {boxes, order + t.first, t.count}, t.node, w);
    const uint32_t columns = padded(settings.k);
    float* row = repsOf(index);
    team.forEach(6 * columns, [&](uint32_t j) { row[j] = w.reps.at[j / columns][j % columns]; });
  }
};

struct AssignAndSum : Pass {
  HD void operator()(const Team& team, uint32_t index) const {
    Workspace& w = *static_cast<Workspace*>(team.shared());
    const Chunk chunk(*this, index);
    loadReps(team, chunk.task, w);
    clearSums(team, settings.k, w);
    assignAndSum(team, settings.metric, settings.k, chunk.segment, chunk.begin, chunk.count, w);
    Sums* row = sums + std::size_t{chunk.task} * settings.k;
    team.forEach(settings.k, [&](uint32_t c) {
      if (w.sums[c].count == 0) return;
      for (uint32_t d = 0; d < 6; ++d) atomicAddRelaxed(&row[c].at[d], w.sums[c].at[d]);
      atomicAddRelaxed(&row[c].count, w.sums[c].count);
    });
  }
};

struct Normalise : Pass {
  HD void operator()(uint32_t index) const {
    const uint32_t task = index / settings.k, c = index % settings.k;
    const double scale = fixedScale(tasks[task].count);
    for (uint32_t d = 0; d < 6; ++d) {
      float& at = repsOf(task)[d * padded(settings.k) + c];
      at = meanOf(sums[index], d, scale, at);
    }
  }
};

struct ClusterSizes : Pass {
  HD void operator()(const Team& team, uint32_t index) const {
    Workspace& w = *static_cast<Workspace*>(team.shared());
    const Chunk chunk(*this, index);
    const Task& t = tasks[chunk.task];
    loadReps(team, chunk.task, w);
    team.forEach(settings.k, [&](uint32_t c) { w.cursors[c] = 0; });
    team.forEach(chunk.count, [&](uint32_t j) {
      const uint32_t i = chunk.begin + j;
      const uint32_t c = clusterOf(settings.metric, chunk.segment[i], w.reps, settings.k, i, t.count);
      cluster[t.first + i] = static_cast<uint8_t>(c);
      Team::add(&w.cursors[c], 1u);
    });
    team.forEach(settings.k, [&](uint32_t c) { counts[countAt(t, c, chunk.local)] = w.cursors[c]; });
  }
};

/// What a task's clusters become, as numbers to be scanned and then as places.
struct Children {
  uint32_t* kids;        ///< Clusters that are not empty.
  uint32_t* open;        ///< … of these, tasks of the next pass,
  uint32_t* queued;      ///< … and tasks of the leaf queue.
  uint32_t* nodes;       ///< Inner nodes of the binary tree that this task allocates.
  uint32_t* openChunks;  ///< Chunks of the next pass's tasks.
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
        chunks += (size + chunkSize - 1) / chunkSize;
      } else if (size > 1) {
        ++queued;
        nodes += size - 1;
      }
    }
    out.kids[index] = kids;
    out.open[index] = open;
    out.queued[index] = queued;
    out.nodes[index] = nodes + open + kids - 2;  // The treelet of `kids` children has its root already.
    out.openChunks[index] = chunks;
  }
};

/// Writes the next pass's tasks, the leaf queue, and each task's children for the agglomeration.
struct CreateTasks : Pass {
  Children at;         ///< After the scans.
  uint32_t nodeBase;   ///< The first binary node that this pass allocates.
  uint32_t queueBase;  ///< The leaf queue's length before this pass.
  uint32_t leafNodes;
  Task* nextTasks;
  LeafTask* leafQueue;
  uint32_t* kidNodes;    ///< Row a task, packed: binary nodes of the children.
  uint32_t* extraNodes;  ///< A task: the first of its treelet's inner nodes but the root.

  HD void operator()(uint32_t index) const {
    const Task& t = tasks[index];
    const bool halves = undivided(t);
    uint32_t node = nodeBase + at.nodes[index], first = t.first, kid = at.kids[index];
    uint32_t open = at.open[index], queued = queueBase + at.queued[index], chunk = at.openChunks[index];
    for (uint32_t c = 0; c < settings.k; ++c) {
      const uint32_t size = splitSize(t, c, halves);
      if (size == 0) continue;
      if (staysOpen(size)) {
        nextTasks[open] = {first, size, node, chunk};
        chunk += nextTasks[open++].chunks();
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
    extraNodes[index] = node;
  }
};

/// Moves each place to its cluster's range, keeping the order within a cluster.
struct Reorder : Pass {
  uint32_t* nextOrder;  ///< For tasks of the next pass.
  uint32_t* doneOrder;  ///< For what this phase has finished with.
  HD void operator()(const Team& team, uint32_t index) const {
    Workspace& w = *static_cast<Workspace*>(team.shared());
    const Chunk chunk(*this, index);
    const Task& t = tasks[chunk.task];
    const bool halves = undivided(t);
    const uint32_t start = counts[countAt(t, 0, 0)];
    team.forEach(settings.k, [&](uint32_t c) {
      w.cursors[c] = t.first + counts[countAt(t, c, chunk.local)] - start;
      w.candidate[c] = staysOpen(splitSize(t, c, halves));
    });
    const uint32_t half = t.count / 2;
    if (halves) {
      team.forEach(chunk.count, [&](uint32_t j) {
        const uint32_t i = chunk.begin + j;
        (w.candidate[i >= half] ? nextOrder : doneOrder)[t.first + i] = chunk.segment.order[i];
      });
      return;
    }
    team.partition(
        chunk.count, w.cursors, [&](uint32_t j) { return uint32_t{cluster[t.first + chunk.begin + j]}; },
        [&](uint32_t j, uint32_t place) {
          const uint32_t c = cluster[t.first + chunk.begin + j];
          (w.candidate[c] ? nextOrder : doneOrder)[place] = chunk.segment.order[chunk.begin + j];
        });
  }
};
static_assert(maxDraws >= maxK);

/// Turns a task's children into a treelet of binary nodes.
struct AgglomerateAll {
  const Task* tasks;
  const uint32_t* firstKid;
  uint32_t taskCount, kidCount;
  const uint32_t* kidNodes;
  const uint32_t* extraNodes;
  BvhNode* nodes;

  HD void operator()(uint32_t index) const {
    Agglomeration clusters;
    const uint32_t end = index + 1 < taskCount ? firstKid[index + 1] : kidCount;
    for (uint32_t kid = firstKid[index]; kid < end; ++kid) clusters.add(kidNodes[kid], nodes[kidNodes[kid]].box());
    clusters.run(nodes, tasks[index].node, extraNodes[index]);
  }
};

}  // namespace copse::kmeans
