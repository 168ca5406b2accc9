// The level of detail that a generator's parts share, and how it is found for a count of triangles.
#pragma once

#include <algorithm>
#include <cstdint>

#include "tracer/generators/mesh_builder.h"
#include "tracer/generators/random.h"

namespace copse::generator {

/// Segments grow with detail, triangles with its square.
struct Level {
  double detail;
  uint64_t seed;

  Random random(uint64_t part) const { return Random(seed, part); }
  /// Whether a thing is to be had at this detail: from about `from` on, each `id` from a detail of its own.
  bool fine(double from, uint64_t id) const { return detail > from * (0.7 + 0.6 * dither(id)); }
  /// Segments of one thing. Things of different `id` gain theirs at different detail, so the whole grows smoothly.
  uint32_t segments(double atOne, uint32_t min, uint64_t id) const {
    return std::max(min, static_cast<uint32_t>(atOne * detail + dither(id)));
  }
  /// How many of a thing: as many as `full` from detail 0.7 on, fewer on a coarse level.
  uint32_t repeats(uint32_t full, uint32_t min, uint64_t id) const {
    return std::clamp(static_cast<uint32_t>(full * detail / 0.7 + dither(id)), min, full);
  }

 private:
  static double dither(uint64_t id) { return static_cast<double>(mix(id) >> 11) * 0x1p-53; }
};

/// A detail that keeps count(detail) within `triangles`, near the greatest that does: counts hardly ever shrink as
/// detail grows.
template <typename Count>
double findDetail(uint64_t triangles, const Count& count, int steps = 30) {
  double lo = 0, hi = 1;
  while (hi < 1e4 && count(hi) <= triangles) hi *= 2;
  for (int i = 0; i < steps; ++i) {
    const double middle = 0.5 * (lo + hi);
    (count(middle) <= triangles ? lo : hi) = middle;
  }
  return lo;
}

}  // namespace copse::generator
