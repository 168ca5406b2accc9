// Agglomerative treelet restructuring: the tree of lbvh, its treelets of nine leaves rebuilt by joining what is closest,
// where that lowers the cost, in two rounds. Domingues and Pedrini 2015. O(n).
#include "builder/methods/methods.h"
#include "builder/methods/treelets/agglomerative.h"
#include "builder/methods/treelets/rounds.h"

namespace copse {

Bvh buildAtrbvh(const Device& device, const BuildInput& input, const Parameters& parameters) {
  Bvh bvh = buildLbvh(device, input, parameters);
  const auto size = static_cast<uint32_t>(parameters.integer("atrbvh.treelet"));
  treelets::restructure(device, bvh, treelets::costsOf(parameters), treelets::AgglomeratedTreelets{size},
                        static_cast<int>(parameters.integer("atrbvh.rounds")), size);
  return bvh;
}

}  // namespace copse
