// The second step of a run: a tree over the loaded triangles, as rays read it, and its cost in time and memory.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "tracer/accel/tracers.h"
#include "tracer/session/record.h"

namespace copse {

/// A tree as rays read it, and its cost in time and memory.
struct BuiltTree {
  TreeSource source;
  std::optional<Parameters> parameters;  ///< The builder's preset applied; none for a tracer's own tree.
  OptimiserNames optimisers;             ///< Those requested in addition to the builder's own.
  Bvh bvh;                               ///< Empty for a tracer's own tree.
  std::unique_ptr<const TreeTracer> tracer;
  double ms = 0;
  std::vector<PhaseTime> phases;
  uint64_t peakBytes = 0;  ///< Peak device memory, beyond what was in use before the build.
  /// treeRecord() of an equal tree, if known: computing it takes longer than most builds.
  std::optional<TreeRecord> known;
};

/// `chosen` over the builder's preset over the defaults; `optimisers` run after the builder's own. A tracer's own tree
/// takes no parameters and no optimisers. Throws InputError where the tracer cannot trace what is built, or runs on the
/// CPU only and `device` is a GPU.
BuiltTree buildTree(const Device& device, const TrianglesView& triangles, const TreeSource& source,
                    const Parameters& chosen, const OptimiserNames& optimisers = {}, const TracerChoice& choice = {});

TreeRecord treeRecord(const Device& device, const BuiltTree& tree);

/// endPointOverlap() of the tree over the triangles that it was built from; none for a tracer's own tree. Not timed.
std::optional<double> endPointOverlapOf(const Device& device, const TrianglesView& triangles, const BuiltTree& tree);

/// Writes builder, tracer, parameters, tree, times and memory into `record`.
void describe(const Device& device, const BuiltTree& tree, RunRecord& record);

}  // namespace copse
