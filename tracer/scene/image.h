// Pixels in linear RGB: textures, skies and renders. Row 0 is the top.
#pragma once

#include <vector>

#include "builder/math/vec.h"

namespace copse {

struct Image {
  int width = 0, height = 0;
  std::vector<vec3> pixels;  ///< width * height, row by row.

  vec3& at(int x, int y) { return pixels[static_cast<std::size_t>(y) * width + x]; }
  const vec3& at(int x, int y) const { return pixels[static_cast<std::size_t>(y) * width + x]; }
};

}  // namespace copse
