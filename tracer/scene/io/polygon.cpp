// Ear clipping (G. H. Meisters, "Polygons have ears", 1975): a corner is cut off where it is convex and no other corner
// lies in its triangle. Only reflex corners need be tested.
#include "tracer/scene/io/polygon.h"

#include <cmath>
#include <cstdint>

namespace copse {
namespace {

using dvec2 = glm::dvec2;
using dvec3 = glm::dvec3;

double cross2(const dvec2& a, const dvec2& b, const dvec2& c) {
  return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

dvec3 newellNormal(std::span<const vec3> corners) {
  dvec3 normal(0);
  const dvec3 origin = corners[0];
  for (std::size_t i = 0; i < corners.size(); ++i)
    normal += glm::cross(dvec3(corners[i]) - origin, dvec3(corners[(i + 1) % corners.size()]) - origin);
  return normal;
}

/// Along the axis in which the normal is longest, so that the polygon keeps most of its area, counter-clockwise.
std::vector<dvec2> project(std::span<const vec3> corners, const dvec3& normal) {
  const dvec3 size = glm::abs(normal);
  const int axis = size.x > size.y && size.x > size.z ? 0 : size.y > size.z ? 1 : 2;
  const int u = (axis + 1) % 3, v = (axis + 2) % 3;
  const bool flip = normal[axis] < 0;
  std::vector<dvec2> flat;
  flat.reserve(corners.size());
  for (const vec3& p : corners) flat.push_back(flip ? dvec2(p[v], p[u]) : dvec2(p[u], p[v]));
  return flat;
}

class Clipper {
 public:
  Clipper(std::vector<dvec2> flat, std::vector<uvec3>& triangles)
      : flat_(std::move(flat)), triangles_(triangles), next_(flat_.size()), before_(flat_.size()) {
    const uint32_t n = static_cast<uint32_t>(flat_.size());
    for (uint32_t i = 0; i < n; ++i) next_[i] = (i + 1) % n, before_[i] = (i + n - 1) % n;
    for (uint32_t i = 0; i < n; ++i)
      if (corner(i) <= 0) reflex_.push_back(i);
  }

  void run() {
    uint32_t at = 0;
    std::size_t left = flat_.size(), misses = 0;
    while (left > 3) {
      // After a whole round without an ear the polygon is degenerate, and any corner is as good as another.
      if (reflex_.empty() || misses >= left || isEar(at)) {
        cut(at);
        --left;
        misses = 0;
      } else {
        ++misses;
      }
      at = next_[at];
    }
    triangles_.push_back({before_[at], at, next_[at]});
  }

 private:
  static constexpr std::size_t maxTests = 20'000'000;

  double corner(uint32_t i) const { return cross2(flat_[before_[i]], flat_[i], flat_[next_[i]]); }

  bool isEar(uint32_t i) {
    const dvec2 a = flat_[before_[i]], b = flat_[i], c = flat_[next_[i]];
    if (!(cross2(a, b, c) > 0)) return false;
    tests_ += reflex_.size();
    for (const uint32_t r : reflex_) {
      const dvec2 p = flat_[r];
      if (p == a || p == b || p == c) continue;  // Where a hole is joined by a bridge, corners come twice.
      if (cross2(a, b, p) >= 0 && cross2(b, c, p) >= 0 && cross2(c, a, p) >= 0) return false;
    }
    return true;
  }

  void cut(uint32_t i) {
    triangles_.push_back({before_[i], i, next_[i]});
    next_[before_[i]] = next_[i];
    before_[next_[i]] = before_[i];
    if (tests_ > maxTests) reflex_.clear();
    if (reflex_.empty()) return;
    tests_ += reflex_.size();
    // Cutting a corner can only make its neighbours convex.
    std::erase_if(reflex_, [&](uint32_t r) { return r == i || ((r == before_[i] || r == next_[i]) && corner(r) > 0); });
  }

  std::vector<dvec2> flat_;
  std::vector<uvec3>& triangles_;
  std::vector<uint32_t> next_, before_, reflex_;
  std::size_t tests_ = 0;
};

}  // namespace

void triangulate(std::span<const vec3> corners, std::vector<uvec3>& triangles) {
  const uint32_t n = static_cast<uint32_t>(corners.size());
  if (n == 3) {
    triangles.push_back({0, 1, 2});
    return;
  }
  const dvec3 normal = newellNormal(corners);
  const double length = glm::length(normal);
  if (!(length > 0) || !std::isfinite(length)) {
    for (uint32_t i = 2; i < n; ++i) triangles.push_back({0, i - 1, i});
    return;
  }
  if (n > 4) {
    Clipper(project(corners, normal), triangles).run();
    return;
  }
  // The diagonal that stays inside; if both do, the shorter.
  const auto side = [&](int a, int b, int c) {
    return glm::dot(glm::cross(dvec3(corners[b] - corners[a]), dvec3(corners[c] - corners[a])), normal);
  };
  const bool first = side(0, 1, 2) >= 0 && side(0, 2, 3) >= 0;
  const bool second = side(0, 1, 3) >= 0 && side(1, 2, 3) >= 0;
  const bool shorter = glm::distance(corners[0], corners[2]) <= glm::distance(corners[1], corners[3]);
  if (first && (!second || shorter)) {
    triangles.insert(triangles.end(), {{0, 1, 2}, {0, 2, 3}});
  } else {
    triangles.insert(triangles.end(), {{0, 1, 3}, {1, 2, 3}});
  }
}

}  // namespace copse
