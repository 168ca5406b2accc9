// The step of a walk through wide nodes: a node's up to eight children are tested at once, and sorted without a branch.
// The box test is that of ray_box.h number for number.
#pragma once

#include "builder/math/sort8.h"
#include "tracer/accel/walk.h"
#include "tracer/accel/wide8.h"

namespace copse::inline COPSE_ISA {

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

 private:
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

  HD void set(uint32_t axis, const F32x8& o, const F32x8& s) {
    const uint32_t backward = s[0] < 0 ? 3 : 0;
    nearPlane_[axis] = axis + backward;
    farPlane_[axis] = axis + 3 - backward;
    nearOrigin_[axis] = o[0];
    farOrigin_[axis] = o[2];
    nearScale_[axis] = s[0];
    farScale_[axis] = s[2];
  }

  uint32_t nearPlane_[3], farPlane_[3];  // Rows of a Wide8Node.
  float nearOrigin_[3], farOrigin_[3], nearScale_[3], farScale_[3];
  float tMin_, minusTMax_;
};

template <>
struct StepsOf<Wide8> {
  using ByNodes = WideStep;
  using InTurn = WideStep;
  using InARow = void;  // Rays in turn are faster, coherent or not.
};

}  // namespace copse::inline COPSE_ISA
