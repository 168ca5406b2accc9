// Axis-aligned boxes.
#pragma once

#include <cfloat>

#include "builder/math/vec.h"
#include "builder/parallel/platform.h"

namespace copse {

/// `a < b ? a : b`, which keeps b where a is NaN.
HD inline float minOf(float a, float b) { return a < b ? a : b; }
HD inline float maxOf(float a, float b) { return a > b ? a : b; }
HD inline vec3 minOf(const vec3& a, const vec3& b) { return {minOf(a.x, b.x), minOf(a.y, b.y), minOf(a.z, b.z)}; }
HD inline vec3 maxOf(const vec3& a, const vec3& b) { return {maxOf(a.x, b.x), maxOf(a.y, b.y), maxOf(a.z, b.z)}; }

/// Two 16-byte words; the padding is free for an index.
struct alignas(16) Box {
  vec3 lo{FLT_MAX, FLT_MAX, FLT_MAX};
  float padLo = 0;
  vec3 hi{-FLT_MAX, -FLT_MAX, -FLT_MAX};
  float padHi = 0;

  HD void grow(const vec3& p) {
    lo = minOf(p, lo);
    hi = maxOf(p, hi);
  }
  HD void grow(const Box& b) {
    lo = minOf(b.lo, lo);
    hi = maxOf(b.hi, hi);
  }
  /// Twice the centre, so that no rounding enters.
  HD vec3 centre2() const { return lo + hi; }
  HD bool empty() const { return !(lo.x <= hi.x && lo.y <= hi.y && lo.z <= hi.z); }
  /// Surface area; 0 for an empty box.
  HD float area() const {
    if (empty()) return 0;
    const vec3 d = hi - lo;
    return 2 * (d.x * d.y + d.y * d.z + d.z * d.x);
  }
};
static_assert(sizeof(Box) == 32);

/// Corners that are NaN, in either box, count for nothing.
HD inline Box unite(const Box& a, const Box& b) {
  Box both;
  both.grow(a);
  both.grow(b);
  return both;
}

/// The same as an operation for reductions.
struct UniteBoxes {
  HD Box operator()(const Box& a, const Box& b) const { return unite(a, b); }
};

}  // namespace copse
