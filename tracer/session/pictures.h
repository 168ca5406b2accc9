// Pictures of what the camera sees that are no light transport, run and timed as a render is: what surfaces are there,
// and what the passes of a builder made of them.
#pragma once

#include "builder/method.h"
#include "tracer/session/run.h"

namespace copse {

enum class SurfacePicture { normals, albedo, depth };

/// The image holds the buffer's numbers, depth in all three colours and 0 for a miss; the preview of normals and depth
/// is mapped to what a screen can show. Its own channels come with it, those of all three with `all`.
Rendered renderSurfacePicture(const Device& device, const LoadedScene& scene, const BuiltTree& tree, const View& view,
                              const RenderSettings& settings, SurfacePicture which, bool all, const Watch& watch = {});

/// Steps of camera rays as colours: sah.traversal a node and sah.intersection a triangle, 0 to
/// `most`, or to the largest mean of a pixel where `most` is 0. The counts are the channels `nodes` and `triangles`.
/// The tracer of `tree` says what rays visit.
Rendered renderHeatmap(const Device& device, const LoadedScene& scene, const BuiltTree& tree, const View& view,
                       const RenderSettings& settings, double most, const Watch& watch = {});

/// The clusters of a pass, and what it took to make them.
struct BuiltClusters {
  PassClusters clusters;
  double ms = 0;
};

/// `tree` was built of `triangles` by a builder whose method has passClusters.
BuiltClusters buildClusters(const Device& device, const TrianglesView& triangles, const BuiltTree& tree, int level);

/// The clusters' time is part of the build's.
Rendered renderClusterPicture(const Device& device, const LoadedScene& scene, const BuiltTree& tree,
                              const BuiltClusters& built, const View& view, const RenderSettings& settings,
                              const Watch& watch = {});

}  // namespace copse
