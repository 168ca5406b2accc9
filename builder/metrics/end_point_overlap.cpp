// The nodes stand in preorder, each with the place after its subtree: a walk goes on to the next place or skips to that
// one, and which triangles belong to a node is a range of places.
#include "builder/metrics/end_point_overlap.h"

#include <algorithm>
#include <optional>
#include <span>

#include "builder/metrics/polygon.h"
#include "builder/metrics/sah_costs.h"

namespace copse {

namespace {

using metrics::Polygon;
using metrics::Triangle;

double areaInside(const Triangle& triangle, const Box& box) {
  Polygon polygon(triangle.corners);
  bool whole = true;
  for (int axis = 0; axis < 3; ++axis) {
    if (triangle.box.lo[axis] < box.lo[axis]) whole = false, polygon.clip(axis, box.lo[axis], 1);
    if (triangle.box.hi[axis] > box.hi[axis]) whole = false, polygon.clip(axis, box.hi[axis], -1);
  }
  return whole ? triangle.area : polygon.area();
}

/// A node at its place in preorder.
struct Place {
  Box box;
  uint32_t end;  ///< The place after its subtree.
  double cost;   ///< C of the sum.
};

/// Which leaves each triangle is in, by their places, where some triangle is in several.
class LeavesOfTriangles {
 public:
  LeavesOfTriangles(const std::vector<uint32_t>& order, const std::vector<uint32_t>& leafOf, uint32_t triangleCount)
      : first_(std::size_t{triangleCount} + 1, 0), firstPosition_(triangleCount), leaves_(order.size()) {
    for (const uint32_t triangle : order) ++first_[triangle + 1];
    for (std::size_t t = 0; t < triangleCount; ++t) first_[t + 1] += first_[t];
    std::vector<uint32_t> next(first_.begin(), first_.end() - 1);
    for (std::size_t i = 0; i < order.size(); ++i) {
      const uint32_t triangle = order[i];
      if (next[triangle] == first_[triangle]) firstPosition_[triangle] = static_cast<uint32_t>(i);
      leaves_[next[triangle]++] = leafOf[i];
    }
  }

  /// The first place in the order where the triangle stands.
  uint32_t firstPosition(uint32_t triangle) const { return firstPosition_[triangle]; }

  std::span<const uint32_t> of(uint32_t triangle) const {
    return {leaves_.data() + first_[triangle], leaves_.data() + first_[triangle + 1]};
  }

 private:
  std::vector<uint32_t> first_, firstPosition_, leaves_;
};

class Overlap {
 public:
  Overlap(const Bvh& bvh, const SahCosts& costs)
      : order_(bvh.order.toHost(bvh.referenceCount)), leafOf_(bvh.referenceCount) {
    const std::vector<BvhNode> nodes = bvh.nodes.toHost(bvh.nodeCount);
    const std::vector<uint8_t> joints = bvh.joints.toHost();
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
      const double cost = node.isLeaf() ? costs.intersection * node.count() : joint ? 0 : costs.traversal;
      places_.push_back({node.box(), place + 1, cost});
      if (node.isLeaf()) {
        std::fill_n(leafOf_.begin() + node.first(), node.count(), place);
      } else {
        waiting.push_back({node.right, place});
        waiting.push_back({node.left, place});
      }
    }
    for (std::size_t place = places_.size(); place-- > 1;)
      places_[parents[place]].end = std::max(places_[parents[place]].end, places_[place].end);
    if (bvh.referenceCount > bvh.triangleCount) leaves_.emplace(order_, leafOf_, bvh.triangleCount);
  }

  uint32_t triangleAt(std::size_t position) const { return order_[position]; }

  /// Whether `position` of the leaves' order has its triangle's first reference: each triangle counts once.
  bool isFirst(std::size_t position) const { return !leaves_ || leaves_->firstPosition(order_[position]) == position; }

  /// What the triangle at `position` of the leaves' order adds to the sum.
  double of(const Triangle& triangle, std::size_t position) const {
    const std::span<const uint32_t> own = leaves_ ? leaves_->of(order_[position]) : std::span(&leafOf_[position], 1);
    double sum = 0;
    for (uint32_t at = 0; at < places_.size();) {
      const Place& place = places_[at];
      if (isBelow(own, at, place.end)) {
        ++at;
        continue;
      }
      const double inside = metrics::overlap(triangle.box, place.box) ? areaInside(triangle, place.box) : 0;
      sum += place.cost * inside;
      at = inside > 0 ? at + 1 : place.end;
    }
    return sum;
  }

 private:
  /// Whether one of the triangle's leaves is in the subtree of places from `at` to before `end`.
  static bool isBelow(std::span<const uint32_t> leaves, uint32_t at, uint32_t end) {
    for (const uint32_t leaf : leaves)
      if (at <= leaf && leaf < end) return true;
    return false;
  }

  std::vector<Place> places_;
  std::vector<uint32_t> order_, leafOf_;
  std::optional<LeavesOfTriangles> leaves_;  ///< Where some triangle has several references.
};

}  // namespace

double endPointOverlap(const Device& device, const Bvh& bvh, const TrianglesView& triangles,
                       const Parameters& parameters) {
  if (bvh.nodeCount == 0) return 0;
  const HostTriangles host(device, triangles);
  const Overlap tree(bvh, sahCostsOf(parameters));

  // Runs of triangles are summed each by one thread, and then the runs in their order.
  constexpr int64_t run = 256;
  const int64_t count = bvh.referenceCount, runs = (count + run - 1) / run;
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
      if (!tree.isFirst(position)) continue;
      const Triangle triangle = metrics::triangleOf(host, tree.triangleAt(position));
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
