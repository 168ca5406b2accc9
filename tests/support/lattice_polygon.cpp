// Traces the outlines of the cells, then joins them by paths along the lattice's edges.
#include "tests/support/lattice_polygon.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <glm/common.hpp>

namespace copse::test {
namespace {

using glm::ivec2;
using Loop = std::vector<ivec2>;
constexpr ivec2 directions[4] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}};

/// Counter-clockwise quarter turns from one axis direction to another, 1 … 4.
int turnsTo(ivec2 from, ivec2 to) {
  for (int turns = 1; turns < 4; ++turns) {
    from = {-from.y, from.x};
    if (from == to) return turns;
  }
  return 4;
}

class Maker {
 public:
  Maker(LatticePolygon& shape, std::mt19937& random)
      : shape_(shape), random_(random), occupied_((shape.width + 3) * (shape.height + 3)), used_(occupied_.size()) {}

  bool has(int x, int y) const {
    return x >= 0 && y >= 0 && x < shape_.width && y < shape_.height && shape_.cells[y * shape_.width + x];
  }

  void trace() {
    const bool joined = below(2);  // Where cells meet at a corner only, the outline goes along them in one of two ways.
    std::vector<std::array<bool, 4>> edges(used_.size());
    for (int y = 0; y < shape_.height; ++y)
      for (int x = 0; x < shape_.width; ++x) {
        if (!has(x, y)) continue;
        if (!has(x, y - 1)) edges[at({x, y})][0] = true;
        if (!has(x + 1, y)) edges[at({x + 1, y})][1] = true;
        if (!has(x, y + 1)) edges[at({x + 1, y + 1})][2] = true;
        if (!has(x - 1, y)) edges[at({x, y + 1})][3] = true;
      }
    for (int y = 0; y <= shape_.height; ++y)
      for (int x = 0; x <= shape_.width; ++x)
        for (int d = 0; d < 4; ++d) {
          if (!edges[at({x, y})][d]) continue;
          Loop loop;
          ivec2 p = {x, y};
          for (int way = d;;) {
            edges[at(p)][way] = false;
            use(p, way);
            loop.push_back(p);
            p += directions[way];
            const int left = (way + 1) % 4, right = (way + 3) % 4;
            const auto open = [&](int next) { return edges[at(p)][next]; };
            const int first = joined ? right : left, last = joined ? left : right;
            if (open(first))
              way = first;
            else if (open(way))
              continue;
            else if (open(last))
              way = last;
            else
              break;
          }
          loops_.push_back(loop);
        }
    for (std::size_t i = 0; i < loops_.size(); ++i)  // An outer one first.
      if (area(loops_[i]) > 0) {
        std::swap(loops_[0], loops_[i]);
        break;
      }
  }

  /// Joins all loops to the first along random shortest paths.
  void join() {
    while (loops_.size() > 1) {
      std::vector<int> from(occupied_.size(), -1), target(occupied_.size(), -1);
      for (std::size_t i = 1; i < loops_.size(); ++i)
        for (const ivec2 p : loops_[i]) target[at(p)] = static_cast<int>(i);
      std::vector<ivec2> queue;
      for (const ivec2 p : loops_[0])
        if (from[at(p)] < 0) from[at(p)] = 4, queue.push_back(p);
      std::shuffle(queue.begin(), queue.end(), random_);
      ivec2 end{};
      int found = -1;
      for (std::size_t i = 0; i < queue.size() && found < 0; ++i) {
        const int first = static_cast<int>(below(4));
        for (int k = 0; k < 4 && found < 0; ++k) {
          const int way = (first + k) % 4;
          const ivec2 p = queue[i], q = p + directions[way];
          if (!inside(q) || isUsed(p, way) || from[at(q)] >= 0) continue;
          // From a point that both outlines have, a path of length 0 is not made; any other edge will do.
          if (occupied_[at(q)] && target[at(q)] < 0) continue;
          from[at(q)] = way;
          queue.push_back(q);
          if (target[at(q)] >= 0) found = target[at(q)], end = q;
        }
      }
      if (found < 0) {  // They touch everywhere: leave out the cells of this one.
        failed_ = true;
        return;
      }
      Loop path;
      for (ivec2 p = end;; p -= directions[from[at(p)]]) {
        path.push_back(p);
        if (from[at(p)] == 4) break;
      }
      std::reverse(path.begin(), path.end());
      splice(path, loops_[found]);
      loops_.erase(loops_.begin() + found);
    }
  }

  void addSpike() {
    Loop path = {loops_[0][below(loops_[0].size())]};
    const std::size_t steps = 1 + below(5);
    for (int tries = 0; tries < 20 && path.size() <= steps; ++tries) {
      const int way = static_cast<int>(below(4));
      const ivec2 q = path.back() + directions[way];
      if (!inside(q) || isUsed(path.back(), way) || occupied_[at(q)]) continue;
      if (std::find(path.begin(), path.end(), q) == path.end()) path.push_back(q);
    }
    if (path.size() > 1) splice(path, {path.back()});
  }

  bool failed() const { return failed_; }

  Loop decorated(double chance) {
    const Loop& loop = loops_[0];
    const auto happens = [&] { return std::uniform_real_distribution<>()(random_) < chance; };
    const double keepStraight = std::uniform_real_distribution<>()(random_);
    Loop out;
    const std::size_t n = loop.size(), start = below(n);
    for (std::size_t i = 0; i < n; ++i) {
      const ivec2 before = loop[(start + i + n - 1) % n], p = loop[(start + i) % n], next = loop[(start + i + 1) % n];
      const bool isStraight = next - p == p - before;
      if (isStraight && std::uniform_real_distribution<>()(random_) > keepStraight) continue;
      do out.push_back(2 * p);
      while (happens());
      if (happens()) out.push_back(p + next), out.push_back(2 * p);  // Half of the way to the next and back.
    }
    return out;
  }

 private:
  std::size_t below(std::size_t n) { return random_() % n; }
  std::size_t at(ivec2 p) const { return (p.y + 1) * (shape_.width + 3) + p.x + 1; }
  bool inside(ivec2 p) const { return p.x >= -1 && p.y >= -1 && p.x <= shape_.width + 1 && p.y <= shape_.height + 1; }
  bool isUsed(ivec2 p, int way) const { return used_[at(p)][way]; }
  void use(ivec2 p, int way) {
    used_[at(p)][way] = used_[at(p + directions[way])][(way + 2) % 4] = true;
    occupied_[at(p)] = occupied_[at(p + directions[way])] = true;
  }

  static long area(const Loop& loop) {
    long sum = 0;
    for (std::size_t i = 0; i < loop.size(); ++i) {
      const ivec2 p = loop[i], q = loop[(i + 1) % loop.size()];
      sum += long{p.x} * q.y - long{p.y} * q.x;
    }
    return sum;
  }

  bool isInterior(ivec2 p, ivec2 d) const {
    const ivec2 q = glm::min(p, p + d);
    return has(q.x, q.y);  // The cell above or right of an edge that is no outline is like the one on its other side.
  }

  /// Which visit of p a path in direction d may leave from without crossing another one: that whose edge is the next
  /// clockwise, which has the inside or the outside to its left.
  std::size_t visit(const Loop& loop, ivec2 p, ivec2 d) const {
    const bool interior = isInterior(p, d);
    std::size_t best = 0;
    int bestTurns = 5;
    const std::size_t n = loop.size();
    for (std::size_t i = 0; i < n && n > 1; ++i) {
      if (loop[i] != p) continue;
      const int turns = turnsTo(loop[(i + (interior ? 1 : n - 1)) % n] - p, d);
      if (turns < bestTurns) bestTurns = turns, best = i;
    }
    return best;
  }

  void splice(const Loop& path, const Loop& other) {
    Loop& loop = loops_[0];
    const std::size_t n = path.size(), k = other.size();
    const std::size_t here = visit(loop, path[0], path[1] - path[0]);
    const std::size_t there = visit(other, path[n - 1], path[n - 2] - path[n - 1]);
    Loop out(loop.begin(), loop.begin() + here + 1);
    out.insert(out.end(), path.begin() + 1, path.end() - 1);
    for (std::size_t i = 0; i < k + (k > 1); ++i) out.push_back(other[(there + i) % k]);
    for (std::size_t i = n - 2; i > 0; --i) out.push_back(path[i]);
    out.insert(out.end(), loop.begin() + here, loop.end());
    for (std::size_t i = 0; i + 1 < n; ++i)
      for (int way = 0; way < 4; ++way)
        if (path[i] + directions[way] == path[i + 1]) use(path[i], way);
    loop = out;
  }

  LatticePolygon& shape_;
  std::mt19937& random_;
  std::vector<Loop> loops_;
  std::vector<bool> occupied_;             ///< Points of outlines and paths.
  std::vector<std::array<bool, 4>> used_;  ///< Edges of outlines and paths, by their start and direction.
  bool failed_ = false;
};

}  // namespace

int LatticePolygon::coveredCells() const { return static_cast<int>(std::count(cells.begin(), cells.end(), true)); }

LatticePolygon randomLatticePolygon(std::mt19937& random, int width, int height, double fill, int spikes,
                                    double decoration) {
  for (;;) {
    LatticePolygon shape{width, height, std::vector<bool>(static_cast<std::size_t>(width * height)), {}};
    for (std::size_t i = 0; i < shape.cells.size(); ++i)
      shape.cells[i] = std::uniform_real_distribution<>()(random) < fill;
    if (!shape.coveredCells()) continue;
    Maker maker(shape, random);
    maker.trace();
    maker.join();
    if (maker.failed()) continue;
    for (int i = 0; i < spikes; ++i) maker.addSpike();
    shape.outline = maker.decorated(decoration);
    if (shape.outline.size() >= 3) return shape;
  }
}

}  // namespace copse::test
