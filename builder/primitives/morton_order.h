// Boxes in the order of their centres' Morton codes: what the linear builders start from.
#pragma once

#include "builder/open_tree.h"
#include "builder/parameters.h"
#include "builder/primitives/primitives.h"

namespace copse {

struct MortonOrder {
  Buffer<uint64_t> keys;   ///< Ascending codes of 3 × `bits` bits.
  Buffer<uint32_t> order;  ///< Indices of boxes; equal codes by ascending index.
  int bits = 0;            ///< An axis.
};

/// By codes of `bits` bits per axis over the scene box, or over the cube around it. Phases "morton" and "sort".
/// `input.count` > 0. O(n).
MortonOrder mortonOrder(const Device& device, const Primitives& input, int bits, bool cube);
/// The same as morton.bits and morton.scale say.
MortonOrder mortonOrder(const Device& device, const Primitives& input, const Parameters& parameters);

/// Those two.
std::vector<ParameterSpec> mortonParameters();

/// A tree over the boxes of `sorted`, whose order it takes: room for 2n-1 nodes and their parents, not yet linked.
OpenTree treeOver(const Device& device, MortonOrder& sorted);

}  // namespace copse
