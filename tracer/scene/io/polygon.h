// Polygons with any number of corners into triangles.
#pragma once

#include <span>
#include <vector>

#include "builder/math/vec.h"

namespace copse {

/// Appends n - 2 triangles of indices into `corners` (n >= 3), in the polygon's winding. Concave ones by ear clipping
/// in the plane across Newell's normal; where the polygon has no area, crosses itself or is not finite, any triangles.
/// Linear where it is convex, usually quadratic otherwise; the work is bounded.
void triangulate(std::span<const vec3> corners, std::vector<uvec3>& triangles);

}  // namespace copse
