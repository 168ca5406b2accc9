// From a builder's tree to wide nodes, level by level: each node of a level gathers its children, a scan gives those
// that are nodes their places in the next level. O(n); the same on both devices.
#include "tracer/accel/wide8.h"

#include <vector>

#include "builder/base/error.h"
#include "builder/parallel/launch.h"
#include "builder/parallel/primitives.h"
#include "tracer/accel/phases.h"

namespace copse {

namespace {

constexpr uint32_t absent = 0xffffffffu;

/// Up to eight nodes of the builder's tree.
struct Gathered {
  uint32_t child[Wide8Node::width];
};

/// Index: a node of a level.
struct GatherChildren {
  const BvhNode* from;
  const uint8_t* joints;  ///< Null where the tree has none.
  const uint32_t* level;
  Gathered* gathered;
  uint32_t* innerChildren;

  HD void operator()(uint32_t i) const {
    Set set;
    add(set, level[i]);  // The root may be a leaf, and then is its own child.
    for (uint32_t k; (k = largestThatFits(set)) != absent;) {
      const uint32_t child = set.child[k];
      --set.count;
      set.child[k] = set.child[set.count];
      set.area[k] = set.area[set.count];
      set.below[k] = set.below[set.count];
      add(set, child);
    }
    sortByArea(set);
    Gathered all;
    uint32_t inner = 0;
    for (uint32_t k = 0; k < Wide8Node::width; ++k) {
      all.child[k] = k < set.count ? set.child[k] : absent;
      inner += k < set.count && set.below[k] > 0;
    }
    gathered[i] = all;
    innerChildren[i] = inner;
  }

 private:
  struct Set {
    uint32_t child[Wide8Node::width];
    float area[Wide8Node::width];
    uint32_t below[Wide8Node::width];  ///< Per child: the number of its own children; 0 for a leaf.
    uint32_t count = 0;
  };

  /// The children of an inner node, without joints, or a leaf itself; returns their number.
  HD uint32_t childrenOf(uint32_t at, uint32_t* children) const {
    children[0] = at;
    if (from[at].isLeaf()) return 1;
    uint32_t stack[Wide8Node::width] = {from[at].left, from[at].right};
    uint32_t found = 0;
    for (uint32_t depth = 2; depth > 0;) {
      const uint32_t child = stack[--depth];
      if (joints && joints[child]) {
        stack[depth++] = from[child].left;
        stack[depth++] = from[child].right;
      } else {
        children[found++] = child;
      }
    }
    return found;
  }

  HD void add(Set& set, uint32_t at) const {
    uint32_t below[Wide8Node::width];
    for (uint32_t left = childrenOf(at, set.child + set.count); left > 0; --left, ++set.count) {
      const uint32_t child = set.child[set.count];
      set.area[set.count] = from[child].box().area();
      set.below[set.count] = from[child].isLeaf() ? 0 : childrenOf(child, below);
    }
  }

  /// The child of the largest area among those whose own children all fit in.
  HD static uint32_t largestThatFits(const Set& set) {
    uint32_t best = absent;
    for (uint32_t k = 0; k < set.count; ++k)
      if (set.below[k] > 0 && set.count - 1 + set.below[k] <= Wide8Node::width &&
          (best == absent || set.area[k] > set.area[best]))
        best = k;
    return best;
  }

  /// Any-hit traversal tries the largest first, as it stops more rays, and takes children from the end.
  HD static void sortByArea(Set& set) {
    for (uint32_t k = 1; k < set.count; ++k) {
      const uint32_t child = set.child[k], below = set.below[k];
      const float area = set.area[k];
      uint32_t at = k;
      for (; at > 0 && set.area[at - 1] > area; --at) {
        set.child[at] = set.child[at - 1];
        set.area[at] = set.area[at - 1];
        set.below[at] = set.below[at - 1];
      }
      set.child[at] = child;
      set.area[at] = area;
      set.below[at] = below;
    }
  }
};

/// Index: a node of a level. Its children that are nodes are listed for the next level.
struct ListChildren {
  const BvhNode* from;
  const Gathered* gathered;
  const uint32_t* place;  ///< Where the first of them goes.
  uint32_t* next;

  HD void operator()(uint32_t i) const {
    uint32_t at = place[i];
    for (const uint32_t child : gathered[i].child)
      if (child != absent && !from[child].isLeaf()) next[at++] = child;
  }
};

/// Index: a node of a level, which is written with its links to its children.
struct WriteNodes {
  const BvhNode* from;
  const Gathered* gathered;
  const uint32_t* place;
  uint32_t thisLevel, nextLevel;  ///< The first wide node of each.
  Wide8Node* nodes;
  uint32_t* parents;
  uint8_t* isLast;

  HD void operator()(uint32_t i) const {
    Wide8Node node;
    uint32_t at = nextLevel + place[i];
    for (uint32_t k = 0; k < Wide8Node::width; ++k) {
      const uint32_t child = gathered[i].child[k];
      const BvhNode below = child == absent ? BvhNode::leaf(Box{}, 0, 0) : from[child];
      for (int axis = 0; axis < 3; ++axis) {
        node.planes[axis][k] = below.lo[axis];
        node.planes[3 + axis][k] = below.hi[axis];
      }
      node.child[k] = below.isLeaf() ? leafBit | below.first() : at;
      if (below.count() > 0 && below.isLeaf()) isLast[below.first() + below.count() - 1] = 1;
      if (!below.isLeaf()) parents[at++] = thisLevel + i;
    }
    nodes[thisLevel + i] = node;
  }
};

struct WriteRoot {
  const BvhNode* from;
  uint32_t* parents;
  Box* bounds;
  HD void operator()(uint32_t) const {
    parents[0] = 0;
    bounds[0] = from[0].isLeaf() ? from[0].box() : unite(from[from[0].left].box(), from[from[0].right].box());
  }
};

struct Level {
  Buffer<Gathered> gathered;
  Buffer<uint32_t> place;
};

/// The levels from the root down, as long as there are nodes.
std::vector<Level> levelsOf(const Device& device, const Bvh& bvh) {
  std::vector<Level> levels;
  for (Buffer<uint32_t> nodes(device, std::vector<uint32_t>{0}); nodes.size() > 0;) {
    const auto count = static_cast<uint32_t>(nodes.size());
    Level level{Buffer<Gathered>(device, count), Buffer<uint32_t>(device, count)};
    Buffer<uint32_t> inner(device, 1);
    launch(
        device, "gather children", count,
        GatherChildren{bvh.nodes.data(), bvh.joints.data(), nodes.data(), level.gathered.data(), level.place.data()});
    exclusiveScan(device, "place children", count, level.place.data(), level.place.data(), inner.data());
    Buffer<uint32_t> next(device, inner.read(0));
    launch(device, "list children", count,
           ListChildren{bvh.nodes.data(), level.gathered.data(), level.place.data(), next.data()});
    nodes.swap(next);
    levels.push_back(std::move(level));
  }
  return levels;
}

}  // namespace

Wide8::Tree Wide8::build(const Device& device, const Bvh& bvh, const TrianglesView& triangles) {
  Tree tree;
  if (bvh.nodeCount == 0) return tree;
  if (bvh.arity > width) throw InputError("a tree whose nodes have more than eight children cannot be traversed");
  Phase phase(device, "traversal layout");
  const std::vector<Level> levels = levelsOf(device, bvh);
  std::size_t total = 0;
  for (const Level& level : levels) total += level.place.size();
  tree.nodes = Buffer<Wide8Node>(device, total);
  tree.parents = Buffer<uint32_t>(device, total);
  tree.bounds = Buffer<Box>(device, 1);
  launch(device, "root", 1, WriteRoot{bvh.nodes.data(), tree.parents.data(), tree.bounds.data()});
  Buffer<uint8_t> isLast(device, bvh.referenceCount);
  isLast.fill(0);
  uint32_t begin = 0;
  for (const Level& level : levels) {
    const auto count = static_cast<uint32_t>(level.place.size());
    launch(device, "wide nodes", count,
           WriteNodes{bvh.nodes.data(), level.gathered.data(), level.place.data(), begin, begin + count,
                      tree.nodes.data(), tree.parents.data(), isLast.data()});
    begin += count;
  }
  tree.triangles = traversalTriangles(device, bvh, triangles, isLast.data());
  return tree;
}

}  // namespace copse
