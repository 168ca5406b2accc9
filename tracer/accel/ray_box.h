// A ray against both children of a node: conservative slabs, so that no box is missed whose triangle is hit.
// Near planes are moved towards the ray and far planes away from it by a bound on the error of the triangle test, in
// position and in distance (after Ize 2013, and Woop, Benthin and Wald 2013).
#pragma once

#include <cfloat>

#include "builder/math/box.h"
#include "builder/math/pair_swap.h"
#include "builder/math/simd.h"
#include "tracer/accel/binary.h"
#include "tracer/accel/ray.h"

namespace copse::inline COPSE_ISA {

/// Which of a node's children a ray enters, and where.
struct BoxHits {
  uint32_t bits;  ///< Bit c: child c is hit. Bit 2: child 0 is entered no later than child 1.
  F32x4 near;     ///< Lane c: where child c is entered, at least tMin.

  HD bool hit(uint32_t child) const { return bits >> child & 1; }
  HD bool firstIsNear() const { return bits & 4; }
  /// Where child `c` is entered, without an index, which would put `near` into memory on a GPU.
  HD float enter(bool c) const { return c ? near[1] : near[0]; }
};

/// What the slab test needs of a ray. An axis that the ray does not move along has slabs from -inf to inf while the
/// origin is between its planes; 0 * inf gives NaN there, and maxOf then keeps its other argument.
struct BoxRay {
  /// Relative: rounding of (plane - origin) / direction, six half-ulps, with ample room.
  static constexpr float distancePad = 1 + 4.0f / (1 << 20);
  /// Relative to the farthest point of the scene from the origin: what the triangle test can misplace an edge by.
  static constexpr float positionPad = 8 * FLT_EPSILON;

  F32x8 originX, originY, originZ;  ///< As in a node after the swap: near, near, far, far; twice.
  F32x8 scaleX, scaleY, scaleZ;     ///< 1 / direction, negated and padded in the far lanes.
  PairSwap swapX, swapY, swapZ;     ///< Puts the near planes first.

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

  /// By how much edges may be misplaced for a ray from `origin` in a tree of these bounds; infinite or NaN where the
  /// origin is.
  HD static float padFor(const vec3& origin, const Box& bounds) {
    const float x = maxOf(origin.x - bounds.lo.x, bounds.hi.x - origin.x);
    const float y = maxOf(origin.y - bounds.lo.y, bounds.hi.y - origin.y);
    const float z = maxOf(origin.z - bounds.lo.z, bounds.hi.z - origin.z);
    return positionPad * maxOf(x, maxOf(y, z));
  }

  /// tMin, tMin, -tMax, -tMax.
  HD static F32x4 limits(float tMin, float tMax) { return {tMin, tMin, -tMax, -tMax}; }
  HD static F32x8 limitsTwice(float tMin, float tMax) { return twice(limits(tMin, tMax)); }

  HD BoxHits test(const BinaryNode& node, F32x4 limits) const {
    const F32x4 x = (swapX(F32x4::loadAligned(node.x)) - originX.lower()) * scaleX.lower();
    const F32x4 y = (swapY(F32x4::loadAligned(node.y)) - originY.lower()) * scaleY.lower();
    const F32x4 z = (swapZ(F32x4::loadAligned(node.z)) - originZ.lower()) * scaleZ.lower();
    const F32x4 negated = maxNum(z, maxNum(y, maxNum(x, limits)));  // near0 near1 -far0 -far1
    const F32x4 p = negated.shuffle<0, 1, 6, 7>(-negated);
    return {(p.shuffle<0, 1, 0, 1>() <= p.shuffle<2, 3, 1, 0>()).bits(), p};
  }

  /// The four children of two nodes. Bits 0, 1 and 4, 5 of the result say which are hit, and near[0], near[1] and
  /// near[4], near[5] where.
  HD uint32_t testPair(const BinaryNode& a, const BinaryNode& b, const F32x8& limits, float near[8]) const {
    const F32x8 x = (swapX(pairOf(a.x, b.x)) - originX) * scaleX;
    const F32x8 y = (swapY(pairOf(a.y, b.y)) - originY) * scaleY;
    const F32x8 z = (swapZ(pairOf(a.z, b.z)) - originZ) * scaleZ;
    const F32x8 p = maxOf(z, maxOf(y, maxOf(x, limits)));  // near0 near1 -far0 -far1 …
    p.store(near);
    return (p + p.shuffle<2, 3, 0, 1>() <= F32x8(0)).bits() & 0x33;
  }

 private:
  HD static F32x8 twice(const F32x4& four) { return {four, four}; }
  HD static F32x8 pairOf(const float* a, const float* b) { return {F32x4::loadAligned(a), F32x4::loadAligned(b)}; }
  HD static bool backward(float direction) { return 1 / direction < 0; }  // True for -0.
  HD static F32x8 origins(float origin, float direction, float pad) {
    const float shift = backward(direction) ? -pad : pad;
    return twice({origin + shift, origin + shift, origin - shift, origin - shift});
  }
  HD static F32x8 scales(float direction) {
    const float near = 1 / direction, far = -near * distancePad;
    return twice({near, near, far, far});
  }
};

}  // namespace copse::inline COPSE_ISA
