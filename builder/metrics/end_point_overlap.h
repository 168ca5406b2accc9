// The end-point overlap of a tree: Aila, Karras and Laine, On Quality Metrics of Bounding Volume Hierarchies (2013).
// A ray that starts or ends on a triangle visits every node around that point, and for those that the triangle does not
// belong to this is work that the surface area heuristic does not see.
#pragma once

#include "builder/build.h"

namespace copse {

/// Σ over nodes C · A(triangles outside the node's subtree, clipped to its box) / A(all triangles), with
/// sah.traversal for C of an inner node, sah.intersection times its triangles for a leaf, and 0 for a joint. The box is
/// closed: a floor is inside of what stands on it. A triangle that is in several leaves belongs to the nodes above
/// each. 0 where nothing has an area; a triangle that is not finite has none. Boxes must contain those below them, as
/// validate() checks. On the host from a copy, in double precision, and the same on any number of threads. Each
/// triangle walks down from the root into every box that it is in: some microseconds per triangle, more where boxes
/// overlap much.
double endPointOverlap(const Device& device, const Bvh& bvh, const TrianglesView& triangles,
                       const Parameters& parameters);

}  // namespace copse
