// Steps of a walk through wide nodes. A node's up to eight children are tested at once; the box test is that of
// ray_box.h number for number. A CPU tests four triangles at once, and one by itself, in ray_triangle.h, those that it
// may hit.
#pragma once

#include "builder/math/sort8.h"
#include "tracer/accel/walk.h"
#include "tracer/accel/wide8.h"

namespace copse::inline COPSE_ISA {

/// One bit for each triangle of a block that intersect() may accept: all but those that it rejects for an edge function
/// or, by a margin for rounding, for the distance. Edge functions are computed as there, to the bit; where one is 0,
/// and where a distance is small beside those of the corners, intersect() computes again in double and has to decide.
HD inline uint32_t mayHit(const TriangleRay& ray, float tMax, const TriangleBlock& block) {
  const float* const rows = &block.corners[0][0][0];
  const auto corner = [&](uint32_t row, uint32_t k) { return F32x4::loadAligned(rows + 3 * row + 4 * k); };
  const F32x4 originX(ray.origin[ray.rowX / 4]), originY(ray.origin[ray.rowY / 4]), originZ(ray.origin[ray.rowZ / 4]);
  F32x4 x[3], y[3], z[3];
  for (uint32_t k = 0; k < 3; ++k) {
    z[k] = corner(ray.rowZ, k) - originZ;
    x[k] = (corner(ray.rowX, k) - originX) - ray.shearX * z[k];
    y[k] = (corner(ray.rowY, k) - originY) - ray.shearY * z[k];
  }
  const F32x4 zero(0);
  const F32x4 edge[3] = {x[2] * y[1] - y[2] * x[1], x[0] * y[2] - y[0] * x[2], x[1] * y[0] - y[1] * x[0]};
  const auto below = (edge[0] < zero) | (edge[1] < zero) | (edge[2] < zero);
  const auto above = (zero < edge[0]) | (zero < edge[1]) | (zero < edge[2]);
  const uint32_t there = ~(U32x4::loadAligned(block.ids) == U32x4(TriangleBlock::nobody)).bits() & 15;
  const uint32_t hit = there & ~(below & above).bits();
  if (!hit) return 0;
  const auto absolute = [&](const F32x4& a) { return select(a < zero, -a, a); };
  const F32x4 sum = edge[0] + edge[1] + edge[2];
  F32x4 height[3];
  for (int k = 0; k < 3; ++k) height[k] = edge[k] * (z[k] * ray.scaleZ);
  const F32x4 distance = height[0] + height[1] + height[2];  // Times `sum`.
  const F32x4 towards = select(sum < zero, -distance, distance);
  const F32x4 limit = F32x4(tMax) * absolute(sum) * F32x4(1 + 1.0f / 65536) + F32x4(FLT_MIN);
  const uint32_t far = ((towards < zero) | (limit < towards)).bits();
  const F32x4 all = absolute(height[0]) + absolute(height[1]) + absolute(height[2]);
  const uint32_t cancels = (F32x4(15) * absolute(distance) < all).bits();
  const uint32_t onEdge = ((edge[0] == zero) | (edge[1] == zero) | (edge[2] == zero)).bits();
  return hit & (~far | cancels | onEdge);
}

/// As for the triangles of other formats, block by block.
template <bool any, class Filter, class... Counter>
HD inline bool intersectLeaf(const Wide8View& view, const TriangleRay& triangles, const BoxRay& boxes, float tMin,
                             uint32_t leaf, Hit& best, const Filter& accepts, Counter... counter) {
  for (const TriangleBlock* block = view.blocks + (leaf & ~leafBit);; ++block) {
    if constexpr (sizeof...(Counter) > 0)
      for (uint32_t k = 0; k < TriangleBlock::size; ++k)
        if (block->isThere(k)) (counter.triangle(), ...);
#if COPSE_DEVICE_CODE
    for (uint32_t k = 0; k < TriangleBlock::size && block->isThere(k); ++k) {
#else
    for (uint32_t bits = mayHit(triangles, best.t, *block); bits; bits &= bits - 1) {
      const uint32_t k = lowestBit(bits);
#endif
      if (intersect(triangles, boxes, tMin, block->triangle(k), best, accepts) && any) return true;
    }
    if (block->isLast()) return false;
  }
}

/// Visits one wide node.
class WideStep {
 public:
  using Format = Wide8;

  HD void start(const BoxRay& ray) {
    set(0, ray.originX, ray.scaleX);
    set(1, ray.originY, ray.scaleY);
    set(2, ray.originZ, ray.scaleZ);
  }
  HD void setLimits(float tMin, float tMax) {
    tMin_ = tMin;
    minusTMax_ = -tMax;
  }

  template <bool any>
  HD Next visit(const Wide8::View& view, const BoxRay&, float, float, uint32_t link, uint64_t* stack,
                uint32_t& depth) const {
    if (depth + Wide8::width > stackSize) return Next::tooDeep;
    const Wide8Node& node = view.nodes[link];
    F32x8 enter;
    const uint32_t bits = test(node, enter);
    if (any) {  // Any order will do; the largest child is last, and so is popped first.
      uint64_t* top = stack + depth;
      for (uint32_t k = 0; k < Wide8::width; ++k) *top = node.child[k], top += bits >> k & 1;
    } else {
      storeDescending(enter, bits, node.child, stack + depth);
    }
    depth += popCount(bits);
    return Next::stack;
  }

  HD uint32_t test(const Wide8::View& view, const BoxRay&, float, float, uint32_t link, float near[8]) const {
    F32x8 enter;
    const uint32_t bits = test(view.nodes[link], enter);
    enter.store(near);
    return bits;
  }

  HD static void prefetchNode(const Wide8::View& view, uint32_t link) {
    const char* const node = reinterpret_cast<const char*>(view.nodes + link);
    for (uint32_t line = 0; line < sizeof(Wide8Node); line += 64) prefetch(node + line);
  }
  HD static void prefetchLeaf(const Wide8::View& view, uint32_t link) {
    const char* const block = reinterpret_cast<const char*>(view.blocks + (link & ~leafBit));
    for (uint32_t line = 0; line < sizeof(TriangleBlock); line += 64) prefetch(block + line);
  }

 protected:
  HD uint32_t test(const Wide8Node& node, F32x8& enter) const {
    enter = F32x8(tMin_);
    F32x8 leave(minusTMax_);  // Negative, so that both are maxima.
    for (int axis = 0; axis < 3; ++axis) {
      enter = maxOf((F32x8::load(node.planes[nearPlane_[axis]]) - F32x8(nearOrigin_[axis])) * F32x8(nearScale_[axis]),
                    enter);
      leave =
          maxOf((F32x8::load(node.planes[farPlane_[axis]]) - F32x8(farOrigin_[axis])) * F32x8(farScale_[axis]), leave);
    }
    return (enter + leave <= F32x8(0)).bits();
  }

 private:
  HD void set(uint32_t axis, const F32x8& o, const F32x8& s) {
    const uint32_t backward = s[0] < 0 ? 1 : 0;
    nearPlane_[axis] = 2 * axis + backward;
    farPlane_[axis] = 2 * axis + 1 - backward;
    nearOrigin_[axis] = o[0];
    farOrigin_[axis] = o[2];
    nearScale_[axis] = s[0];
    farScale_[axis] = s[2];
  }

  uint32_t nearPlane_[3], farPlane_[3];  // Rows of a Wide8Node.
  float nearOrigin_[3], farOrigin_[3], nearScale_[3], farScale_[3];
  float tMin_, minusTMax_;
};

/// Visits one wide node with branches on how many children are hit: coherent rays make them predictable.
class SteadyWideStep : public WideStep {
 public:
  template <bool any>
  HD Next visit(const Wide8::View& view, const BoxRay&, float, float, uint32_t& link, uint64_t* stack,
                uint32_t& depth) const {
    const Wide8Node& node = view.nodes[link];
    F32x8 enter;
    const uint32_t bits = test(node, enter);
    if (bits == 0) return Next::stack;
    const uint32_t first = lowestBit(bits), others = bits & (bits - 1);
    if (others == 0) {
      link = node.child[first];
      return Next::child;
    }
    if (depth + Wide8::width > stackSize) return Next::tooDeep;
    if ((others & (others - 1)) == 0) {
      const uint32_t second = lowestBit(others);
      float near[8];
      enter.store(near);
      const bool secondIsNear = any || near[second] < near[first];  // The larger one for any hit.
      const uint32_t farther = secondIsNear ? first : second;
      stack[depth++] = stackEntry(node.child[farther], near[farther]);
      link = node.child[secondIsNear ? second : first];
      return Next::child;
    }
    if (any) {
      uint32_t last = first;
      for (uint32_t left = others; left; left &= left - 1) {
        stack[depth++] = node.child[last];
        last = lowestBit(left);
      }
      link = node.child[last];
      return Next::child;
    }
    storeDescending(enter, bits, node.child, stack + depth);
    depth += popCount(bits);
    return Next::stack;
  }
};

template <>
struct StepsOf<Wide8> {
  using ByNodes = WideStep;
  using InTurn = WideStep;
  using InARow = SteadyWideStep;
};

}  // namespace copse::inline COPSE_ISA
