// Building with the clock around it.
#include "tracer/session/build.h"

#include "builder/metrics/end_point_overlap.h"
#include "builder/parallel/device_facts.h"
#include "builder/parallel/timed.h"

namespace copse {

BuiltTree buildTree(const Device& device, const TrianglesView& triangles, const TreeSource& source,
                    const Parameters& chosen, const OptimiserNames& optimisers, const TracerChoice& choice) {
  BuiltTree tree;
  tree.source = source;
  tree.optimisers = optimisers;
  if (!source.isOwnTree()) tree.parameters = withPreset(source.builder(), chosen);
  const TracerEntry& entry = choice.resolve(device, source);
  std::unique_ptr<TreeTracer> tracer =
      entry.make(device, triangles, tree.parameters.value_or(Parameters()), source.ownTree());
  const uint64_t before = bytesInUse(device);
  startPeak(device);
  tree.ms = timed(device, tree.phases, [&](const Device& recording) {
    if (!source.isOwnTree())
      tree.bvh = buildBvh(recording, triangles, source.builder(), *tree.parameters, {optimisers});
    tracer->build(recording, tree.bvh, triangles);
  });
  const uint64_t peak = peakBytes(device);
  tree.peakBytes = (peak > before ? peak - before : 0) + tracer->foreignPeakBytes();
  tree.tracer = std::move(tracer);
  return tree;
}

TreeRecord treeRecord(const Device& device, const BuiltTree& tree) {
  TreeRecord record{{}, tree.tracer->bytes(), {}};
  record.wideCost = tree.tracer->wideCost(device);
  if (!tree.source.isOwnTree()) record.statistics = statistics(device, tree.bvh, *tree.parameters);
  return record;
}

std::optional<double> endPointOverlapOf(const Device& device, const TrianglesView& triangles, const BuiltTree& tree) {
  if (tree.source.isOwnTree()) return std::nullopt;
  return endPointOverlap(device, tree.bvh, triangles, *tree.parameters);
}

void describe(const Device& device, const BuiltTree& tree, RunRecord& record) {
  record.builder = tree.source.name();
  record.optimisers = tree.optimisers;
  record.tracer = tree.tracer->name();
  record.parameters = tree.parameters;
  record.tree = tree.known ? *tree.known : treeRecord(device, tree);
  record.buildMs = tree.ms;
  record.buildPhases = tree.phases;
  record.buildPeakBytes = tree.peakBytes;
}

}  // namespace copse
