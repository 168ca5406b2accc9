// What a tree is built over: a box per reference, and the box around all of them.
#pragma once

#include "builder/open_tree.h"

namespace copse {

/// As pointers into the device's memory: what methods and optimisers get. Where triangles are split there are more
/// references than triangles; otherwise reference i is triangle i.
struct Primitives {
  const Box* boxes = nullptr;   ///< Per reference.
  const Box* bounds = nullptr;  ///< Around all of them.
  uint32_t count = 0;           ///< References.
  TrianglesView triangles{};    ///< For methods that look at the triangles themselves; most look at boxes alone.
  const uint32_t* triangleOf = nullptr;  ///< Per reference; null where reference i is triangle i.

  /// Triangles: fewer than references where some were split.
  uint32_t triangleCount() const { return triangleOf ? triangles.count : count; }
};

/// The same with the memory that it stands in.
class OwnedPrimitives {
 public:
  OwnedPrimitives() = default;
  /// Memory for `count` boxes and the one around them, none of them written yet.
  OwnedPrimitives(const Device& device, uint32_t count, const TrianglesView& triangles)
      : count_(count), triangles_(triangles), memory_(device, std::size_t{count} + 1) {}

  Box* boxes() { return memory_.data(); }
  Box* bounds() { return memory_.data() + count_; }
  Primitives view() const { return {memory_.data(), memory_.data() + count_, count_, triangles_}; }

 private:
  uint32_t count_ = 0;
  TrianglesView triangles_{};
  Buffer<Box> memory_;  ///< One allocation: the bounds follow the boxes.
};

/// A reference per triangle, with its box; a corner that is NaN is in none. Nothing where there is no triangle. Phase
/// "boxes". O(n); it does not wait for the device.
OwnedPrimitives primitivesOf(const Device& device, const TrianglesView& triangles);

/// Turns the tree's order from references to their triangles. One launch.
void referToTriangles(const Device& device, const uint32_t* triangleOf, OpenTree& tree);

}  // namespace copse
