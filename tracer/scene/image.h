// Pixels in linear RGB: textures, skies and renders. Row 0 is the top.
#pragma once

#include <cstdint>
#include <vector>

#include "builder/math/vec.h"

namespace copse {

/// Files that claim more are refused.
inline constexpr int64_t maxImageSide = 65536, maxImagePixels = int64_t{1} << 28;

struct Image {
  int width = 0, height = 0;
  std::vector<vec3> pixels;  ///< width * height, row by row.

  vec3& at(int x, int y) { return pixels[static_cast<std::size_t>(y) * width + x]; }
  const vec3& at(int x, int y) const { return pixels[static_cast<std::size_t>(y) * width + x]; }
};

}  // namespace copse
