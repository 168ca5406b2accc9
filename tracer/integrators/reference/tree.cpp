// Median splits along the longest axis of the centroids, and the ray-triangle test by signed volumes.
#include "tracer/integrators/reference/tree.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

namespace copse {

using glm::dvec3;

ReferenceTree::ReferenceTree(const Scene& scene) : scene_(scene) {
  for (uint32_t i = 0; i < scene.triangles.size(); ++i) {
    const double area2 = glm::length(normal(i));
    if (area2 > 0 && std::isfinite(area2)) order_.push_back(i);
  }
  if (order_.empty()) return;
  nodes_.reserve(order_.size());
  build(0, static_cast<uint32_t>(order_.size()));
}

dvec3 ReferenceTree::normal(uint32_t triangle) const {
  const dvec3 a = vertex(triangle, 0);
  return glm::cross(vertex(triangle, 1) - a, vertex(triangle, 2) - a);
}

uint32_t ReferenceTree::build(uint32_t first, uint32_t count) {
  const auto centroid3 = [&](uint32_t t, int axis) {
    return vertex(t, 0)[axis] + vertex(t, 1)[axis] + vertex(t, 2)[axis];
  };
  Node node;
  node.lo = dvec3(std::numeric_limits<double>::infinity());
  node.hi = -node.lo;
  dvec3 centroidLo = node.lo, centroidHi = node.hi;
  for (uint32_t i = first; i < first + count; ++i)
    for (int axis = 0; axis < 3; ++axis) {
      for (int corner = 0; corner < 3; ++corner) {
        node.lo[axis] = std::min(node.lo[axis], vertex(order_[i], corner)[axis]);
        node.hi[axis] = std::max(node.hi[axis], vertex(order_[i], corner)[axis]);
      }
      centroidLo[axis] = std::min(centroidLo[axis], centroid3(order_[i], axis));
      centroidHi[axis] = std::max(centroidHi[axis], centroid3(order_[i], axis));
    }
  for (int axis = 1; axis < 3; ++axis)
    if (centroidHi[axis] - centroidLo[axis] > centroidHi[node.axis] - centroidLo[node.axis]) node.axis = axis;

  const auto index = static_cast<uint32_t>(nodes_.size());
  nodes_.push_back(node);
  if (count <= 4) {
    nodes_[index].first = first;
    nodes_[index].count = count;
    return index;
  }
  const auto begin = order_.begin() + first;
  std::nth_element(begin, begin + count / 2, begin + count,
                   [&](uint32_t a, uint32_t b) { return centroid3(a, node.axis) < centroid3(b, node.axis); });
  build(first, count / 2);
  const uint32_t right = build(first + count / 2, count - count / 2);
  nodes_[index].right = right;
  return index;
}

// The volumes that the ray's direction spans with each edge have the same sign inside. Two triangles compute that of a
// shared edge with the same rounding and opposite signs, and 0 counts as inside, so no ray slips through an edge; one
// that meets a vertex to the last bit may, which no random direction does.
bool ReferenceTree::intersect(const dvec3& o, const dvec3& d, uint32_t triangle, ReferenceHit& hit) const {
  const dvec3 a = vertex(triangle, 0) - o, b = vertex(triangle, 1) - o, c = vertex(triangle, 2) - o;
  const double u = glm::dot(d, glm::cross(c, b)), v = glm::dot(d, glm::cross(a, c)), w = glm::dot(d, glm::cross(b, a));
  if ((u < 0 || v < 0 || w < 0) && (u > 0 || v > 0 || w > 0)) return false;
  const dvec3 n = normal(triangle);
  const double volume = u + v + w, slope = glm::dot(n, d);
  if (volume == 0 || slope == 0) return false;
  hit.t = glm::dot(n, a) / slope;
  hit.triangle = triangle;
  hit.b[0] = u / volume;
  hit.b[1] = v / volume;
  hit.b[2] = w / volume;
  return true;
}

bool ReferenceTree::trace(const dvec3& o, const dvec3& d, double tMin, double tMax, bool any, ReferenceHit& hit) const {
  if (nodes_.empty()) return false;
  bool found = false;
  uint32_t stack[64];  // The tree is balanced: 32 levels hold 2^32 triangles.
  int size = 0;
  stack[size++] = 0;
  while (size > 0) {
    const uint32_t index = stack[--size];
    const Node& node = nodes_[index];
    double near = tMin, far = tMax;
    for (int axis = 0; axis < 3; ++axis) {
      if (std::abs(d[axis]) < 1e-300) {
        if (o[axis] < node.lo[axis] || o[axis] > node.hi[axis]) far = -1;
        continue;
      }
      const double t0 = (node.lo[axis] - o[axis]) / d[axis], t1 = (node.hi[axis] - o[axis]) / d[axis];
      near = std::max(near, std::min(t0, t1));
      far = std::min(far, std::max(t0, t1) * (1 + 1e-14));  // More than the rounding of both.
    }
    if (!(near <= far)) continue;
    for (uint32_t i = node.first; i < node.first + node.count; ++i) {
      ReferenceHit candidate;
      if (!intersect(o, d, order_[i], candidate) || candidate.t <= tMin || candidate.t >= tMax) continue;
      found = true;
      if (any) return true;
      hit = candidate;
      tMax = candidate.t;
    }
    if (node.count > 0) continue;
    const bool rightFirst = d[node.axis] < 0;
    stack[size++] = rightFirst ? index + 1 : node.right;
    stack[size++] = rightFirst ? node.right : index + 1;
  }
  return found;
}

}  // namespace copse
