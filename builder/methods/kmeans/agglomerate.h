// Agglomerative clustering of the children of one k-ary node (Walter et al. 2008; Meister and Bittner 2016,
// section 4.2): the pair whose union has the smallest area is merged until one is left. O(k²) per node with each
// cluster's best partner kept, as long as few have the same; the merges are those of trying all pairs. Equal areas, as
// of boxes on one line, are told apart by the sum of the sides, then by the children merged so far, then by index:
// otherwise ties make chains.
#pragma once

#include "builder/bvh.h"
#include "builder/methods/kmeans/passes.h"

namespace copse::kmeans {

class Agglomeration {
 public:
  /// How close two clusters are.
  struct Cost {
    float area, sides;
    uint32_t members;
    HD bool operator<(const Cost& o) const {
      if (area != o.area) return area < o.area;
      if (sides != o.sides) return sides < o.sides;
      return members < o.members;
    }
  };
  /// In shared memory.
  struct Clusters {
    Box box[maxK];
    Cost cost[maxK];         ///< With the partner,
    uint32_t partner[maxK];  ///< which is the closest of the later clusters.
    uint32_t node[maxK];
    uint32_t members[maxK];
  };

  HD Agglomeration(Clusters& clusters, uint32_t count) : s_(clusters), count_(count) {}

  HD void set(uint32_t i, uint32_t node, const Box& box) {
    s_.node[i] = node;
    s_.members[i] = 1;
    s_.box[i] = box;
  }

  /// Writes count-1 inner nodes: the last merge to `root`, the others to extra, extra+1, … All clusters are set.
  template <class Lanes>
  HD void run(Lanes& lanes, BvhNode* nodes, uint32_t* parents, uint32_t root, uint32_t extra) {
    lanes.sync();
    share(lanes, count_, [&](uint32_t i) { findPartner(i); });
    lanes.sync();
    while (count_ > 1) {
      Candidate best{{FLT_MAX, FLT_MAX, ~0u}, count_};
      share(lanes, count_ - 1, [&](uint32_t i) { best = Closest{}(best, {s_.cost[i], i}); });
      const uint32_t a = lanes.reduce(best, Closest{}).index, b = s_.partner[a], last = --count_;
      const uint32_t slot = last == 1 ? root : extra++;
      lanes.sync();
      if (lanes.lane() == 0) {
        s_.box[a].grow(s_.box[b]);
        nodes[slot] = BvhNode::inner(s_.box[a], s_.node[a], s_.node[b]);
        parents[s_.node[a]] = parents[s_.node[b]] = slot;
        s_.node[a] = slot;
        s_.members[a] += s_.members[b];
        s_.node[b] = s_.node[last];  // The last one takes b's place.
        s_.members[b] = s_.members[last];
        s_.box[b] = s_.box[last];
      }
      lanes.sync();
      share(lanes, count_, [&](uint32_t i) { update(i, a, b, last); });
      lanes.sync();
    }
  }

 private:
  struct Candidate {
    Cost cost;
    uint32_t index;
  };
  struct Closest {
    HD Candidate operator()(const Candidate& a, const Candidate& b) const {
      if (a.cost < b.cost) return a;
      if (b.cost < a.cost) return b;
      return a.index < b.index ? a : b;
    }
  };

  HD void findPartner(uint32_t i) {
    s_.cost[i] = {FLT_MAX, FLT_MAX, ~0u};
    s_.partner[i] = i + 1;
    for (uint32_t j = i + 1; j < count_; ++j) offer(i, j);
  }
  HD void offer(uint32_t i, uint32_t j) {
    const Box box = unite(s_.box[i], s_.box[j]);
    const vec3 sides = box.hi - box.lo;
    const Cost cost{sides.x * sides.y + sides.y * sides.z + sides.z * sides.x, sides.x + sides.y + sides.z,
                    s_.members[i] + s_.members[j]};
    if (cost < s_.cost[i] || (!(s_.cost[i] < cost) && j < s_.partner[i])) {
      s_.cost[i] = cost;
      s_.partner[i] = j;
    }
  }
  /// Cluster a has grown, and what was `last` is b.
  HD void update(uint32_t i, uint32_t a, uint32_t b, uint32_t last) {
    const uint32_t partner = s_.partner[i];
    if (i == a || i == b || partner == a || partner == b || partner == last) {
      findPartner(i);
    } else {
      if (i < a) offer(i, a);
      if (i < b) offer(i, b);
    }
  }

  Clusters& s_;
  uint32_t count_;
};

/// Turns a task's children into a treelet of binary nodes. Boxes are in the scene's unit.
struct AgglomerateAll {
  Level level;
  const UnitBox* boxes;  ///< In the tree's order.
  BvhNode* nodes;
  uint32_t* parents;
  uint8_t* joints;  ///< As Bvh::joints; null where nobody asks for them.
  uint32_t leafNodes;

  template <class Lanes>
  HD void operator()(Lanes& lanes, uint32_t index) const {
    const uint32_t begin = level.firstKid[index], end = level.firstKid[index + 1], extra = level.extraNodes[index];
    Agglomeration agglomeration(*static_cast<Agglomeration::Clusters*>(lanes.shared()), end - begin);
    share(lanes, end - begin, [&](uint32_t i) {
      const uint32_t node = level.kidNodes[begin + i];
      agglomeration.set(i, node, node < leafNodes ? nodes[node].box() : boxes[node - leafNodes].box());
    });
    agglomeration.run(lanes, nodes, parents, level.roots[index], extra);
    if (joints && end - begin > 2) share(lanes, end - begin - 2, [&](uint32_t i) { joints[extra + i] = 1; });
  }
};

}  // namespace copse::kmeans
