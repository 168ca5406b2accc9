// The nodes stand in preorder, each with the place after its subtree: a walk goes on to the next place or skips to that
// one, and which triangles belong to a node is a range of places.
#include "builder/metrics/end_point_overlap.h"

#include <algorithm>
#include <cmath>

#include "builder/primitives/host_triangles.h"

namespace copse {

namespace {

struct Point {
  double at[3];
};

Point cross(const Point& a, const Point& b) {
  return {{a.at[1] * b.at[2] - a.at[2] * b.at[1], a.at[2] * b.at[0] - a.at[0] * b.at[2],
           a.at[0] * b.at[1] - a.at[1] * b.at[0]}};
}

Point difference(const Point& a, const Point& b) { return {{a.at[0] - b.at[0], a.at[1] - b.at[1], a.at[2] - b.at[2]}}; }

/// A triangle and what is left of it: each of a box's six planes adds at most one corner.
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

  /// Sutherland and Hodgman 1974: keeps what is on the side of `plane` that `sign` says, the plane included.
  void clip(int axis, double plane, double sign) {
    Point kept[9];
    int count = 0;
    for (int i = 0; i < count_; ++i) {
      const Point &from = points_[i], &to = points_[i + 1 < count_ ? i + 1 : 0];
      const double a = sign * (from.at[axis] - plane), b = sign * (to.at[axis] - plane);
      if (a >= 0) kept[count++] = from;
      if ((a < 0 && b > 0) || (a > 0 && b < 0)) {
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
  Point points_[9];
  int count_ = 3;
};

struct Triangle {
  Point corners[3];
  Box box;
  double area = 0;
};

double areaInside(const Triangle& triangle, const Box& box) {
  Polygon polygon(triangle.corners);
  bool whole = true;
  for (int axis = 0; axis < 3; ++axis) {
    if (triangle.box.lo[axis] < box.lo[axis]) whole = false, polygon.clip(axis, box.lo[axis], 1);
    if (triangle.box.hi[axis] > box.hi[axis]) whole = false, polygon.clip(axis, box.hi[axis], -1);
  }
  return whole ? triangle.area : polygon.area();
}

bool overlap(const Box& a, const Box& b) {
  for (int axis = 0; axis < 3; ++axis)
    if (!(a.lo[axis] <= b.hi[axis] && b.lo[axis] <= a.hi[axis])) return false;
  return true;
}

/// A node at its place in preorder.
struct Place {
  Box box;
  uint32_t end;  ///< The place after its subtree.
  double cost;   ///< C of the sum.
};

class Overlap {
 public:
  Overlap(const Bvh& bvh, const Parameters& parameters)
      : order_(bvh.order.toHost(bvh.primitiveCount)), leafOf_(bvh.primitiveCount) {
    const std::vector<BvhNode> nodes = bvh.nodes.toHost(bvh.nodeCount);
    const std::vector<uint8_t> joints = bvh.joints.toHost();
    const double inner = parameters.real("sah.traversal"), perTriangle = parameters.real("sah.intersection");
    struct Waiting {
      uint32_t node, parent;  ///< The parent by its place.
    };
    std::vector<uint32_t> parents;
    places_.reserve(nodes.size());
    for (std::vector<Waiting> waiting{{0, 0}}; !waiting.empty();) {
      const auto [at, parent] = waiting.back();
      waiting.pop_back();
      const BvhNode& node = nodes[at];
      const uint32_t place = static_cast<uint32_t>(places_.size());
      parents.push_back(parent);
      const bool joint = !joints.empty() && joints[at];
      places_.push_back({node.box(), place + 1, node.isLeaf() ? perTriangle * node.count() : joint ? 0 : inner});
      if (node.isLeaf()) {
        std::fill_n(leafOf_.begin() + node.first(), node.count(), place);
      } else {
        waiting.push_back({node.right, place});
        waiting.push_back({node.left, place});
      }
    }
    for (std::size_t place = places_.size(); place-- > 1;)
      places_[parents[place]].end = std::max(places_[parents[place]].end, places_[place].end);
  }

  uint32_t triangleAt(std::size_t position) const { return order_[position]; }

  /// What the triangle at `position` of the leaves' order adds to the sum.
  double of(const Triangle& triangle, std::size_t position) const {
    const uint32_t leaf = leafOf_[position];
    double sum = 0;
    for (uint32_t at = 0; at < places_.size();) {
      const Place& place = places_[at];
      if (at <= leaf && leaf < place.end) {  // Its own subtree.
        ++at;
        continue;
      }
      const double inside = overlap(triangle.box, place.box) ? areaInside(triangle, place.box) : 0;
      sum += place.cost * inside;
      at = inside > 0 ? at + 1 : place.end;
    }
    return sum;
  }

 private:
  std::vector<Place> places_;
  std::vector<uint32_t> order_, leafOf_;
};

Triangle triangleOf(const HostTriangles& host, uint32_t id) {
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

}  // namespace

double endPointOverlap(const Device& device, const Bvh& bvh, const TrianglesView& triangles,
                       const Parameters& parameters) {
  if (bvh.nodeCount == 0) return 0;
  const HostTriangles host(device, triangles);
  const Overlap tree(bvh, parameters);

  // Runs of triangles are summed each by one thread, and then the runs in their order.
  constexpr int64_t run = 256;
  const int64_t count = bvh.primitiveCount, runs = (count + run - 1) / run;
  struct Sum {
    double overlap = 0, area = 0;
  };
  std::vector<Sum> sums(static_cast<std::size_t>(runs));
  [[maybe_unused]] const int threads = device.isCuda() ? processorCount() : device.threads;
#pragma omp parallel for schedule(dynamic) num_threads(threads) if (runs > 1)
  for (int64_t r = 0; r < runs; ++r) {
    Sum sum;
    for (int64_t i = r * run; i < std::min(count, (r + 1) * run); ++i) {
      const std::size_t position = static_cast<std::size_t>(i);
      const Triangle triangle = triangleOf(host, tree.triangleAt(position));
      if (triangle.area > 0) sum.overlap += tree.of(triangle, position);
      sum.area += triangle.area;
    }
    sums[static_cast<std::size_t>(r)] = sum;
  }
  Sum all;
  for (const Sum& sum : sums) all.overlap += sum.overlap, all.area += sum.area;
  return all.area > 0 ? all.overlap / all.area : 0;
}

}  // namespace copse
