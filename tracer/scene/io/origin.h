// Where a scene is counted from, so that floats hold it. Coordinates of the files, in double, may be far from their
// zero compared with the scene's size, as those of maps are: a float at 4.6 million steps by a half. Such a scene is
// moved to its middle before it is rounded.
#pragma once

#include <span>

#include "tracer/scene/scene.h"

namespace copse {

/// A scene is far away where its middle is more sizes away than this, the size being its largest extent. Nearer ones
/// stay where they are and lose at most 5 of a float's 24 bits.
inline constexpr double farFrom = 16;

/// 0, or for what is far away the middle of its bounds, to whole powers of two no larger than its size: so coordinates
/// that floats hold are moved without rounding. Positions that are not finite do not count.
glm::dvec3 originOf(std::span<const glm::dvec3> positions);

/// Moves the scene to originOf() its positions and rounds them; quads and views move along, and views keep what
/// rounding takes from them.
void moveToOrigin(Scene& scene);

/// Once the scene's views are complete: rounds them, but for those from far away, whose rays start near the scene.
void finishViews(Scene& scene);

}  // namespace copse
