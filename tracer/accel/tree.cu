// Triangles gathered into the order of the leaves, each with its corners. O(n).
#include "tracer/accel/tree.h"

#include "builder/parallel/launch.h"

namespace copse {

namespace {

/// Writes the i-th triangle of the order. A triangle, and then its corners, may be anywhere in memory: the CPU
/// prefetches both long before it needs them.
struct WriteTriangles {
  const uint32_t* order;
  const uint8_t* isLast;
  uint32_t count;  ///< References.
  TrianglesView triangles;
  TraversalTriangle* out;

  static constexpr uint32_t indicesDistance = 64, cornersDistance = 32;

  HD void operator()(uint32_t i) const {
    if (i + indicesDistance < count) prefetch(triangles.indices + order[i + indicesDistance]);
    if (i + cornersDistance < count) {
      const uvec3 next = triangles.indices[order[i + cornersDistance]];
      prefetch(triangles.positions + next.x);
      prefetch(triangles.positions + next.y);
      prefetch(triangles.positions + next.z);
    }
    prefetchForStore(out + i + 16);
    const uint32_t id = order[i];
    const uvec3 t = triangles.indices[id];
    const vec3 a = triangles.positions[t.x], b = triangles.positions[t.y], c = triangles.positions[t.z];
    out[i] = {{a.x, b.x, c.x}, id, {a.y, b.y, c.y}, isLast[i], {a.z, b.z, c.z}, 0};
  }
};

}  // namespace

Buffer<TraversalTriangle> traversalTriangles(const Device& device, const Bvh& bvh, const TrianglesView& triangles,
                                             const uint8_t* isLast) {
  Buffer<TraversalTriangle> out(device, bvh.referenceCount);
  launch(device, "write triangles", bvh.referenceCount,
         WriteTriangles{bvh.order.data(), isLast, bvh.referenceCount, triangles, out.data()});
  return out;
}

}  // namespace copse
