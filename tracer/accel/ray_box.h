// A ray against both children of a node: conservative slabs, so that no box is missed whose triangle is hit.
// Near planes are moved towards the ray and far planes away from it by a bound on the error of the triangle test, in
// position and in distance (after Ize 2013, and Woop, Benthin and Wald 2013).
#pragma once

#include <cfloat>

#include "builder/math/box.h"
#include "builder/math/simd8.h"
#include "tracer/accel/ray.h"
#include "tracer/accel/traversal_bvh.h"

namespace copse {

/// Which of a node's children a ray enters, and where.
struct BoxHits {
  uint32_t bits;  ///< Bit c: child c is hit. Bit 2: child 0 is entered no later than child 1.
  Float4 near;    ///< Lane c: where child c is entered, at least tMin.

  HD bool hit(uint32_t child) const { return bits >> child & 1; }
  HD bool firstIsNear() const { return bits & 4; }
  /// Where child `c` is entered, without an index, which would put `near` into memory on a GPU.
  HD float enter(bool c) const {
    float at[4];
    near.store(at);
    return c ? at[1] : at[0];
  }
};

/// What the slab test needs of a ray. An axis that the ray does not move along has slabs from -inf to inf while the
/// origin is between its planes; 0 * inf gives NaN there, and maxOf then keeps its other argument.
struct BoxRay {
  /// Relative: rounding of (plane - origin) / direction, six half-units, with ample room.
  static constexpr float distancePad = 1 + 4.0f / (1 << 20);
  /// Relative to the farthest point of the scene from the origin: what the triangle test can misplace an edge by.
  static constexpr float positionPad = 8 * FLT_EPSILON;

  Float8 originX, originY, originZ;  ///< As in a node after the exchange: near, near, far, far; twice.
  Float8 scaleX, scaleY, scaleZ;     ///< 1 / direction, negated and padded in the far lanes.
  PairSwap swapX, swapY, swapZ;      ///< Puts the near planes first.

  BoxRay() = default;
  HD BoxRay(const Ray& ray, float pad)
      : originX(origins(ray.origin.x, ray.direction.x, pad)),
        originY(origins(ray.origin.y, ray.direction.y, pad)),
        originZ(origins(ray.origin.z, ray.direction.z, pad)),
        scaleX(scales(ray.direction.x)),
        scaleY(scales(ray.direction.y)),
        scaleZ(scales(ray.direction.z)),
        swapX(backward(ray.direction.x)),
        swapY(backward(ray.direction.y)),
        swapZ(backward(ray.direction.z)) {}

  /// What edges may be misplaced by for a ray from `origin`; infinite or NaN where the origin is.
  HD static float padFor(const vec3& origin, const TraversalNode& root) {
    const float x = farthest(origin.x, root.x), y = farthest(origin.y, root.y), z = farthest(origin.z, root.z);
    return positionPad * maxOf(x, maxOf(y, z));
  }

  /// tMin, tMin, -tMax, -tMax.
  HD static Float4 limits(float tMin, float tMax) { return Float4::of(tMin, tMin, -tMax, -tMax); }

  HD BoxHits test(const TraversalNode& node, Float4 limits) const {
    const Float4 x = (swapX(Float4::load(node.x)) - originX.low()) * scaleX.low();
    const Float4 y = (swapY(Float4::load(node.y)) - originY.low()) * scaleY.low();
    const Float4 z = (swapZ(Float4::load(node.z)) - originZ.low()) * scaleZ.low();
    const Float4 p = negateHighHalf(maxOver(z, maxOver(y, maxOver(x, limits))));  // near0 near1 far0 far1
    return {lessEqual(lowHalves(p, p), shuffle<2, 3, 1, 0>(p)), p};
  }

  /// The four children of two nodes. Bits 0, 1 and 4, 5 of the result say which are hit, and near[0], near[1] and
  /// near[4], near[5] where.
  HD uint32_t testPair(const TraversalNode& a, const TraversalNode& b, Float8 limits, float near[8]) const {
    const Float8 x = (swapX(Float8::load(a.x, b.x)) - originX) * scaleX;
    const Float8 y = (swapY(Float8::load(a.y, b.y)) - originY) * scaleY;
    const Float8 z = (swapZ(Float8::load(a.z, b.z)) - originZ) * scaleZ;
    const Float8 p = maxOf(z, maxOf(y, maxOf(x, limits)));  // near0 near1 -far0 -far1 …
    p.store(near);
    return notAboveZero(p + exchangePairs(p)) & 0x33;
  }

 private:
  HD static bool backward(float direction) { return 1 / direction < 0; }  // True for -0.
  HD static Float8 origins(float origin, float direction, float pad) {
    const float shift = backward(direction) ? -pad : pad;
    return Float8::both(Float4::of(origin + shift, origin + shift, origin - shift, origin - shift));
  }
  HD static Float8 scales(float direction) {
    const float near = 1 / direction, far = -near * distancePad;
    return Float8::both(Float4::of(near, near, far, far));
  }
  HD static float farthest(float origin, const float planes[4]) {
    const float lo = minOf(planes[0], planes[1]), hi = maxOf(planes[2], planes[3]);
    return maxOf(origin - lo, hi - origin);
  }
};

}  // namespace copse
