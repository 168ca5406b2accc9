// Agglomerative treelet restructuring: a tree's treelets of nine leaves rebuilt by joining the closest, where that
// lowers the cost, in two rounds. Domingues and Pedrini 2015. O(n).
#include "builder/optimise/treelets/agglomerative.h"

#include "builder/optimise/optimiser.h"
#include "builder/optimise/treelets/rounds.h"

namespace copse {

namespace {

void run(const Device& device, OpenTree& tree, const Primitives&, const Parameters& parameters) {
  const auto size = static_cast<uint32_t>(parameters.integer("atrbvh.treelet"));
  const auto rounds = static_cast<int>(parameters.integer("atrbvh.rounds"));
  const LeafRule costs = leafRuleOf(parameters);
  if (size <= 9)
    treelets::restructure(device, tree, costs, treelets::AgglomeratedTreelets<9>{size}, rounds, size);
  else
    treelets::restructure(device, tree, costs, treelets::AgglomeratedTreelets<20>{size}, rounds, size);
}

}  // namespace

namespace optimisers {

Optimiser treeletsAgglomerative() {
  return {
      .name = "treelets-agglomerative",
      .source = "Domingues and Pedrini 2015",
      .meaning = "treelets of nine leaves rebuilt by agglomeration, where that lowers the cost",
      .run = run,
      .binaryOnly = true,
      .parameters = {{.name = "atrbvh.rounds",
                      .standard = 2,
                      .min = 0,
                      .max = 25,
                      .meaning = "passes over the tree; each doubles the triangles below a treelet"},
                     {.name = "atrbvh.treelet", .standard = 9, .min = 3, .max = 20, .meaning = "leaves per treelet"}}};
}

}  // namespace optimisers

}  // namespace copse
