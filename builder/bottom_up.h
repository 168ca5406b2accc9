// The bottom-up pass over a binary tree: one thread per leaf, and of the two that meet at an inner node the second goes
// on. Karras 2012. Whoever goes on sees all that was written for both children.
#pragma once

#include <cstdint>

#include "builder/bvh.h"
#include "builder/parallel/atomics.h"

namespace copse {

/// Parents of all nodes. The word of an inner node also notes the first arrival, in its highest bit; the second clears
/// it, so that after a whole pass the words are parents again and the next pass needs no preparation.
struct ParentLinks {
  static constexpr uint32_t none = 0x7fffffffu;  ///< The root's.
  static constexpr uint32_t arrived = 0x80000000u;

  uint32_t* words;

  HD uint32_t ofLeaf(uint32_t leaf) const { return words[leaf]; }
  /// Tells inner node `at` that one child is done. False for the first: stop. True for the second; `parent` is then
  /// at's own.
  HD bool secondAt(uint32_t at, uint32_t& parent) const {
    const uint32_t before = atomicAddAcqRel(words + at, arrived);
    parent = before & ~arrived;
    return before & arrived;
  }
};

/// Exchanges the root with node 0, where an open tree has it. `parents` are those of all nodes but the root.
HD inline void bringToFront(BvhNode* nodes, uint32_t* parents, uint32_t root) {
  parents[root] = ParentLinks::none;
  if (root == 0) return;
  BvhNode& above = nodes[parents[0]];
  (above.left == 0 ? above.left : above.right) = root;
  const BvhNode first = nodes[0];
  nodes[0] = nodes[root];
  nodes[root] = first;
  parents[root] = parents[0];
  parents[0] = ParentLinks::none;
  for (const uint32_t at : {0u, root}) {
    parents[nodes[at].left] = at;
    parents[nodes[at].right] = at;
  }
}

}  // namespace copse
