// Agglomerative clustering of the children of one k-ary node (Walter et al. 2008; Meister and Bittner 2016,
// section 4.2): the pair whose union has the smallest area is merged until one is left. O(k²) a node with each
// cluster's best partner kept, as long as few have the same; the merges are those of trying all pairs. Equal areas, as
// of boxes on one line, are told apart by the sum of the sides, then by the children merged so far, then by index:
// otherwise ties make chains.
#pragma once

#include "builder/bvh.h"
#include "builder/methods/kmeans/passes.h"

namespace copse::kmeans {

class Agglomeration {
 public:
  HD void add(uint32_t node, const Box& box) {
    node_[count_] = node;
    members_[count_] = 1;
    box_[count_++] = box;
  }

  /// Writes count-1 inner nodes: the last merge to `root`, the others to extra, extra+1, …
  HD void run(BvhNode* nodes, uint32_t* parents, uint32_t root, uint32_t extra) {
    for (uint32_t i = 0; i < count_; ++i) findPartner(i);
    while (count_ > 1) {
      uint32_t a = 0;
      for (uint32_t i = 1; i + 1 < count_; ++i)
        if (cost_[i] < cost_[a]) a = i;
      const uint32_t b = partner_[a];
      const uint32_t slot = count_ == 2 ? root : extra++;
      box_[a].grow(box_[b]);
      nodes[slot] = BvhNode::inner(box_[a], node_[a], node_[b]);
      parents[node_[a]] = parents[node_[b]] = slot;
      node_[a] = slot;
      members_[a] += members_[b];
      merge(a, b);
    }
  }

 private:
  struct Cost {
    float area, sides;
    uint32_t members;
    HD bool operator<(const Cost& o) const {
      if (area != o.area) return area < o.area;
      if (sides != o.sides) return sides < o.sides;
      return members < o.members;
    }
  };

  /// The best of the later clusters.
  HD void findPartner(uint32_t i) {
    cost_[i] = {FLT_MAX, FLT_MAX, ~0u};
    partner_[i] = i + 1;
    for (uint32_t j = i + 1; j < count_; ++j) offer(i, j);
  }
  HD void offer(uint32_t i, uint32_t j) {
    const Box box = unite(box_[i], box_[j]);
    const vec3 sides = box.hi - box.lo;
    const Cost cost{sides.x * sides.y + sides.y * sides.z + sides.z * sides.x, sides.x + sides.y + sides.z,
                    members_[i] + members_[j]};
    if (cost < cost_[i] || (!(cost_[i] < cost) && j < partner_[i])) {
      cost_[i] = cost;
      partner_[i] = j;
    }
  }
  /// Cluster a has grown, the last one takes b's place.
  HD void merge(uint32_t a, uint32_t b) {
    const uint32_t last = --count_;
    node_[b] = node_[last];
    members_[b] = members_[last];
    box_[b] = box_[last];
    for (uint32_t i = 0; i < count_; ++i) {
      if (i == a || i == b || partner_[i] == a || partner_[i] == b || partner_[i] == last) {
        findPartner(i);
      } else {
        if (i < a) offer(i, a);
        if (i < b) offer(i, b);
      }
    }
  }

  uint32_t count_ = 0;
  uint32_t node_[maxK];
  uint32_t partner_[maxK];
  uint32_t members_[maxK];
  Cost cost_[maxK];
  Box box_[maxK];
};

/// Turns a task's children into a treelet of binary nodes. Boxes are in the scene's unit.
struct AgglomerateAll {
  const Task* tasks;
  const uint32_t* firstKid;
  uint32_t taskCount, kidCount;
  const uint32_t* kidNodes;
  const uint32_t* extraNodes;
  const UnitBox* boxes;  ///< In the tree's order.
  BvhNode* nodes;
  uint32_t* parents;
  uint32_t leafNodes;

  HD void operator()(uint32_t index) const {
    Agglomeration clusters;
    const uint32_t end = index + 1 < taskCount ? firstKid[index + 1] : kidCount;
    for (uint32_t kid = firstKid[index]; kid < end; ++kid) {
      const uint32_t node = kidNodes[kid];
      clusters.add(node, node < leafNodes ? nodes[node].box() : boxes[node - leafNodes].box());
    }
    clusters.run(nodes, parents, tasks[index].node, extraNodes[index]);
  }
};

}  // namespace copse::kmeans
