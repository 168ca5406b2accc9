// Surface nets (Gibson 1998): a closed mesh of near-uniform quads around the zero set of a distance field, as a
// scanner's merged range images give. Only blocks that the surface can reach are sampled: O(area / cell²) samples.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>

#include "builder/math/vec.h"

namespace copse::generator {

using glm::dvec3;

/// A closed surface where the distance is 0, negative inside.
class DistanceField {
 public:
  virtual ~DistanceField() = default;
  virtual double distance(const dvec3& p) const = 0;
  /// At least how much faster than length the distance changes anywhere.
  virtual double steepness() const = 0;
  /// The surface lies well within these.
  virtual dvec3 lowest() const = 0;
  virtual dvec3 highest() const = 0;
};

struct QuadMesh {
  std::vector<vec3> positions;
  std::vector<std::array<uint32_t, 4>> quads;  ///< Corners anticlockwise seen from outside.
};

/// The surface on a grid of that cell size; the same on any number of threads.
QuadMesh surfaceNets(const DistanceField& field, double cell);

}  // namespace copse::generator
