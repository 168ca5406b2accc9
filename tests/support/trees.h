// Trees made without any builder, so that traversal is tested independently; and rays to trace through them.
#pragma once

#include <cstdint>
#include <vector>

#include "builder/bvh.h"
#include "tests/support/inputs.h"
#include "tracer/accel/ray.h"

namespace copse::test {

/// Split at the median of the widest axis of the centres; at most `leaf` triangles per leaf.
Bvh medianTree(const Device& device, const TestMesh& mesh, uint32_t leaf);

/// As deep as possible: every inner node has one leaf of one triangle, the last has two. Triangles in order of their
/// index, `first` one nearest to the root.
Bvh chainTree(const Device& device, const TestMesh& mesh);

/// One leaf with all triangles.
Bvh leafTree(const Device& device, const TestMesh& mesh);

/// From points in and around the mesh's box: towards points of triangles, towards anywhere, and along the axes.
std::vector<Ray> raysAround(const TestMesh& mesh, uint32_t count, uint32_t seed);

/// What each ray hits first, through `tree` as the renderer traces it.
std::vector<Hit> hitsOf(const Device& device, const Bvh& tree, const TestMesh& mesh, const std::vector<Ray>& rays);

}  // namespace copse::test
