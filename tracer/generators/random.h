// Random numbers for generators: a counter run through an integer hash, so that a seed means the same scene with
// every compiler and library (the standard distributions do not promise that).
#pragma once

#include <cmath>
#include <cstdint>

#include <glm/vec3.hpp>

namespace copse::generator {

/// The finaliser of SplitMix64 (Steele, Lea, Flood 2014).
inline uint64_t mix(uint64_t x) {
  x += 0x9e3779b97f4a7c15ull;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ull;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebull;
  return x ^ (x >> 31);
}

/// One stream per part: what a part draws does not depend on how much the parts before it drew. Never two draws in one
/// expression or among one call's arguments: C++ leaves their order open, and compilers differ in it.
class Random {
 public:
  Random(uint64_t seed, uint64_t part) : state_(mix(seed ^ mix(part))) {}

  /// In [0, 1), 53 bits.
  double next() { return static_cast<double>(mix(state_++) >> 11) * 0x1p-53; }
  double between(double a, double b) { return a + (b - a) * next(); }
  /// In [0, count).
  uint32_t below(uint32_t count) { return static_cast<uint32_t>(next() * count); }

  /// Uniform on the unit sphere.
  glm::dvec3 direction() {
    const double y = between(-1, 1), phi = between(0, 6.283185307179586), r = std::sqrt(1 - y * y);
    return {r * std::cos(phi), y, r * std::sin(phi)};
  }

 private:
  uint64_t state_;
};

}  // namespace copse::generator
