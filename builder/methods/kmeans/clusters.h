// What one run of k-means over a segment of triangles needs: distances between boxes, draws, nearest representatives,
// sums in fixed point. Meister and Bittner 2016, sections 4.1 and 5.
#pragma once

#include <cfloat>
#include <cstdint>

#include "builder/math/box.h"
#include "builder/parallel/platform.h"

namespace copse::kmeans {

/// Distance between two boxes as points in R^6, or the area of their union.
enum class Metric : uint32_t { euclid, manhattan, chebyshev, unionArea };

constexpr uint32_t maxK = 64;
constexpr uint32_t maxDraws = 64;

/// A triangle's box in units of the scene's longest side, from its lower corner: all numbers lie in 0 … 1.
struct alignas(16) UnitBox {
  float lo[3];
  uint32_t id;  ///< The triangle.
  float hi[3];
  float pad;

  HD float operator[](uint32_t d) const { return d < 3 ? lo[d] : hi[d - 3]; }
};
static_assert(sizeof(UnitBox) == 32);

/// The representatives of one segment in shared memory, a row a coordinate, so that eight distances are one vector.
struct Representatives {
  float at[6][maxK];
};

/// The paper's "simple linear congruential generator" (constants of Knuth and Lewis); the high bits are used.
struct Draws {
  uint32_t state;
  HD explicit Draws(uint32_t seed, uint32_t segment) : state(seed * 0x9e3779b9u ^ segment * 0x85ebca6bu) {
    below(1);
    below(1);
  }
  HD uint32_t below(uint32_t n) {
    state = state * 1664525u + 1013904223u;
    return static_cast<uint32_t>((static_cast<uint64_t>(state) * n) >> 32);
  }
};

HD inline float absolute(float x) { return x < 0 ? -x : x; }

/// Distances from `b` to representatives c … c+7.
HD inline void distances8(Metric metric, const UnitBox& b, const Representatives& r, uint32_t c, float* out) {
  if (metric == Metric::euclid) {
    for (uint32_t j = 0; j < 8; ++j) {
      const float x = b.lo[0] - r.at[0][c + j], y = b.lo[1] - r.at[1][c + j], z = b.lo[2] - r.at[2][c + j];
      const float u = b.hi[0] - r.at[3][c + j], v = b.hi[1] - r.at[4][c + j], w = b.hi[2] - r.at[5][c + j];
      out[j] = x * x + y * y + z * z + (u * u + v * v + w * w);
    }
  } else if (metric == Metric::unionArea) {
    for (uint32_t j = 0; j < 8; ++j) {
      float side[3];
      for (uint32_t d = 0; d < 3; ++d) side[d] = maxOf(b.hi[d], r.at[d + 3][c + j]) - minOf(b.lo[d], r.at[d][c + j]);
      out[j] = side[0] * side[1] + side[1] * side[2] + side[2] * side[0];
    }
  } else {
    for (uint32_t j = 0; j < 8; ++j) {
      float sum = 0, most = 0;
      for (uint32_t d = 0; d < 6; ++d) {
        const float e = absolute(b[d] - r.at[d][c + j]);
        sum += e;
        most = maxOf(e, most);
      }
      out[j] = metric == Metric::manhattan ? sum : most;
    }
  }
}

/// The nearest of the first k representatives, the first of those that are equally near; k may be any number up to
/// maxK. `allEqual` tells whether all are.
HD inline uint32_t nearest(Metric metric, const UnitBox& b, const Representatives& r, uint32_t k, float& distance,
                           bool& allEqual) {
  float best = FLT_MAX;
  uint32_t found = 0, ties = 0;
  for (uint32_t c = 0; c < k; c += 8) {
    float d[8];
    distances8(metric, b, r, c, d);
    const uint32_t end = k - c < 8 ? k - c : 8;
    for (uint32_t j = 0; j < end; ++j) {
      ties += d[j] == best;
      if (d[j] < best) {
        best = d[j];
        found = c + j;
        ties = 1;
      }
    }
  }
  distance = best;
  allEqual = ties == k;
  return found;
}

/// The cluster of triangle i of a segment of n. Where all representatives are equally near, a run of the segment goes
/// to each: so at least two clusters get members when all boxes are the same.
HD inline uint32_t clusterOf(Metric metric, const UnitBox& b, const Representatives& r, uint32_t k, uint32_t i,
                             uint32_t n) {
  float distance;
  bool allEqual;
  const uint32_t c = nearest(metric, b, r, k, distance, allEqual);
  return allEqual ? static_cast<uint32_t>(uint64_t{i} * k / n) : c;
}

/// Sums over a cluster's boxes, as integers, so that they do not depend on the order of the additions.
struct Sums {
  uint64_t at[6];
  uint64_t count;
};

/// Coordinates are multiplied by the largest integer over the number of triangles in the segment: no sum overflows.
HD inline double fixedScale(uint32_t count) { return 4611686018427387904.0 / count; }
HD inline uint64_t toFixed(float x, double scale) {
  return static_cast<uint64_t>(static_cast<int64_t>(static_cast<double>(maxOf(0.0f, minOf(x, 1.0f))) * scale));
}

}  // namespace copse::kmeans
