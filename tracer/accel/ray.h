// A ray and what it hits.
#pragma once

#include <cstdint>

#include "builder/math/vec.h"

namespace copse {

/// Looks for hits with tMin < t < tMax; the direction need not be a unit vector. Two 16-byte words.
struct alignas(16) Ray {
  vec3 origin;
  float tMin;
  vec3 direction;
  float tMax;
};

/// u and v weigh the second and third vertex: p = (1-u-v) v0 + u v1 + v v2.
struct alignas(16) Hit {
  static constexpr uint32_t none = 0xffffffffu;

  float t, u, v;
  uint32_t triangle;  ///< The scene's triangle, or none.
};

}  // namespace copse
