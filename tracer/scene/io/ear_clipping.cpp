// Ear clipping (G. H. Meisters, "Polygons have ears", 1975): a corner is cut off where it is convex and nothing of the
// polygon lies in its triangle. A simple polygon always has such a corner with no other on the triangle's border
// either, and only reflex corners need be tested. Where that leads to a triangle that runs clockwise the polygon
// touches itself. Then all begins anew: spikes are cut off first and whenever one comes to be, and other corners may
// touch the border of an ear as long as no edge leads from there into it.
// A k-d tree finds what is in a triangle. A corner that is no ear waits for the one that was found in its triangle.
#include "tracer/scene/io/ear_clipping.h"

#include <cmath>
#include <cstdint>

#include "tracer/scene/io/corner_tree.h"
#include "tracer/scene/io/index_set.h"
#include "tracer/scene/io/orientation.h"

namespace copse {
namespace {

using dvec2 = glm::dvec2;
constexpr uint32_t none = ~0u;

class Clipper {
 public:
  Clipper(std::vector<dvec2> points, std::vector<uvec3>& triangles)
      : points_(std::move(points)),
        triangles_(triangles),
        first_(triangles.size()),
        corners_(points_.size()),
        candidates_(static_cast<uint32_t>(points_.size())) {}

  bool run() {
    if (clipSimple()) return true;
    triangles_.resize(first_);
    clipTouching();
    return !crosses_;
  }

 private:
  static constexpr std::size_t maxWork = 20'000'000;  // Corners looked at in a polygon that crosses itself: a second.

  struct Corner {
    uint32_t next, before;
    uint32_t waiting;  ///< The first of those that wait for this corner, in waits_.
    bool reflex;       ///< Or straight, or a spike.
    bool isLeft;
  };
  struct Wait {
    uint32_t corner, next;
  };

  const dvec2& before(uint32_t i) const { return points_[corners_[i].before]; }
  const dvec2& next(uint32_t i) const { return points_[corners_[i].next]; }
  double turn(uint32_t i) const { return orientation(before(i), points_[i], next(i)); }

  void begin(bool touching) {
    const uint32_t n = static_cast<uint32_t>(points_.size());
    touching_ = touching;
    left_ = n;
    reflexLeft_ = 0;
    waits_.clear();
    for (uint32_t i = 0; i < n; ++i) corners_[i] = {(i + 1) % n, (i + n - 1) % n, none, false, true};
    for (uint32_t i = 0; i < n; ++i) reflexLeft_ += corners_[i].reflex = turn(i) <= 0;
    allAreCandidates();
    plantTree();
  }

  /// False where a triangle runs clockwise. Where none does they cover what the outline winds around.
  bool clipSimple() {
    begin(false);
    uint32_t at = 0, candidate = 0;
    while (left_ > 3) {
      if (reflexLeft_ > 0) {
        candidate = nextCandidate(candidate);
        if (candidate != none && !isEar(candidate)) {
          candidates_.erase(candidate);
          continue;
        }
        if (candidate != none) at = candidate;
      }
      if (turn(at) < 0) return false;
      cut(at);
      candidate = at = corners_[at].next;
    }
    finish(at);
    return turn(at) >= 0;
  }

  void clipTouching() {
    begin(true);
    uint32_t at = cutAll(0, [&](uint32_t i) { return isSpike(i); });
    while (left_ > 3) {
      const uint32_t candidate = nextCandidate(at);
      if (candidate == none) {
        at = help(at);
      } else if (isEar(candidate)) {
        at = cutWithSpikes(candidate);
      } else {
        candidates_.erase(at = candidate);
      }
    }
    finish(at);
  }

  void finish(uint32_t at) { triangles_.push_back({corners_[at].before, at, corners_[at].next}); }

  void allAreCandidates() {
    for (uint32_t i = 0; i < corners_.size(); ++i)
      if (corners_[i].isLeft) candidates_.insert(i);
    changed_ = false;
  }

  uint32_t nextCandidate(uint32_t at) const {
    const uint32_t found = candidates_.from(at);
    return found == none ? candidates_.from(0) : found;
  }

  /// Of the corners that may lie in an ear: all that are left where the polygon touches itself, else the reflex ones.
  bool counts(uint32_t i) const { return touching_ ? corners_[i].isLeft : corners_[i].reflex; }
  std::size_t countLeft() const { return touching_ ? left_ : reflexLeft_; }

  void plantTree() {
    std::vector<uint32_t> members;
    members.reserve(countLeft());
    for (uint32_t i = 0; i < corners_.size(); ++i)
      if (counts(i)) members.push_back(i);
    tree_.build(points_.data(), std::move(members));
  }

  bool isEar(uint32_t i) {
    if (!(turn(i) > 0)) return false;
    comesBack_ = leavesBack_ = none;
    uint32_t found = tree_.find(before(i), points_[i], next(i), [&](uint32_t p) {
      return counts(p) && (touching_ ? blocksTouching(p, i) : blocks(p, i));
    });
    if (found == none && comesBack_ != none && leavesBack_ != none && isOutside(i)) found = comesBack_;
    if (found == none) return true;
    waits_.push_back({i, corners_[found].waiting});
    corners_[found].waiting = static_cast<uint32_t>(waits_.size() - 1);
    return false;
  }

  /// Whether a reflex corner p of a simple polygon keeps i from being an ear.
  bool blocks(uint32_t p, uint32_t i) const {
    const dvec2 &a = before(i), &b = points_[i], &c = next(i), &at = points_[p];
    if (at == a || at == b || at == c) return false;
    return orientation(a, b, at) >= 0 && orientation(b, c, at) >= 0 && orientation(c, a, at) >= 0;
  }

  /// Whether any corner p of a polygon that may touch itself keeps i from being an ear.
  bool blocksTouching(uint32_t p, uint32_t i) {
    ++work_;
    const dvec2 &a = before(i), &b = points_[i], &c = next(i), &at = points_[p];
    if (at != a && at != b && at != c) {
      const double ab = orientation(a, b, at), bc = orientation(b, c, at), ca = orientation(c, a, at);
      if (ab < 0 || bc < 0 || ca < 0) return false;
      if (ab > 0 && bc > 0 && ca > 0) return true;
    } else if (at == b && p != i) {
      if (isAlike(b, before(p), c)) comesBack_ = p;
      if (isAlike(b, next(p), a)) leavesBack_ = p;
    }
    return enters(at, before(p), i) || enters(at, next(p), i);
  }

  /// Whether the edge from a point on the border of i's triangle leads into the triangle.
  bool enters(const dvec2& from, const dvec2& to, uint32_t i) const {
    const dvec2* triangle[3] = {&before(i), &points_[i], &next(i)};
    for (int k = 0; k < 3; ++k) {
      const dvec2 &u = *triangle[k], &v = *triangle[(k + 1) % 3];
      if (orientation(u, v, from) == 0 && !(orientation(u, v, to) > 0)) return false;
    }
    return true;
  }

  static bool isAlike(const dvec2& from, const dvec2& u, const dvec2& v) {
    return orientation(from, u, v) == 0 && glm::dot(u - from, v - from) > 0;
  }

  /// Where both edges of a corner are ways without width, which the outline comes back along, then both their sides are
  /// inside (as on the way to a hole) or outside (to an island). Only the winding number tells.
  bool isOutside(uint32_t i) const {
    const dvec2 middle = (before(i) + points_[i] + next(i)) / 3.0;
    int winding = 0;
    uint32_t at = i;
    do {
      const dvec2 &u = points_[at], &v = next(at);
      const bool up = u.y <= middle.y;
      if (up != (v.y <= middle.y) && (orientation(u, v, middle) > 0) == up) winding += up ? 1 : -1;
      at = corners_[at].next;
    } while (at != i);
    return winding <= 0;
  }

  void release(uint32_t i) {
    for (uint32_t w = corners_[i].waiting; w != none; w = waits_[w].next)
      if (corners_[waits_[w].corner].isLeft) candidates_.insert(waits_[w].corner);
    corners_[i].waiting = none;
  }

  void cut(uint32_t i) {
    Corner& corner = corners_[i];
    triangles_.push_back({corner.before, i, corner.next});
    corners_[corner.before].next = corner.next;
    corners_[corner.next].before = corner.before;
    --left_;
    reflexLeft_ -= corner.reflex;
    corner.reflex = corner.isLeft = false;
    changed_ = true;
    if (countLeft() == 0) return;
    candidates_.erase(i);
    release(i);
    for (const uint32_t beside : {corner.before, corner.next}) {
      candidates_.insert(beside);
      if (!corners_[beside].reflex || !(turn(beside) > 0)) continue;  // Cutting an ear only makes others convex.
      corners_[beside].reflex = false;
      --reflexLeft_;
      if (!touching_) release(beside);
    }
    if (tree_.size() > 64 && 4 * countLeft() < tree_.size()) plantTree();
  }

  /// And the spikes that come to be by that. Returns the corner to go on from.
  uint32_t cutWithSpikes(uint32_t i) {
    cut(i);
    uint32_t low = corners_[i].before, high = corners_[i].next;
    while (left_ > 3) {
      if (isSpike(low)) {
        cut(low);
        low = corners_[low].before;
      } else if (isSpike(high)) {
        cut(high);
        high = corners_[high].next;
      } else {
        break;
      }
    }
    return high;
  }

  /// No area and no way on: a doubled corner, or one where the outline turns back along itself.
  bool isSpike(uint32_t i) const {
    const dvec2 &a = before(i), &b = points_[i], &c = next(i);
    return b == a || b == c || isAlike(b, a, c);
  }

  template <class Condition>
  uint32_t cutAll(uint32_t at, const Condition& condition) {
    for (std::size_t was = 0; was != left_;) {
      was = left_;
      for (std::size_t steps = 0; steps < left_ && left_ > 3;) {
        const bool isCut = condition(at);
        if (isCut) cut(at);
        at = isCut ? corners_[at].before : corners_[at].next;
        if (!isCut) ++steps;
      }
    }
    return at;
  }

  /// What is done where no candidate is left. Returns the corner to go on from.
  uint32_t help(uint32_t at) {
    if (crosses_ && work_ > maxWork) {
      for (; left_ > 3; at = corners_[at].next) cut(at);
      return at;
    }
    // Those that wait for a corner on the border of their triangle do not hear when its edges change.
    if (changed_) {
      allAreCandidates();
      return at;
    }
    at = cutAll(at, [&](uint32_t i) { return turn(i) == 0; });
    if (changed_) return at;
    // The polygon crosses itself, perhaps by no more than rounding; so the smallest triangle is the smallest error.
    if (!crosses_) work_ = 0;
    crosses_ = true;
    work_ += left_;
    uint32_t smallest = at;
    for (uint32_t i = corners_[at].next; i != at; i = corners_[i].next)
      if (std::abs(turn(i)) < std::abs(turn(smallest))) smallest = i;
    return cutWithSpikes(smallest);
  }

  std::vector<dvec2> points_;
  std::vector<uvec3>& triangles_;
  std::size_t first_;
  std::vector<Corner> corners_;
  std::vector<Wait> waits_;
  IndexSet candidates_;  ///< Corners that may be ears: not tested since something about them changed.
  CornerTree tree_;
  std::size_t left_ = 0, reflexLeft_ = 0, work_ = 0;
  uint32_t comesBack_ = none, leavesBack_ = none;  ///< Of an ear's corners in the same place: along its edges.
  bool changed_ = false;                           ///< Something was cut since all corners were candidates.
  bool touching_ = false, crosses_ = false;
};

}  // namespace

bool clipEars(std::vector<dvec2> corners, std::vector<uvec3>& triangles) {
  return Clipper(std::move(corners), triangles).run();
}

}  // namespace copse
