// Rays through wide nodes: a node's up to eight children are tested at once, and sorted without a branch. The box test
// is that of ray_box.h number for number, so the hit is the binary tree's bit for bit. A ray that would need more than
// the stack's 64 entries goes on through the binary tree by its nodes' parents.
#pragma once

#include "builder/math/sort8.h"
#include "tracer/accel/traverse_in_turn.h"

namespace copse::detail::inline COPSE_ISA {

/// A step of a Walk: a wide node.
class WideSteps {
 public:
  static constexpr uint32_t most = WideNode::width;

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
  HD uint32_t putAside(const TraversalView& view, const BoxRay&, uint32_t link, uint64_t* to) const {
    const WideNode& node = view.wideNodes[link];
    F32x8 enter(tMin_), leave(minusTMax_);  // `leave` is negative, so that both are maxima.
    for (int axis = 0; axis < 3; ++axis) {
      enter = maxOf((F32x8::load(node.planes[nearPlane_[axis]]) - F32x8(nearOrigin_[axis])) * F32x8(nearScale_[axis]),
                    enter);
      leave =
          maxOf((F32x8::load(node.planes[farPlane_[axis]]) - F32x8(farOrigin_[axis])) * F32x8(farScale_[axis]), leave);
    }
    const uint32_t bits = (enter + leave <= F32x8(0)).bits();
    if (any) {  // In any order; the largest child stands last, and then comes off first.
      uint64_t* top = to;
      for (uint32_t k = 0; k < WideNode::width; ++k) *top = node.child[k], top += bits >> k & 1;
    } else {
      storeDescending(enter, bits, node.child, to);
    }
    return popCount(bits);
  }

  HD static void prefetchNode(const TraversalView& view, uint32_t link) {
    const char* const node = reinterpret_cast<const char*>(view.wideNodes + link);
    for (uint32_t line = 0; line < sizeof(WideNode); line += 64) prefetch(node + line);
  }

 private:
  HD void set(uint32_t axis, const F32x8& o, const F32x8& s) {
    const uint32_t backward = s[0] < 0 ? 3 : 0;
    nearPlane_[axis] = axis + backward;
    farPlane_[axis] = axis + 3 - backward;
    nearOrigin_[axis] = o[0];
    farOrigin_[axis] = o[2];
    nearScale_[axis] = s[0];
    farScale_[axis] = s[2];
  }

  uint32_t nearPlane_[3], farPlane_[3];  // Rows of a WideNode.
  float nearOrigin_[3], farOrigin_[3], nearScale_[3], farScale_[3];
  float tMin_, minusTMax_;
};

/// As closestHit() and, for `any`, anyHit(), for a view with wide nodes.
template <bool any, class... Counter>
HD inline Hit traverseWide(const TraversalView& view, const Ray& ray, Counter... counter) {
  Walk<any, WideSteps> walk;
  walk.start(view, ray, emptyLink);
  while (walk.step(view, counter...)) {
  }
  return walk.best();
}

}  // namespace copse::detail::inline COPSE_ISA
