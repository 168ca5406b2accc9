// Polygons in the plane into triangles, by clipping ears.
#pragma once

#include <vector>

#include "builder/math/vec.h"

namespace copse {

/// Appends n - 2 triangles of indices into `corners` (n >= 3, finite, counter-clockwise around most of the area). They
/// cover a simple polygon exactly once, and one that touches itself as well: with doubled corners, spikes, runs along a
/// line, and holes joined by bridges. Triangles of no area stand for what has none. About O(n log n).
/// False where the polygon crosses itself, if only by rounding, and the triangles overlap or leave it by as much as
/// they must; the work is bounded then.
bool clipEars(std::vector<glm::dvec2> corners, std::vector<uvec3>& triangles);

}  // namespace copse
