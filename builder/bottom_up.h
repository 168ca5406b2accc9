// The bottom-up pass over a binary tree: one thread per leaf, and of the two that meet at an inner node the second goes
// on. Karras 2012. Whoever goes on sees all that was written for both children.
#pragma once

#include <cstdint>

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

}  // namespace copse
