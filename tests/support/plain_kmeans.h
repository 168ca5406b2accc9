// The method of k-means by its definition, one triangle after the other, as the paper's sections 4 and 5 have it:
// the reference for the builder's trees.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <tuple>
#include <vector>

#include "builder/math/morton.h"
#include "builder/methods/kmeans/build.h"
#include "builder/methods/kmeans/plusplus.h"
#include "tests/support/builder_checks.h"

namespace copse::test {

using kmeans::Metric;
using kmeans::Settings;
using kmeans::UnitBox;

struct PlainNode {
  uint32_t triangle = 0;
  bool joint = false;  ///< Joins some children of a node of k.
  std::unique_ptr<PlainNode> left, right;
};
using PlainTree = std::unique_ptr<PlainNode>;

/// The method by its definition: recursive, all distances computed again in each of i iterations, integer sums, all
/// pairs tried in each step of the agglomeration.
class Plain {
 public:
  Plain(const test::TestMesh& mesh, const Settings& settings) : settings_(settings) {
    const uint32_t n = mesh.count();
    std::vector<Box> boxes(n);
    Box bounds;
    for (uint32_t i = 0; i < n; ++i) {
      for (int corner = 0; corner < 3; ++corner) boxes[i].grow(mesh.positions[mesh.indices[i][corner]]);
      bounds.grow(boxes[i]);
    }
    const MortonGrid grid = MortonGrid::over(bounds, 10, true);
    std::vector<uint32_t> order(n);
    for (uint32_t i = 0; i < n; ++i) order[i] = i;
    std::stable_sort(order.begin(), order.end(), [&](uint32_t a, uint32_t b) {
      return grid.code(boxes[a].centre2()) < grid.code(boxes[b].centre2());
    });
    const vec3 extent = bounds.hi - bounds.lo;
    const float longest = std::max({extent.x, extent.y, extent.z});
    const float scale = longest > 0 ? 1 / longest : 0;
    for (const uint32_t id : order) {
      UnitBox box{};
      for (int d = 0; d < 3; ++d) {
        box.lo[d] = std::clamp((boxes[id].lo[d] - bounds.lo[d]) * scale, 0.0f, 1.0f);
        box.hi[d] = std::clamp((boxes[id].hi[d] - bounds.lo[d]) * scale, 0.0f, 1.0f);
      }
      box.id = id;
      all_.push_back(box);
    }
  }

  PlainTree tree() const { return all_.empty() ? nullptr : split(all_, 0); }

 private:
  using Boxes = std::vector<UnitBox>;

  float distance(const UnitBox& b, const UnitBox& r) const {
    float e[6];
    for (uint32_t d = 0; d < 6; ++d) e[d] = b[d] - r[d];
    if (settings_.metric == Metric::euclid)
      return (e[0] * e[0] + e[1] * e[1] + e[2] * e[2]) + (e[3] * e[3] + e[4] * e[4] + e[5] * e[5]);
    for (float& x : e) x = std::fabs(x);
    if (settings_.metric == Metric::manhattan) return (e[0] + e[1] + e[2]) + (e[3] + e[4] + e[5]);
    if (settings_.metric == Metric::chebyshev) return *std::max_element(e, e + 6);
    float side[3];
    for (int d = 0; d < 3; ++d) side[d] = std::max(b.hi[d], r.hi[d]) - std::min(b.lo[d], r.lo[d]);
    return side[0] * side[1] + side[1] * side[2] + side[2] * side[0];
  }

  Boxes drawPlusPlus(const Boxes& segment, uint32_t first, uint32_t k) const {
    const auto n = static_cast<uint32_t>(segment.size());
    Boxes chosen{segment[kmeans::Draws(settings_.seed, first, n).below(n)]};
    std::vector<float> distances(n, INFINITY);
    float largest = 0;
    for (uint32_t c = 1; c < k; ++c) {
      uint64_t total = 0;
      for (uint32_t i = 0; i < n; ++i) distances[i] = std::min(distances[i], distance(segment[i], chosen.back()));
      if (c == 1) largest = *std::max_element(distances.begin(), distances.end());
      for (const float d : distances) total += kmeans::shareOf(d, largest);
      uint64_t rest = kmeans::drawBelow(settings_, c, first, n, total ? total : n);
      uint32_t at = 0;
      if (total == 0) at = static_cast<uint32_t>(rest);
      for (; total && rest >= kmeans::shareOf(distances[at], largest); ++at)
        rest -= kmeans::shareOf(distances[at], largest);
      chosen.push_back(segment[at]);
    }
    return chosen;
  }

  Boxes draw(const Boxes& segment, uint32_t first, uint32_t k) const {
    if (settings_.plusPlus) return drawPlusPlus(segment, first, k);
    const auto n = static_cast<uint32_t>(segment.size());
    kmeans::Draws draws(settings_.seed, first, n);
    Boxes chosen;
    while (chosen.size() < k) {
      const uint32_t candidates = chosen.empty() ? 1 : settings_.draws;
      UnitBox best{};
      float farthest = -1;
      for (uint32_t j = 0; j < candidates; ++j) {
        const auto bound = [&](uint64_t run) {  // Where one of the equal runs of the segment begins.
          return static_cast<uint32_t>(run * (((uint64_t{n} << 32) + candidates - 1) / candidates) >> 32);
        };
        const UnitBox& box = segment[bound(j) + draws.below(std::min(bound(j + 1), n) - bound(j))];
        float nearest = INFINITY;
        for (const UnitBox& r : chosen) nearest = std::min(nearest, distance(box, r));
        if (nearest > farthest) {
          farthest = nearest;
          best = box;
        }
      }
      chosen.push_back(best);
    }
    return chosen;
  }

  std::vector<uint32_t> assign(const Boxes& segment, const Boxes& reps) const {
    bool same = true;
    for (const UnitBox& r : reps)
      for (uint32_t d = 0; d < 6; ++d) same = same && r[d] == reps[0][d];
    std::vector<uint32_t> clusters;
    std::size_t powerOfTwo = 1;
    while (powerOfTwo < segment.size()) powerOfTwo *= 2;
    for (std::size_t i = 0; i < segment.size(); ++i) {
      uint32_t nearest = 0;
      for (uint32_t c = 1; c < reps.size(); ++c)
        if (distance(segment[i], reps[c]) < distance(segment[i], reps[nearest])) nearest = c;
      clusters.push_back(same ? static_cast<uint32_t>(i * reps.size() / powerOfTwo) : nearest);
    }
    return clusters;
  }

  void moveToMeans(const Boxes& segment, const std::vector<uint32_t>& clusters, Boxes& reps) const {
    const double scale = kmeans::fixedScale(static_cast<uint32_t>(segment.size()));
    for (uint32_t c = 0; c < reps.size(); ++c)
      for (uint32_t d = 0; d < 6; ++d) {
        int64_t sum = 0, count = 0;
        for (std::size_t i = 0; i < segment.size(); ++i)
          if (clusters[i] == c) {
            sum += std::llrint(static_cast<double>(segment[i][d]) * scale);
            ++count;
          }
        if (count) reps[c][d] = static_cast<float>(static_cast<double>(sum) / (static_cast<double>(count) * scale));
      }
  }

  PlainTree split(const Boxes& segment, uint32_t first) const {
    const auto n = static_cast<uint32_t>(segment.size());
    if (n == 1) {
      auto leaf = std::make_unique<PlainNode>();
      leaf->triangle = segment[0].id;
      return leaf;
    }
    const bool refined = n < settings_.leafQueueBelow;
    Boxes reps = draw(segment, first, refined ? 2 : settings_.k);
    std::vector<uint32_t> clusters;
    for (uint32_t t = 0; t < settings_.iterations; ++t) moveToMeans(segment, assign(segment, reps), reps);
    clusters = assign(segment, reps);
    if (n == 2 && refined) clusters = {0, 1};
    if (std::all_of(clusters.begin(), clusters.end(), [&](uint32_t c) { return c == clusters[0]; }))
      for (uint32_t i = 0; i < n; ++i) clusters[i] = i >= n / 2;
    std::vector<Joined> kids;
    for (uint32_t c = 0; c < reps.size(); ++c) {
      Boxes part;
      for (uint32_t i = 0; i < n; ++i)
        if (clusters[i] == c) part.push_back(segment[i]);
      if (part.empty()) continue;
      Joined kid;
      for (const UnitBox& b : part) kid.box.grow(b.box());
      kid.tree = split(part, first);
      first += static_cast<uint32_t>(part.size());
      kids.push_back(std::move(kid));
    }
    return agglomerate(std::move(kids));
  }

  struct Joined {
    PlainTree tree;
    Box box;
    uint32_t members = 1;
  };
  static PlainTree agglomerate(std::vector<Joined> kids) {
    while (kids.size() > 1) {
      std::tuple<float, float, uint32_t> cheapest{INFINITY, 0, 0};
      std::size_t a = 0, b = 1;
      for (std::size_t i = 0; i < kids.size(); ++i)
        for (std::size_t j = i + 1; j < kids.size(); ++j) {
          const Box box = unite(kids[i].box, kids[j].box);
          const vec3 s = box.hi - box.lo;
          const std::tuple<float, float, uint32_t> cost{s.x * s.y + s.y * s.z + s.z * s.x, s.x + s.y + s.z,
                                                        kids[i].members + kids[j].members};
          if (cost < cheapest) {
            cheapest = cost;
            a = i;
            b = j;
          }
        }
      auto node = std::make_unique<PlainNode>();
      node->left = std::move(kids[a].tree);
      node->right = std::move(kids[b].tree);
      node->joint = kids.size() > 2;
      kids[a].tree = std::move(node);
      kids[a].box.grow(kids[b].box);
      kids[a].members += kids[b].members;
      if (b + 1 != kids.size()) kids[b] = std::move(kids.back());
      kids.pop_back();
    }
    return std::move(kids[0].tree);
  }

  Settings settings_;
  Boxes all_;
};

}  // namespace copse::test
