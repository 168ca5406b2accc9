// The clusters that a pass of the k-means builder finds, for pictures of them: the builder's own passes, watched.
#pragma once

#include <vector>

#include "builder/bvh.h"
#include "builder/parameters.h"
#include "builder/registry.h"

namespace copse {

/// The nodes of the k-ary tree at a depth, and above it those that are not split by k-means with k clusters any more.
struct KmeansClusters {
  Buffer<uint32_t> clusterOf;        ///< Per triangle; clusters are numbered in the order of their place in the tree.
  std::vector<Box> representatives;  ///< Per cluster, in the scene's unit: what its triangles were last held against.
  uint32_t level = 0;                ///< Passes that were run: fewer than asked for where the tree has no more.
};

/// After pass `level` > 0 of a build of `input` with `parameters`, which hold the builder's preset already. Where there
/// are fewer than kmeans.m kmeans.k triangles there is no pass and one cluster, whose box is the scene's.
KmeansClusters kmeansClusters(const Device& device, const BuildInput& input, const Parameters& parameters,
                              uint32_t level);

namespace kmeans {

struct Pass;
struct UnitBox;

class PassWatch {
 public:
  virtual ~PassWatch() = default;
  /// After each pass: `pass` as it ended, and the boxes in their new places, in `open` those of the next pass's tasks
  /// and in `done` all others so far. All of it in the device's memory. False where no further pass is wanted.
  virtual bool pass(const Device& device, const Pass& pass, const UnitBox* open, const UnitBox* done) = 0;
};

}  // namespace kmeans

}  // namespace copse
