// Triangles cut by axis-aligned planes, in double precision on the host: for measures and checks that ask how much of a
// triangle lies in a box.
#pragma once

#include <algorithm>
#include <cmath>

#include "builder/primitives/host_triangles.h"

namespace copse::metrics {

struct Point {
  double at[3];
};

inline Point cross(const Point& a, const Point& b) {
  return {{a.at[1] * b.at[2] - a.at[2] * b.at[1], a.at[2] * b.at[0] - a.at[0] * b.at[2],
           a.at[0] * b.at[1] - a.at[1] * b.at[0]}};
}

inline Point difference(const Point& a, const Point& b) {
  return {{a.at[0] - b.at[0], a.at[1] - b.at[1], a.at[2] - b.at[2]}};
}

/// A triangle and what is left of it. It stays convex, and of the edges that cuts make no three are parallel: it has at
/// most nine corners, however often it is cut.
class Polygon {
 public:
  explicit Polygon(const Point corners[3]) { std::copy(corners, corners + 3, points_); }

  double area() const {
    Point sum{};
    for (int i = 2; i < count_; ++i) {
      const Point c = cross(difference(points_[i - 1], points_[0]), difference(points_[i], points_[0]));
      for (int axis = 0; axis < 3; ++axis) sum.at[axis] += c.at[axis];
    }
    return std::hypot(sum.at[0], sum.at[1], sum.at[2]) / 2;
  }

  /// Whether a corner lies on the side of `plane` that `sign` says, and not in the plane.
  bool reaches(int axis, double plane, double sign) const {
    return std::any_of(points_, points_ + count_, [&](const Point& p) { return sign * (p.at[axis] - plane) > 0; });
  }

  /// Sutherland and Hodgman 1974: keeps what is on the side of `plane` that `sign` says, the plane included.
  void clip(int axis, double plane, double sign) {
    Point kept[capacity];
    int count = 0;
    for (int i = 0; i < count_; ++i) {
      const Point &from = points_[i], &to = points_[i + 1 < count_ ? i + 1 : 0];
      const double a = sign * (from.at[axis] - plane), b = sign * (to.at[axis] - plane);
      if (a >= 0 && count < capacity) kept[count++] = from;
      if (((a < 0 && b > 0) || (a > 0 && b < 0)) && count < capacity) {
        Point between;
        for (int k = 0; k < 3; ++k) between.at[k] = from.at[k] + (to.at[k] - from.at[k]) * (a / (a - b));
        between.at[axis] = plane;
        kept[count++] = between;
      }
    }
    std::copy(kept, kept + count, points_);
    count_ = count;
  }

 private:
  static constexpr int capacity = 16;  // Rounding may leave a corner twice.
  Point points_[capacity];
  int count_ = 3;
};

struct Triangle {
  Point corners[3];
  Box box;          ///< Around the corners that are numbers.
  double area = 0;  ///< 0 where a corner is not finite.
};

inline Triangle triangleOf(const HostTriangles& host, uint32_t id) {
  Triangle triangle;
  for (int c = 0; c < 3; ++c) {
    const vec3 p = host.positions[host.indices[id][c]];
    triangle.corners[c] = {{p.x, p.y, p.z}};
    triangle.box.grow(p);
  }
  const double area = Polygon(triangle.corners).area();
  triangle.area = std::isfinite(area) ? area : 0;
  return triangle;
}

/// Whether two boxes have a point in common, borders included.
inline bool overlap(const Box& a, const Box& b) {
  for (int axis = 0; axis < 3; ++axis)
    if (!(a.lo[axis] <= b.hi[axis] && b.lo[axis] <= a.hi[axis])) return false;
  return true;
}

}  // namespace copse::metrics
