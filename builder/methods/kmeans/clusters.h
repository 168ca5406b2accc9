// What k-means is made of here: boxes in the scene's unit, distances between them, draws, and sums that are exact.
// Meister and Bittner 2016, sections 4.1 and 5.
#pragma once

#include <cstdint>

#include "builder/math/box.h"
#include "builder/math/simd.h"
#include "builder/parallel/bits.h"

namespace copse::kmeans {

/// Distance between two boxes as points in R^6, or the area of their union.
enum class Metric : uint32_t { euclid, manhattan, chebyshev, unionArea };

constexpr uint32_t maxK = 64;
constexpr uint32_t maxDraws = 64;

struct Settings {
  uint32_t k, draws, iterations, seed;
  uint32_t leafQueueBelow;  ///< m k: segments of fewer triangles are refined with k = 2.
  Metric metric;
  uint32_t chunkSize;  ///< Triangles that a team takes in a pass; 0: by size. The tree does not depend on it.
  uint32_t arity = 2;  ///< 2: a binary tree. Otherwise k, and nodes that only join a node's k children are marked.
  bool plusPlus;       ///< Representatives are drawn as k-means++ does, and `draws` counts for nothing.
  bool onFibers;       ///< On the CPU, teams are 32 fibers, for tests.
};

/// A triangle's box in units of the scene's longest side, from its lower corner: all numbers lie in 0 … 1.
/// A representative is one too.
struct alignas(16) UnitBox {
  float lo[3];
  uint32_t id;  ///< The triangle.
  float hi[3];
  uint32_t pad;

  static constexpr uint32_t floats = 8;
  HD static constexpr uint32_t at(uint32_t d) { return d < 3 ? d : d + 1; }  ///< Where coordinate d of six stands.
  HD float operator[](uint32_t d) const { return d < 3 ? lo[d] : hi[d - 3]; }
  HD float& operator[](uint32_t d) { return d < 3 ? lo[d] : hi[d - 3]; }
  HD Box box() const {
    Box b;
    b.lo = {lo[0], lo[1], lo[2]};
    b.hi = {hi[0], hi[1], hi[2]};
    return b;
  }
};
static_assert(sizeof(UnitBox) == 4 * UnitBox::floats);

/// The boxes of a team's group: F is a lane's float, or F32x16 where one thread has the whole group.
template <class F>
struct BoxesOf {
  F lo[3], hi[3];
};

template <Metric metric, class F>
HD inline F distance(const BoxesOf<F>& b, const UnitBox& r) {
  if constexpr (metric == Metric::unionArea) {
    F side[3];
    for (int d = 0; d < 3; ++d) side[d] = maxOf(b.hi[d], F(r.hi[d])) - minOf(b.lo[d], F(r.lo[d]));
    return side[0] * side[1] + side[1] * side[2] + side[2] * side[0];
  } else {
    const F x = b.lo[0] - F(r.lo[0]), y = b.lo[1] - F(r.lo[1]), z = b.lo[2] - F(r.lo[2]);
    const F u = b.hi[0] - F(r.hi[0]), v = b.hi[1] - F(r.hi[1]), w = b.hi[2] - F(r.hi[2]);
    if constexpr (metric == Metric::euclid) {
      return (x * x + y * y + z * z) + (u * u + v * v + w * w);
    } else {
      const auto size = [](F a) { return maxOf(a, F(0) - a); };
      if constexpr (metric == Metric::manhattan)
        return (size(x) + size(y) + size(z)) + (size(u) + size(v) + size(w));
      else
        return maxOf(maxOf(maxOf(size(x), size(y)), size(z)), maxOf(maxOf(size(u), size(v)), size(w)));
    }
  }
}

/// The nearest of k > 0 representatives, the first of those that are equally near, and how far it is.
template <class F>
struct Nearest {
  F distance, index;
};

template <Metric metric, class F>
HD inline Nearest<F> nearestBy(const BoxesOf<F>& b, const UnitBox* representatives, uint32_t k) {
  Nearest<F> best{distance<metric>(b, representatives[0]), F(0)};
  for (uint32_t c = 1; c < k; ++c) {
    const F d = distance<metric>(b, representatives[c]);
    best.index = select(d < best.distance, F(static_cast<float>(c)), best.index);
    best.distance = minOf(d, best.distance);
  }
  return best;
}
template <class F>
HD inline Nearest<F> nearest(Metric metric, const BoxesOf<F>& b, const UnitBox* representatives, uint32_t k) {
  switch (metric) {
    case Metric::manhattan:
      return nearestBy<Metric::manhattan>(b, representatives, k);
    case Metric::chebyshev:
      return nearestBy<Metric::chebyshev>(b, representatives, k);
    case Metric::unionArea:
      return nearestBy<Metric::unionArea>(b, representatives, k);
    default:
      return nearestBy<Metric::euclid>(b, representatives, k);
  }
}

/// The paper's "simple linear congruential generator" (constants of Knuth and Lewis); the high bits are used. A segment
/// begins where its place and length say.
struct Draws {
  uint32_t state;
  HD Draws(uint32_t seed, uint32_t first, uint32_t count)
      : state(seed * 0x9e3779b9u ^ first * 0x85ebca6bu ^ count * 0xc2b2ae35u) {
    below(1);
    below(1);
  }
  HD uint32_t below(uint32_t n) {
    state = state * 1664525u + 1013904223u;
    return static_cast<uint32_t>((static_cast<uint64_t>(state) * n) >> 32);
  }
};

/// Sums over a cluster's boxes, laid out as a UnitBox with the number of boxes in the id's place, all times a scale.
/// They are whole numbers below 2^51 kept in doubles, so they are exact: their order and later subtractions do not
/// matter.
struct Sums {
  double at[8];

  static constexpr uint32_t weight = 3;
};

/// How many bits all numbers below `count` fit into.
HD inline uint32_t bitsBelow(uint32_t count) { return count > 1 ? 32 - leadingZeros(count - 1) : 0; }

/// The fixed point of a segment of `count` triangles: a power of two, such that no sum passes 2^50.
HD inline double fixedScale(uint32_t count) { return static_cast<double>(uint64_t{1} << (50 - bitsBelow(count))); }

/// sums[d] += sign × round(box[d] × scale), with one in the id's place.
HD inline void addBox(double* sums, const UnitBox& box, double scale, double sign) {
  const double magic = 6755399441055744.0;  // 1.5 × 2^52: what is added to it is rounded to a whole.
#if COPSE_DEVICE_CODE
  for (uint32_t d = 0; d < 6; ++d) {
    const double scaled = static_cast<double>(box[d]) * scale;
    sums[UnitBox::at(d)] += ((scaled + magic) - magic) * sign;
  }
  sums[Sums::weight] += scale * sign;
#else
  const F32x8 corners = F32x8::loadAligned(box.lo).shuffle<0, 1, 2, 7>(F32x8(1));
  const F64x8 whole = (toDouble(corners) * F64x8(scale) + F64x8(magic)) - F64x8(magic);
  (F64x8::load(sums) + whole * F64x8(sign)).store(sums);
#endif
}

/// Moves a representative to its cluster's mean; that of an empty cluster stays.
HD inline void moveToMean(UnitBox& representative, const double* sums) {
  if (!(sums[Sums::weight] > 0)) return;
  for (uint32_t d = 0; d < 6; ++d) representative[d] = static_cast<float>(sums[UnitBox::at(d)] / sums[Sums::weight]);
}

}  // namespace copse::kmeans
