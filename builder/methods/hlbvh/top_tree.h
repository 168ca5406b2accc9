// The top of an HLBVH: a binary tree over clusters of boxes that share the first bits of their Morton codes, split by
// the surface area heuristic between the cells of the clusters' own grid.
#pragma once

#include "builder/bvh.h"

namespace copse::hlbvh {

/// The grid has at most this many cells per axis.
constexpr uint32_t maxCells = 32;

/// Where a cluster is in the grid: eight bits per axis.
struct Cell {
  uint32_t packed;

  HD uint32_t operator[](int axis) const { return packed >> 8 * axis & 0xffu; }
};

/// Clusters in Morton order, in device memory. Their subtrees' inner nodes follow the top tree's count-1 inner nodes.
struct Clusters {
  const Cell* cells;       ///< No two are equal.
  const Box* boxes;        ///< Around the cluster's boxes.
  const uint32_t* starts;  ///< Cluster c has the sorted places starts[c] … starts[c+1]-1.
  const uint32_t* counted;
  uint32_t primitives;
  uint32_t maxCount;   ///< An upper bound; the host does not know their number.
  uint32_t count = 0;  ///< In kernels, after load().

  HD void load() { count = *counted; }
  HD uint32_t size(uint32_t c) const { return starts[c + 1] - starts[c]; }
  /// How many inner nodes come before cluster c's own.
  HD uint32_t innerBase(uint32_t c) const { return count - 1 + starts[c] - c; }
  /// The root of cluster c's subtree.
  HD uint32_t root(uint32_t c) const { return size(c) == 1 ? primitives - 1 + starts[c] : innerBase(c); }
};

/// Writes inner nodes 0 … count-2, level by level with the root first, and the parents of them and of the clusters'
/// roots but the tree's own root. `gridCells`: cells that a cluster may be in. Of its levels, O(gridCells^(1/3)), the
/// host waits for few; O(count × levels). `onFibers`: on the CPU teams are 32 fibers, for tests.
void buildTopTree(const Device& device, const Clusters& clusters, uint32_t gridCells, BvhNode* nodes, uint32_t* parents,
                  bool onFibers = false);

}  // namespace copse::hlbvh
