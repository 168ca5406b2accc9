// Morton codes of points in a box: Morton 1966, as LBVH uses them. 20 bits an axis make the paper's 60-bit codes.
#pragma once

#include <cstdint>

#include "builder/math/box.h"

namespace copse {

/// Spreads the lowest 21 bits of `x` so that two zeros follow each.
HD inline uint64_t spreadBits(uint32_t x) {
  uint64_t v = x & 0x1fffffu;
  v = (v | v << 32) & 0x001f00000000ffffull;
  v = (v | v << 16) & 0x001f0000ff0000ffull;
  v = (v | v << 8) & 0x100f00f00f00f00full;
  v = (v | v << 4) & 0x10c30c30c30c30c3ull;
  v = (v | v << 2) & 0x1249249249249249ull;
  return v;
}

/// x's bits are the highest of each three.
HD inline uint64_t interleave(uint32_t x, uint32_t y, uint32_t z) {
  return spreadBits(x) << 2 | spreadBits(y) << 1 | spreadBits(z);
}

/// A grid of 2^bits cells an axis over a box. It works on twice the coordinates, as Box::centre2 gives them.
struct MortonGrid {
  vec3 origin2{0, 0, 0};
  vec3 scale{0, 0, 0};  ///< Cells per doubled length; 0 on an axis without extent.
  uint32_t last = 0;    ///< The highest cell of an axis.

  /// `cube`: one scale for all axes, that of the longest.
  static MortonGrid over(const Box& bounds, int bits, bool cube) {
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

  /// Written so that NaN falls into cell 0 and the upper border into the last cell.
  HD uint32_t cell(float at2, float from2, float cellsPer) const {
    const float x = (at2 - from2) * cellsPer;
    if (!(x > 0)) return 0;
    return x < static_cast<float>(last) ? static_cast<uint32_t>(x) : last;
  }
  HD uint64_t code(const vec3& centre2) const {
    return interleave(cell(centre2.x, origin2.x, scale.x), cell(centre2.y, origin2.y, scale.y),
                      cell(centre2.z, origin2.z, scale.z));
  }
};

}  // namespace copse
