// The inner loops of the sweep: areas of growing sets of boxes, and the split of minimum cost along one axis.
// A box is eight lanes, its low corner and its negated high corner, so that one minimum unites two boxes.
#pragma once

#include <cstdint>
#include <limits>

#include "builder/math/box.h"
#include "builder/math/simd.h"
#include "builder/parallel/platform.h"

namespace copse::sweep::inline COPSE_ISA {

struct SignedBox {
  F32x8 lanes{F32x4(FLT_MAX, FLT_MAX, FLT_MAX, 0), F32x4(FLT_MAX, FLT_MAX, FLT_MAX, 0)};

  SignedBox() = default;
  explicit SignedBox(const Box& b) : lanes(F32x4(b.lo.x, b.lo.y, b.lo.z, 0), F32x4(-b.hi.x, -b.hi.y, -b.hi.z, 0)) {}

  void grow(const SignedBox& b) { lanes = minOf(b.lanes, lanes); }
  Box box() const {
    Box b;
    b.lo = {lanes[0], lanes[1], lanes[2]};
    b.hi = {-lanes[4], -lanes[5], -lanes[6]};
    return b;
  }
  float centre2(int axis) const { return lanes[axis] - lanes[4 + axis]; }
  /// Half the surface area. The extents come out negative and their products do not.
  float halfArea() const {
    const F32x4 d = lanes.lower() + lanes.upper();
    const F32x4 faces = d * d.shuffle<1, 2, 0, 3>();
    return faces[0] + faces[1] + faces[2];
  }
};

/// A split of the range into [begin, at) and [at, end) of the order along `axis`. Ties go to the more even split, then
/// to the lower axis and place, so that which axis was looked at first does not matter.
struct Split {
  float cost = std::numeric_limits<float>::infinity();  ///< Σ half area × count of the two sides.
  uint32_t unevenness = ~0u;
  int axis = 3;
  uint32_t at = 0;

  bool found() const { return axis < 3; }
  bool operator<(const Split& other) const {
    if (cost != other.cost) return cost < other.cost;
    if (unevenness != other.unevenness) return unevenness < other.unevenness;
    return axis != other.axis ? axis < other.axis : at < other.at;
  }
};

inline Split splitAt(float cost, uint32_t begin, uint32_t at, uint32_t end, int axis) {
  const uint32_t left = at - begin, right = end - at;
  return {cost, left > right ? left - right : right - left, axis, at};
}

inline void improve(Split& best, float cost, uint32_t begin, uint32_t at, uint32_t end, int axis) {
  if (cost > best.cost) return;
  const Split split = splitAt(cost, begin, at, end, axis);
  if (split < best) best = split;
}

/// Places in an order between the request for a box, which lies anywhere, and its use.
constexpr uint32_t prefetchDistance = 16;

/// Asks for the boxes to come of a sweep upwards that is at `i`, or downwards.
inline void prefetchUp(const SignedBox* boxes, const uint32_t* order, uint32_t i, uint32_t end) {
  if (end - i > prefetchDistance) prefetch(boxes + order[i + prefetchDistance]);
}
inline void prefetchDown(const SignedBox* boxes, const uint32_t* order, uint32_t begin, uint32_t i) {
  if (i - begin >= prefetchDistance) prefetch(boxes + order[i - prefetchDistance]);
}

/// Improves `best` by splits along `axis`. A side that costs more than the best so far ends its loop: it only grows.
inline void sweepAxis(const SignedBox* boxes, const uint32_t* order, uint32_t begin, uint32_t end, int axis,
                      float* rightCost, Split& best) {
  uint32_t firstUseful = begin + 1;
  SignedBox right;
  for (uint32_t i = end - 1; i > begin; --i) {
    prefetchDown(boxes, order, begin, i);
    right.grow(boxes[order[i]]);
    const float cost = right.halfArea() * static_cast<float>(end - i);
    if (cost > best.cost) {
      firstUseful = i + 1;
      break;
    }
    rightCost[i] = cost;
  }
  SignedBox left;
  for (uint32_t i = begin + 1; i < firstUseful; ++i) {
    prefetchUp(boxes, order, i, end);
    left.grow(boxes[order[i - 1]]);
  }
  for (uint32_t i = firstUseful; i < end; ++i) {
    prefetchUp(boxes, order, i, end);
    left.grow(boxes[order[i - 1]]);
    const float cost = left.halfArea() * static_cast<float>(i - begin);
    if (cost > best.cost) break;
    improve(best, cost + rightCost[i], begin, i, end, axis);
  }
}

/// The costs of the right sides [i, end) alone, and of the left sides [begin, i): what sweepAxis does in two loops that
/// may run at the same time.
inline void sweepRight(const SignedBox* boxes, const uint32_t* order, uint32_t begin, uint32_t end, float* cost) {
  SignedBox side;
  for (uint32_t i = end - 1; i > begin; --i) {
    prefetchDown(boxes, order, begin, i);
    side.grow(boxes[order[i]]);
    cost[i] = side.halfArea() * static_cast<float>(end - i);
  }
}
inline void sweepLeft(const SignedBox* boxes, const uint32_t* order, uint32_t begin, uint32_t end, float* cost) {
  SignedBox side;
  for (uint32_t i = begin + 1; i < end; ++i) {
    prefetchUp(boxes, order, i, end);
    side.grow(boxes[order[i - 1]]);
    cost[i] = side.halfArea() * static_cast<float>(i - begin);
  }
}

}  // namespace copse::sweep::inline COPSE_ISA
