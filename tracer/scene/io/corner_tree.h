// Corners of a polygon by place: a k-d tree (J. L. Bentley, 1975) that lies implicitly in one array, since each split
// is the median of its range. A search visits only what may lie in a triangle, so that a test for an ear need not look
// at every corner.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "tracer/scene/io/orientation.h"

namespace copse {

class CornerTree {
 public:
  static constexpr uint32_t none = ~0u;

  /// `corners` are indices into `points`, which must outlive the tree. O(n log n).
  void build(const glm::dvec2* points, std::vector<uint32_t> corners) {
    points_ = points;
    corners_ = std::move(corners);
    if (corners_.empty()) return;
    box_ = {points_[corners_[0]], points_[corners_[0]]};
    for (const uint32_t i : corners_) box_ = {glm::min(box_.lo, points_[i]), glm::max(box_.hi, points_[i])};
    split(0, corners_.size(), 0);
  }

  std::size_t size() const { return corners_.size(); }

  /// The first corner found for which `accepts(corner)`, or none. All that lie in the closed triangle a, b, c
  /// (counter-clockwise) are asked, and some beside it.
  template <class Accepts>
  uint32_t find(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c, const Accepts& accepts) const {
    const glm::dvec2 triangle[3] = {a, b, c};
    const Box bounds = {glm::min(glm::min(a, b), c), glm::max(glm::max(a, b), c)};
    return find(0, corners_.size(), 0, box_, triangle, bounds, accepts);
  }

 private:
  static constexpr std::size_t leaf = 12;
  struct Box {
    glm::dvec2 lo, hi;
  };

  void split(std::size_t first, std::size_t last, int axis) {
    if (last - first <= leaf) return;
    const std::size_t middle = (first + last) / 2;
    std::nth_element(corners_.begin() + first, corners_.begin() + middle, corners_.begin() + last,
                     [&](uint32_t i, uint32_t j) { return points_[i][axis] < points_[j][axis]; });
    split(first, middle, 1 - axis);
    split(middle + 1, last, 1 - axis);
  }

  static bool misses(const Box& box, const glm::dvec2* triangle, const Box& bounds) {
    if (box.lo.x > bounds.hi.x || box.lo.y > bounds.hi.y || box.hi.x < bounds.lo.x || box.hi.y < bounds.lo.y)
      return true;
    for (int k = 0; k < 3; ++k) {
      // The box's corner that lies farthest to the left of the edge.
      const glm::dvec2 from = triangle[k], to = triangle[(k + 1) % 3];
      if (orientation(from, to, {to.y > from.y ? box.lo.x : box.hi.x, to.x > from.x ? box.hi.y : box.lo.y}) < 0)
        return true;
    }
    return false;
  }

  template <class Accepts>
  uint32_t find(std::size_t first, std::size_t last, int axis, const Box& box, const glm::dvec2* triangle,
                const Box& bounds, const Accepts& accepts) const {
    if (last - first <= leaf) {
      for (std::size_t i = first; i < last; ++i)
        if (accepts(corners_[i])) return corners_[i];
      return none;
    }
    if (misses(box, triangle, bounds)) return none;
    const std::size_t middle = (first + last) / 2;
    if (accepts(corners_[middle])) return corners_[middle];
    Box below = box, above = box;
    below.hi[axis] = above.lo[axis] = points_[corners_[middle]][axis];
    const uint32_t found = find(first, middle, 1 - axis, below, triangle, bounds, accepts);
    return found != none ? found : find(middle + 1, last, 1 - axis, above, triangle, bounds, accepts);
  }

  const glm::dvec2* points_ = nullptr;
  std::vector<uint32_t> corners_;
  Box box_{};
};

}  // namespace copse
