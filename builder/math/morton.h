// Morton codes of points in a box: Morton 1966, as LBVH uses them. 20 bits per axis make the paper's 60-bit codes.
#pragma once

#include <cstdint>

#include "builder/math/box.h"
#include "builder/parallel/bits.h"

namespace copse {

/// x's bits are the highest of each three.
HD inline uint64_t interleave(uint32_t x, uint32_t y, uint32_t z) {
  return spreadThirds(x) << 2 | spreadThirds(y) << 1 | spreadThirds(z);
}

/// A grid of 2^bits cells per axis over a box. It works on twice the coordinates, as Box::centre2 gives them.
struct MortonGrid {
  vec3 origin2{0, 0, 0};
  vec3 scale{0, 0, 0};  ///< Cells per doubled length; 0 on an axis without extent.
  uint32_t last = 0;    ///< The highest cell on an axis.

  /// `cube`: one scale for all axes, that of the longest.
  HD static MortonGrid over(const Box& bounds, int bits, bool cube) {
    MortonGrid grid;
    grid.last = (1u << bits) - 1;
    if (bounds.empty()) return grid;
    grid.origin2 = bounds.lo + bounds.lo;
    vec3 extent = bounds.hi - bounds.lo;
    if (cube) extent = vec3(maxOf(extent.x, maxOf(extent.y, extent.z)));
    for (int axis = 0; axis < 3; ++axis)
      if (extent[axis] > 0) grid.scale[axis] = static_cast<float>(1u << bits) / (2 * extent[axis]);
    return grid;
  }

  /// NaN falls into cell 0 and the upper border into the last cell.
  HD uint32_t cell(float at2, float from2, float cellsPer) const {
    const float x = maxOf((at2 - from2) * cellsPer, 0.0f);
    return static_cast<uint32_t>(static_cast<int32_t>(minOf(x, static_cast<float>(last))));
  }
  HD uint64_t code(const vec3& centre2) const {
    return interleave(cell(centre2.x, origin2.x, scale.x), cell(centre2.y, origin2.y, scale.y),
                      cell(centre2.z, origin2.z, scale.z));
  }
};

}  // namespace copse
