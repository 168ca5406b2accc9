// Choosing: indices by weight with Walker's alias method, directions by the cosine of a Lambertian surface.
// Picking reads one entry, however many there are; the table is built on the host in O(n).
#pragma once

#include <cmath>
#include <span>
#include <vector>

#include "builder/math/random.h"
#include "builder/math/vec.h"

namespace copse {

inline constexpr float pi = 3.14159265358979f;

/// `probability` is this entry's over the whole table; entries of weight 0 are never picked.
struct AliasCell {
  float threshold;  ///< Below it this entry is picked, from it on `alias`.
  uint32_t alias;
  float probability;
};

/// One cell per weight. Empty where no weight is positive; a weight that is not finite or negative counts as 0.
std::vector<AliasCell> aliasTable(std::span<const double> weights);

/// `bits` are 64 random bits. n > 0.
HD inline uint32_t pick(const AliasCell* cells, uint32_t n, uint64_t bits) {
  const uint32_t i = uniformIndex(highWord(bits), n);
  return unitFloat(lowWord(bits)) < cells[i].threshold ? i : cells[i].alias;
}

/// A direction about the unit vector `n` with density cos/π; `cosine` is the cosine, always positive.
/// The frame is Duff and others', "Building an Orthonormal Basis, Revisited", 2017.
HD inline vec3 cosineDirection(const vec3& n, uint64_t bits, float& cosine) {
  const float u = unitFloat(highWord(bits));
  const float angle = 2 * pi * unitFloat(lowWord(bits));
  const float radius = sqrtf(u);
  cosine = sqrtf(1 - u);
  const float x = radius * cosf(angle), y = radius * sinf(angle);
  const float sign = n.z < 0 ? -1.0f : 1.0f;
  const float a = -1 / (sign + n.z);
  const float b = n.x * n.y * a;
  const vec3 tangent(1 + sign * n.x * n.x * a, sign * b, -sign * n.x);
  const vec3 bitangent(b, sign + n.y * n.y * a, -n.y);
  return tangent * x + bitangent * y + n * cosine;
}

HD inline float largest(const vec3& v) {
  const float xy = v.x > v.y ? v.x : v.y;
  return xy > v.z ? xy : v.z;
}

/// Rec. 709 luminance.
HD inline double luminance(const vec3& v) { return 0.2126 * v.x + 0.7152 * v.y + 0.0722 * v.z; }

}  // namespace copse
