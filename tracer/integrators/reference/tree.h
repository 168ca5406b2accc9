// The reference tracer's own intersection and its own tree: median splits, boxes and tests in double precision.
// Building takes O(n log² n) on one thread; it is meant to be obviously right, not quick.
#pragma once

#include <cstdint>
#include <vector>

#include <glm/vec3.hpp>

#include "tracer/scene/scene.h"

namespace copse {

struct ReferenceHit {
  double t = 0;             ///< In units of the direction's length.
  uint32_t triangle = 0;    ///< Into Scene::triangles.
  double b[3] = {0, 0, 0};  ///< Barycentric coordinates: they sum to 1.
};

class ReferenceTree {
 public:
  /// Keeps a reference to the scene. Triangles without area or with vertices that are not finite are left out.
  explicit ReferenceTree(const Scene& scene);

  /// The nearest hit with tMin < t < tMax; false for none.
  bool closest(const glm::dvec3& origin, const glm::dvec3& direction, double tMin, double tMax,
               ReferenceHit& hit) const {
    return trace(origin, direction, tMin, tMax, false, hit);
  }
  /// Whether there is any hit with tMin < t < tMax.
  bool occluded(const glm::dvec3& origin, const glm::dvec3& direction, double tMin, double tMax) const {
    ReferenceHit hit;
    return trace(origin, direction, tMin, tMax, true, hit);
  }
  /// Not a unit vector: its length is twice the triangle's area.
  glm::dvec3 normal(uint32_t triangle) const;
  glm::dvec3 vertex(uint32_t triangle, int corner) const {
    return scene_.positions[scene_.triangles[triangle][corner]];
  }

 private:
  struct Node {
    glm::dvec3 lo, hi;
    uint32_t first = 0, count = 0;  // A leaf's, into order_; an inner node has count 0,
    uint32_t right = 0;             // its left child follows it, and
    int axis = 0;                   // this is the axis that its children were split along.
  };

  uint32_t build(uint32_t first, uint32_t count);
  bool trace(const glm::dvec3& o, const glm::dvec3& d, double tMin, double tMax, bool any, ReferenceHit& hit) const;
  bool intersect(const glm::dvec3& o, const glm::dvec3& d, uint32_t triangle, ReferenceHit& hit) const;

  const Scene& scene_;
  std::vector<uint32_t> order_;
  std::vector<Node> nodes_;
};

}  // namespace copse
