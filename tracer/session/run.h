// A run in three steps that each keep what they made: load a scene, build a tree, render a view. Whoever measures goes
// through here, so that a render by hand and a benchmark time the same things.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "tracer/accel/tracers.h"
#include "tracer/image/image_io.h"
#include "tracer/scene/scene.h"
#include "tracer/session/record.h"

namespace copse {

/// A scene with its textures, and its triangles in device memory.
struct LoadedScene {
  Scene scene;
  double ms = 0;  ///< Reading files, textures and the upload.

  TrianglesView triangles() const;
  const SceneOnDevice& forPaths() const { return *paths_; }

 private:
  friend LoadedScene loadForPaths(const Device&, const std::function<Scene()>&);
  friend LoadedScene loadForBuild(const Device&, const std::function<Scene()>&);
  std::shared_ptr<const SceneOnDevice> paths_;
  Buffer<vec3> positions_;
  Buffer<uvec3> indices_;
};

/// For renderTree, with textures. All throw InputError as loadScene does. `read` makes the scene, of a file or not.
LoadedScene loadForPaths(const Device& device, const std::function<Scene()>& read);
LoadedScene loadForPaths(const Device& device, const std::string& file);
/// For renderByReference: nothing is uploaded.
LoadedScene loadForReference(const std::string& file);
/// For buildTree alone: no textures are read.
LoadedScene loadForBuild(const Device& device, const std::function<Scene()>& read);
LoadedScene loadForBuild(const Device& device, const std::string& file);

/// A tree as rays read it, and what it took.
struct BuiltTree {
  TreeSource source;
  std::optional<Parameters> parameters;  ///< The builder's preset applied; none for a tracer's own tree.
  OptimiserNames optimisers;             ///< That were asked for beside the builder's own.
  Bvh bvh;                               ///< Empty for a tracer's own tree.
  std::unique_ptr<const TreeTracer> tracer;
  double ms = 0;
  std::vector<PhaseTime> phases;
  uint64_t peakBytes = 0;  ///< Most device memory at a time, beyond what was in use before the build.
  /// record(), where one has it from an equal tree: it takes longer than most builds.
  std::optional<TreeRecord> known;

  TreeRecord record(const Device& device) const;

  /// Writes builder, parameters, tree, times and memory into `record`.
  void describe(const Device& device, RunRecord& record) const;
};

/// `chosen` over the builder's preset over the defaults; `optimisers` run after the builder's own. A tracer's own tree
/// takes no parameters and no optimisers. Throws InputError where the tracer does not go with what is built, or runs on
/// the CPU alone and `device` is another.
BuiltTree buildTree(const Device& device, const TrianglesView& triangles, const TreeSource& source,
                    const Parameters& chosen, const OptimiserNames& optimisers = {}, const TracerChoice& choice = {});

struct Rendered {
  Image image;
  std::vector<Channel> channels;  ///< Further ones, for the EXR.
  Image preview;                  ///< For a screen, where the image itself is not; empty otherwise.
  RunRecord record;               ///< Without the image's file name, which only the writer knows.
};

/// The nodes and triangles that rays visit in the same render, which is done once more for it and slower; not timed.
/// None for a tracer that does not say, and where it was stopped before its end.
std::optional<TraversalRecord> countTraversal(const Device& device, const LoadedScene& scene, const BuiltTree& tree,
                                              const View& view, const RenderSettings& settings,
                                              const Watch& watch = {});

/// endPointOverlap() of the tree over the triangles that it was built from; none for a tracer's own tree. Not timed.
std::optional<double> endPointOverlapOf(const Device& device, const LoadedScene& scene, const BuiltTree& tree);

/// With `surfaces` the normals, albedo and depth of what the camera sees are further channels.
Rendered renderTree(const Device& device, const LoadedScene& scene, const BuiltTree& tree, const View& view,
                    const RenderSettings& settings, const Watch& watch = {}, bool surfaces = false);
/// On as many threads as `device`, which must be the CPU, has.
Rendered renderByReference(const Device& device, const LoadedScene& scene, const View& view,
                           const RenderSettings& settings, const Watch& watch = {});

/// N.X N.Y N.Z, albedo.R albedo.G albedo.B and Z.
std::vector<Channel> channelsOf(const SurfaceBuffers& surfaces);

/// The part of a record that is known before anything is built.
RunRecord recordOf(const Device& device, const LoadedScene& scene);

}  // namespace copse
