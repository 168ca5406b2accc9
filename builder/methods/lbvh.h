// The radix tree of sorted keys, one inner node at a time: Karras 2012. Other builders start from it too.
// Equal keys are told apart by their place in the order, as if each key were followed by its 32-bit index.
#pragma once

#include <cstdint>

#include "builder/open_tree.h"
#include "builder/parameters.h"
#include "builder/primitives/primitives.h"

namespace copse {

OpenTree buildLbvh(const Device& device, const Primitives& input, const Parameters& parameters);

/// Where two keys differ: the exclusive or of the keys, then of their places. A longer common prefix, Karras' delta,
/// means a lower highest bit here.
struct KeyDifference {
  uint64_t key;
  uint32_t place;

  HD bool operator<(const KeyDifference& other) const {
    return key != other.key ? key < other.key : place < other.place;
  }
};

struct RadixTree {
  const uint64_t* keys;  ///< Ascending.
  uint32_t count;        ///< At least 2.

  struct Children {
    uint32_t left, right;  ///< Node indices: inner nodes from 0, leaf i at count-1+i.
  };

  HD KeyDifference difference(uint32_t i, uint32_t j) const { return {keys[i] ^ keys[j], i ^ j}; }

  /// The children of inner node i, 0 … count-2. Node i's range of leaves starts or ends at leaf i.
  HD Children childrenOf(uint32_t i) const {
    // The range goes towards the neighbour with the longer common prefix. The neighbour on the other side is outside;
    // a key that shares more with key i than that one does is inside. The two keys compared then lie on either side
    // of key i and cannot first differ from it in the same bit, so comparing the differences as numbers compares
    // their highest bits.
    bool up = true;
    KeyDifference outside{~0ull, ~0u};
    if (i > 0) {
      const KeyDifference before = difference(i, i - 1), after = difference(i, i + 1);
      up = after < before;
      outside = up ? before : after;
    }
    const uint32_t room = up ? count - 1 - i : i;  // Steps from i to the end of the array.
    const auto at = [&](uint32_t steps) { return up ? i + steps : i - steps; };
    const auto inside = [&](uint32_t steps) { return steps <= room && difference(i, at(steps)) < outside; };

    uint32_t bound = 2;  // Steps that are too many; never past 2^31, as a tree has at most 2^30 keys.
    while (inside(bound)) bound *= 2;
    uint32_t length = bound / 2;  // Steps to the range's other end.
    for (uint32_t step = bound / 4; step; step /= 2)
      if (inside(length + step)) length += step;

    // The split is where the highest bit changes in which the range's two ends differ.
    const KeyDifference ends = difference(i, at(length));
    const auto sameSide = [&](uint32_t steps) {
      const KeyDifference d = difference(i, at(steps));
      return ends.key ? (d.key ^ ends.key) > d.key : (d.place ^ ends.place) > d.place;
    };
    uint32_t split = 0;  // The furthest from i that is on its side.
    for (uint32_t step = bound / 2; step; step /= 2)
      if (split + step < length && sameSide(split + step)) split += step;

    const uint32_t gamma = up ? i + split : i - split - 1;  // The left child's last leaf.
    const uint32_t first = up ? i : i - length, last = up ? i + length : i;
    return {first == gamma ? count - 1 + gamma : gamma, last == gamma + 1 ? count + gamma : gamma + 1};
  }
};

}  // namespace copse
