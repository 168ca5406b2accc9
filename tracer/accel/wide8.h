// Nodes of up to eight children for rays: their boxes by plane, so that a host tests all of them at once (Wald, Benthin
// and Boulos 2008; Dammertz, Hanika and Keller 2008), and leaves of blocks of four triangles, which it tests at once as
// well. 256 bytes per node, however many children it has, and 160 per block.
#pragma once

#include "builder/collapse/wide.h"
#include "tracer/accel/tree.h"

namespace copse {

/// A cache line per axis and one for the links. Children stand in order of their surface area, the largest last. A slot
/// without a child has an empty box.
struct alignas(64) Wide8Node {
  static constexpr uint32_t width = wideWidth;

  float planes[6][width];  ///< Lower x, upper x, lower y, upper y, lower z, upper z.
  uint32_t child[width];   ///< A leaf's link has the number of its first block.
  uint32_t unused[width];

  HD bool isThere(uint32_t k) const { return planes[0][k] <= planes[1][k]; }
};
static_assert(sizeof(Wide8Node) == 256);

/// Up to four triangles of a leaf.
struct alignas(32) TriangleBlock {
  static constexpr uint32_t size = wideBlock;
  static constexpr uint32_t nobody = 0xffffffffu;  ///< The id in a place without a triangle; the first has always one.
  static constexpr uint32_t lastBit = 0x80000000u;

  float corners[3][3][size];  ///< By axis, then corner, then triangle.
  uint32_t ids[size];         ///< With lastBit in the first one, in the last block of a leaf.

  HD bool isLast() const { return ids[0] & lastBit; }
  HD uint32_t id(uint32_t k) const { return k == 0 ? ids[0] & ~lastBit : ids[k]; }
  HD bool isThere(uint32_t k) const { return k == 0 || ids[k] != nobody; }
  HD TraversalTriangle triangle(uint32_t k) const {
    const auto& c = corners;
    return {{c[0][0][k], c[0][1][k], c[0][2][k]}, id(k), {c[1][0][k], c[1][1][k], c[1][2][k]}, 0,
            {c[2][0][k], c[2][1][k], c[2][2][k]}, 0};
  }
};
static_assert(sizeof(TriangleBlock) == 160);

/// What kernels take by value, as a TreeView.
struct Wide8View {
  const Wide8Node* nodes;
  const TriangleBlock* blocks;
  const uint32_t* parents;
  const Box* bounds;
  uint32_t nodeCount;
};

/// The format. Its step is in wide8_steps.h.
struct Wide8 {
  using Node = Wide8Node;
  using View = Wide8View;
  using Settings = WideRule;
  static constexpr uint32_t width = Wide8Node::width;

  /// The buffers behind a View.
  struct Tree {
    Buffer<Wide8Node> nodes;
    Buffer<TriangleBlock> blocks;
    Buffer<uint32_t> parents;
    Buffer<Box> bounds;

    View view() const {
      return {nodes.data(), blocks.data(), parents.data(), bounds.data(), static_cast<uint32_t>(nodes.size())};
    }
    std::size_t bytes() const { return nodes.bytes() + blocks.bytes() + parents.bytes() + bounds.bytes(); }
  };

  /// Phases "widen" and "traversal layout". Any builder's tree, breadth-first: widen() says which nodes are whose
  /// children. O(n), with one wait for the device per level. Throws InputError where `bvh` has an arity above 8.
  static Tree build(const Device& device, const Bvh& bvh, const TrianglesView& triangles, const WideRule& rule = {});

  /// Σ over the boxes of nodes, leaves and their blocks of what `rule` says they cost, over the root's surface area; 0
  /// where there is no tree. Waits for the device.
  static double cost(const Device& device, const View& view, const WideRule& rule);
};

}  // namespace copse
