// Which side of a line a point lies on, decided without rounding: what the triangulation of polygons stands on.
#pragma once

#include <glm/vec2.hpp>

namespace copse {

/// Twice the signed area of the triangle a, b, c: above 0 where it runs counter-clockwise, and 0 only where the three
/// lie on one line. The sign is exact (J. R. Shewchuk, "Adaptive precision floating-point arithmetic", 1997), the
/// magnitude is rounded. Coordinates are finite; their products must neither overflow nor underflow, so any floats do.
double orientation(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c);

}  // namespace copse
