// Wide nodes and their blocks of triangles, level by level. O(n); the same on both devices.
#include "tracer/accel/wide8.h"

#include "builder/parallel/launch.h"
#include "builder/parallel/reduce.h"
#include "tracer/accel/phases.h"

namespace copse {

namespace {

/// Index: a node of a level, which is written with its links to its children, and the ids of its leaves' triangles.
struct WriteNodes {
  const BvhNode* from;
  const uint32_t* order;
  const WideChildren* children;
  const uint64_t* offset;
  uint32_t thisLevel, nextLevel;  ///< The first wide node of each.
  uint32_t firstBlock;            ///< Of the level.
  Wide8Node* nodes;
  uint32_t* parents;
  TriangleBlock* blocks;

  HD void operator()(uint32_t i) const {
    Wide8Node node{};
    uint32_t at = nextLevel + static_cast<uint32_t>(offset[i]);
    uint32_t block = firstBlock + static_cast<uint32_t>(offset[i] >> 32);
    for (uint32_t k = 0; k < wideWidth; ++k) {
      const uint32_t child = children[i].child[k];
      const bool isThere = child != WideChildren::absent;
      const Box box = isThere ? from[child & ~WideChildren::leafBit].box() : Box{};
      for (int axis = 0; axis < 3; ++axis) {
        node.planes[2 * axis][k] = box.lo[axis];
        node.planes[2 * axis + 1][k] = box.hi[axis];
      }
      if (!(child & WideChildren::leafBit)) {
        parents[at] = thisLevel + i;
        node.child[k] = at++;
      } else {
        node.child[k] = leafBit | block;
        if (isThere) block = writeIds(child & ~WideChildren::leafBit, block);
      }
    }
    nodes[thisLevel + i] = node;
  }

  /// All that is below `root`, from `block` on; the block after the last.
  HD uint32_t writeIds(uint32_t root, uint32_t block) const {
    uint32_t stack[maxLeafSize] = {root};
    uint32_t count = 0;
    for (uint32_t depth = 1; depth > 0;) {
      const BvhNode node = from[stack[--depth]];
      if (!node.isLeaf()) {
        stack[depth++] = node.right;
        stack[depth++] = node.left;
        continue;
      }
      for (uint32_t k = 0; k < node.count(); ++k, ++count)
        blocks[block + count / wideBlock].ids[count % wideBlock] = order[node.first() + k];
    }
    const uint32_t end = block + blocksOf(count);
    for (; count % wideBlock; ++count) blocks[end - 1].ids[count % wideBlock] = TriangleBlock::nobody;
    blocks[end - 1].ids[0] |= TriangleBlock::lastBit;
    return end;
  }
};

/// The corners of a block's triangles, whose ids are there. A triangle, and then its corners, may be anywhere in
/// memory: the CPU prefetches both long before it needs them.
struct WriteCorners {
  TrianglesView triangles;
  uint32_t count;
  TriangleBlock* blocks;

  static constexpr uint32_t indicesDistance = 16, cornersDistance = 8;

  HD void operator()(uint32_t i) const {
    ahead(i + indicesDistance, [&](uint32_t id) { prefetch(triangles.indices + id); });
    ahead(i + cornersDistance, [&](uint32_t id) {
      const uvec3 next = triangles.indices[id];
      prefetch(triangles.positions + next.x);
      prefetch(triangles.positions + next.y);
      prefetch(triangles.positions + next.z);
    });
    TriangleBlock& block = blocks[i];
    for (uint32_t k = 0; k < wideBlock; ++k) {
      const bool isThere = block.isThere(k);
      const uvec3 t = isThere ? triangles.indices[block.id(k)] : uvec3(0);
      for (int corner = 0; corner < 3; ++corner) {
        const vec3 p = isThere ? triangles.positions[t[corner]] : vec3(0);
        for (int axis = 0; axis < 3; ++axis) block.corners[axis][corner][k] = p[axis];
      }
    }
  }

  template <class Visit>
  HD void ahead([[maybe_unused]] uint32_t block, [[maybe_unused]] const Visit& visit) const {
#if !COPSE_DEVICE_CODE
    if (block >= count) return;
    for (uint32_t k = 0; k < wideBlock; ++k)
      if (blocks[block].isThere(k)) visit(blocks[block].id(k));
#endif
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

/// What the children of a node cost.
struct CostBelow {
  Wide8View view;
  WideRule rule;

  HD double operator()(uint32_t i) const {
    const Wide8Node& node = view.nodes[i];
    double cost = 0;
    for (uint32_t k = 0; k < wideWidth; ++k) {
      if (!node.isThere(k)) continue;
      Box box;
      for (int axis = 0; axis < 3; ++axis) {
        box.lo[axis] = node.planes[2 * axis][k];
        box.hi[axis] = node.planes[2 * axis + 1][k];
      }
      cost += box.area() * costOf(node.child[k]);
    }
    return cost;
  }
  HD double costOf(uint32_t link) const {
    if (isNode(link)) return rule.node;
    double cost = double{rule.leaf} + rule.block;
    for (const TriangleBlock* block = view.blocks + (link & ~leafBit); !block->isLast(); ++block) cost += rule.block;
    return cost;
  }
};

struct AddCosts {
  HD double operator()(double a, double b) const { return a + b; }
};

}  // namespace

double Wide8::cost(const Device& device, const View& view, const WideRule& rule) {
  if (view.nodeCount == 0) return 0;
  Box bounds;
  copyToHost(device, &bounds, view.bounds, sizeof bounds);
  return rule.node +
         reduce(device, "cost", view.nodeCount, 0.0, CostBelow{view, rule}, AddCosts{}) / double{bounds.area()};
}

Wide8::Tree Wide8::build(const Device& device, const Bvh& bvh, const TrianglesView& triangles, const WideRule& rule) {
  Tree tree;
  const std::vector<WideLevel> levels = widen(device, bvh, rule);
  if (levels.empty()) return tree;
  Phase phase(device, phases::traversalLayout);
  std::size_t nodes = 1;
  uint32_t blocks = 0;
  for (const WideLevel& level : levels) nodes += level.inner, blocks += level.blocks;
  tree.nodes = Buffer<Wide8Node>(device, nodes);
  tree.blocks = Buffer<TriangleBlock>(device, blocks);
  tree.parents = Buffer<uint32_t>(device, nodes);
  tree.bounds = Buffer<Box>(device, 1);
  launch(device, "root", 1, WriteRoot{bvh.nodes.data(), tree.parents.data(), tree.bounds.data()});
  uint32_t begin = 0, block = 0;
  for (const WideLevel& level : levels) {
    const auto count = static_cast<uint32_t>(level.children.size());
    launch(device, "wide nodes", count,
           WriteNodes{bvh.nodes.data(), bvh.order.data(), level.children.data(), level.offset.data(), begin,
                      begin + count, block, tree.nodes.data(), tree.parents.data(), tree.blocks.data()});
    begin += count;
    block += level.blocks;
  }
  launch(device, "write corners", blocks, WriteCorners{triangles, blocks, tree.blocks.data()});
  return tree;
}

}  // namespace copse
