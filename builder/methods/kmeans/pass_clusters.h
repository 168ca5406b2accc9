// The clusters that a pass of the k-means builder finds, for pictures of them: the builder's own passes, watched.
#pragma once

#include "builder/method.h"

namespace copse::kmeans {

/// After pass `level` > 0 of a build of `input` with `parameters`, which hold the builder's preset already. Where there
/// are fewer than kmeans.m kmeans.k triangles there is no pass and one cluster, whose box is the scene's.
PassClusters passClusters(const Device& device, const Primitives& input, const Parameters& parameters, uint32_t level);

struct Pass;
struct UnitBox;

class PassWatch {
 public:
  virtual ~PassWatch() = default;
  /// After each pass: `pass` as it ended, and the boxes in their new places, in `open` those of the next pass's tasks
  /// and in `done` all others so far. All of it in the device's memory. False where no further pass is wanted.
  virtual bool pass(const Device& device, const Pass& pass, const UnitBox* open, const UnitBox* done) = 0;
};

}  // namespace copse::kmeans
