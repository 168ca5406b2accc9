// The costs of all subtrees, from the leaves up, and then the choices that led to them, from the root down.
#include "builder/collapse/wide.h"

#include "builder/base/error.h"
#include "builder/bottom_up.h"
#include "builder/open_tree.h"
#include "builder/parallel/launch.h"
#include "builder/parallel/primitives.h"
#include "builder/phases.h"

namespace copse {

namespace {

const ParameterSpec nodeSpec{.name = "wide.node",
                             .standard = 1.0,
                             .min = 0,
                             .max = 1000,
                             .meaning = "cost of a visit to a node of eight children",
                             .ofTree = false},
    leafSpec{.name = "wide.leaf",
             .standard = 0.0,
             .min = 0,
             .max = 1000,
             .meaning = "cost of a visit to a leaf of a wide tree, without its triangles",
             .ofTree = false},
    blockSpec{.name = "wide.block",
              .standard = 0.7,
              .min = 0,
              .max = 1000,
              .meaning = "cost of the test of a block of up to four triangles",
              .ofTree = false},
    leafMaxSpec{.name = "wide.leaf_max",
                .standard = 8,
                .min = 1,
                .max = maxLeafSize,
                .meaning = "maximum number of triangles below a node that becomes a leaf of a wide tree",
                .ofTree = false},
    childrenSpec{.name = "wide.children",
                 .standard = "cost",
                 .words = {"cost", "own"},
                 .meaning = "a wide node's children: those of minimum cost, or the node's own in the builder's tree",
                 .ofTree = false};

/// The costs of a subtree as up to 1 … 7 children of one node. As one child it is a leaf or a wide node.
struct SubtreeCosts {
  float of[wideWidth - 1];
  uint32_t count;  ///< Triangles.

  HD float as(uint32_t children) const { return of[children - 1]; }
};
static_assert(sizeof(SubtreeCosts) == 32);

/// The pass up and the pass down compute the same numbers, so that equality tells what was chosen.
struct CostRule {
  float node, leaf, block;
  uint32_t leafMax;

  HD float asLeaf(float area, uint32_t count) const {
    return area * (leaf + block * static_cast<float>(blocksOf(count)));
  }
  HD bool mayBeLeaf(uint32_t count) const { return count <= leafMax; }

  /// As `slots` children, 2 … 8, of which `first` are the left child's; the least cost and the least such `first`.
  HD static float asChildren(const SubtreeCosts& left, const SubtreeCosts& right, uint32_t slots, uint32_t& first) {
    float best = INFINITY;
    first = slots < wideWidth ? 1 : slots - (wideWidth - 1);
    for (uint32_t k = first; k < slots && k < wideWidth; ++k) {
      const float cost = left.as(k) + right.as(slots - k);
      if (!(cost < best)) continue;
      best = cost;
      first = k;
    }
    return best;
  }
  HD static float asChildren(const SubtreeCosts& left, const SubtreeCosts& right, uint32_t slots) {
    uint32_t first;
    return asChildren(left, right, slots, first);
  }
};

/// From a leaf up.
struct WeighSubtrees {
  const BvhNode* nodes;
  ParentLinks parents;
  CostRule rule;
  SubtreeCosts* costs;

  HD void operator()(uint32_t i) const {
    const BvhNode leaf = nodes[i];
    if (!leaf.isLeaf()) return;
    SubtreeCosts own;
    own.count = leaf.count();
    for (float& cost : own.of) cost = rule.asLeaf(leaf.box().area(), own.count);
    costs[i] = own;
    uint32_t at = parents.ofLeaf(i), parent;
    for (; at != ParentLinks::none && parents.secondAt(at, parent); at = parent) costs[at] = ofInner(nodes[at]);
  }

  HD SubtreeCosts ofInner(const BvhNode& node) const {
    const SubtreeCosts left = costs[node.left], right = costs[node.right];
    const float area = node.box().area();
    SubtreeCosts own;
    own.count = left.count + right.count;
    own.of[0] = area * rule.node + CostRule::asChildren(left, right, wideWidth);
    if (rule.mayBeLeaf(own.count)) own.of[0] = minOf(rule.asLeaf(area, own.count), own.of[0]);
    for (uint32_t slots = 2; slots < wideWidth; ++slots)
      own.of[slots - 1] = minOf(CostRule::asChildren(left, right, slots), own.of[slots - 2]);
    return own;
  }
};

/// A node of the binary tree with its area, on the way to be a child.
struct Candidates {
  uint32_t child[wideWidth];
  float area[wideWidth];
  uint32_t count = 0;

  HD void add(uint32_t node, float nodeArea) {
    child[count] = node;
    area[count++] = nodeArea;
  }

  /// Any-hit traversal tries the largest first, as it stops more rays, and takes children from the end.
  HD WideChildren byArea() {
    for (uint32_t k = 1; k < count; ++k) {
      const uint32_t moved = child[k];
      const float movedArea = area[k];
      uint32_t at = k;
      for (; at > 0 && area[at - 1] > movedArea; --at) {
        child[at] = child[at - 1];
        area[at] = area[at - 1];
      }
      child[at] = moved;
      area[at] = movedArea;
    }
    WideChildren all;
    for (uint32_t k = 0; k < wideWidth; ++k) all.child[k] = k < count ? child[k] : WideChildren::absent;
    return all;
  }
};

/// Index: a node of a level.
struct ChooseChildren {
  const BvhNode* nodes;
  const uint8_t* joints;  ///< Where children are the node's own; null where they are those of minimum cost.
  bool ownChildren;
  CostRule rule;
  const SubtreeCosts* costs;
  const uint32_t* level;
  WideChildren* children;
  uint64_t* below;  ///< The numbers of inner children and, << 32, of blocks.

  HD void operator()(uint32_t i) const {
    Candidates candidates;
    if (isLeaf(level[i]))
      add(candidates, level[i]);  // The root alone.
    else if (ownChildren)
      addOwn(candidates, level[i]);
    else
      addCheapest(candidates, level[i]);
    const WideChildren all = candidates.byArea();
    uint64_t counts = 0;
    for (const uint32_t child : all.child)
      if (child != WideChildren::absent)
        counts +=
            child & WideChildren::leafBit ? uint64_t{blocksOf(costs[child & ~WideChildren::leafBit].count)} << 32 : 1;
    children[i] = all;
    below[i] = counts;
  }

 private:
  /// Whether a node that is one child becomes a leaf.
  HD bool isLeaf(uint32_t at) const {
    if (nodes[at].isLeaf()) return true;
    return !ownChildren && rule.mayBeLeaf(costs[at].count) &&
           costs[at].as(1) == rule.asLeaf(nodes[at].box().area(), costs[at].count);
  }
  HD void add(Candidates& candidates, uint32_t at) const {
    candidates.add(isLeaf(at) ? at | WideChildren::leafBit : at, nodes[at].box().area());
  }

  HD void addOwn(Candidates& candidates, uint32_t root) const {
    uint32_t stack[wideWidth] = {nodes[root].left, nodes[root].right};
    for (uint32_t depth = 2; depth > 0;) {
      const uint32_t at = stack[--depth];
      if (joints && joints[at]) {
        stack[depth++] = nodes[at].left;
        stack[depth++] = nodes[at].right;
      } else {
        add(candidates, at);
      }
    }
  }

  HD void addCheapest(Candidates& candidates, uint32_t root) const {
    struct Share {
      uint32_t at, slots;
    };
    Share stack[wideWidth];
    uint32_t depth = 0;
    const auto split = [&](uint32_t at, uint32_t slots) {
      const BvhNode& node = nodes[at];
      uint32_t first;
      CostRule::asChildren(costs[node.left], costs[node.right], slots, first);
      stack[depth++] = {node.left, first};
      stack[depth++] = {node.right, slots - first};
    };
    split(root, wideWidth);
    while (depth > 0) {
      Share share = stack[--depth];
      const SubtreeCosts& own = costs[share.at];
      while (share.slots > 1 && own.as(share.slots) == own.as(share.slots - 1)) --share.slots;
      if (share.slots == 1)
        add(candidates, share.at);
      else
        split(share.at, share.slots);
    }
  }
};

/// Index: a node of a level. Its children that are nodes are listed for the next level.
struct ListInner {
  const WideChildren* children;
  const uint64_t* offset;
  uint32_t* next;

  HD void operator()(uint32_t i) const {
    auto at = static_cast<uint32_t>(offset[i]);
    for (const uint32_t child : children[i].child)
      if (!(child & WideChildren::leafBit)) next[at++] = child;
  }
};

}  // namespace

WideRule::WideRule(const Parameters& parameters)
    : node(static_cast<float>(parameters.real(nodeSpec))),
      leaf(static_cast<float>(parameters.real(leafSpec))),
      block(static_cast<float>(parameters.real(blockSpec))),
      leafMax(static_cast<uint32_t>(parameters.integer(leafMaxSpec))),
      ownChildren(parameters.text(childrenSpec) == "own") {}

std::vector<ParameterSpec> wideParameters() { return {nodeSpec, leafSpec, blockSpec, leafMaxSpec, childrenSpec}; }

std::vector<WideLevel> widen(const Device& device, const Bvh& bvh, const WideRule& rule) {
  std::vector<WideLevel> levels;
  if (bvh.nodeCount == 0) return levels;
  if (bvh.arity > wideWidth) throw InputError("a tree whose nodes have more than eight children cannot be traversed");
  Phase phase(device, phases::widen);
  const CostRule costRule{rule.node, rule.leaf, rule.block, rule.leafMax};
  Buffer<SubtreeCosts> costs(device, bvh.nodeCount);
  {
    const Buffer<uint32_t> parents = parentsOf(device, bvh);
    launch(device, "weigh subtrees", bvh.nodeCount,
           WeighSubtrees{bvh.nodes.data(), {const_cast<uint32_t*>(parents.data())}, costRule, costs.data()});
  }
  for (Buffer<uint32_t> nodes(device, std::vector<uint32_t>{0}); nodes.size() > 0;) {
    const auto count = static_cast<uint32_t>(nodes.size());
    WideLevel level{Buffer<WideChildren>(device, count), Buffer<uint64_t>(device, count), 0, 0};
    Buffer<uint64_t> total(device, 1);
    launch(device, "choose children", count,
           ChooseChildren{bvh.nodes.data(), bvh.joints.data(), rule.ownChildren, costRule, costs.data(), nodes.data(),
                          level.children.data(), level.offset.data()});
    exclusiveScan(device, "place children", count, level.offset.data(), level.offset.data(), total.data());
    const uint64_t sum = total.read(0);
    level.inner = static_cast<uint32_t>(sum);
    level.blocks = static_cast<uint32_t>(sum >> 32);
    Buffer<uint32_t> next(device, level.inner);
    launch(device, "list inner", count, ListInner{level.children.data(), level.offset.data(), next.data()});
    nodes.swap(next);
    levels.push_back(std::move(level));
  }
  return levels;
}

}  // namespace copse
