// Polygons with any number of corners into triangles.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "builder/math/vec.h"

namespace copse {

/// Appends n - 2 triangles of indices into `corners` (n >= 3), in the polygon's winding. In the plane across Newell's
/// normal they cover the polygon exactly once, be it concave, with doubled corners, spikes, runs along a line, or holes
/// joined by bridges. Linear where it is convex, else about O(n log n).
/// False where the polygon crosses itself there, so that no triangles are right. Any will do where it has no area or is
/// not finite.
bool triangulate(std::span<const vec3> corners, std::vector<uvec3>& triangles);

/// Says of a mesh's file how many of its faces `triangulate` could not cut rightly; nothing where `count` is 0.
void noteCrossingFaces(const std::string& file, std::size_t count, std::vector<std::string>& notes);

}  // namespace copse
