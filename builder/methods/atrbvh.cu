// Agglomerative treelet restructuring: the tree of lbvh, its treelets of nine leaves rebuilt by joining the closest,
// where that lowers the cost, in two rounds. Domingues and Pedrini 2015. O(n).
#include "builder/methods/methods.h"
#include "builder/optimise/treelets/agglomerative.h"
#include "builder/optimise/treelets/rounds.h"

namespace copse {

Bvh buildAtrbvh(const Device& device, const BuildInput& input, const Parameters& parameters) {
  Bvh bvh = buildLbvh(device, input, parameters);
  const auto size = static_cast<uint32_t>(parameters.integer("atrbvh.treelet"));
  const auto rounds = static_cast<int>(parameters.integer("atrbvh.rounds"));
  const treelets::Costs costs = treelets::costsOf(parameters);
  if (size <= 9)
    treelets::restructure(device, bvh, costs, treelets::AgglomeratedTreelets<9>{size}, rounds, size);
  else
    treelets::restructure(device, bvh, costs, treelets::AgglomeratedTreelets<20>{size}, rounds, size);
  return bvh;
}

}  // namespace copse
