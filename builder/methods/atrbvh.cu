// Agglomerative treelet restructuring: the tree of lbvh, its treelets of nine leaves rebuilt by joining the closest,
// where that lowers the cost, in two rounds. Domingues and Pedrini 2015. O(n).
#include "builder/method.h"
#include "builder/methods/lbvh.h"
#include "builder/optimise/treelets/agglomerative.h"
#include "builder/optimise/treelets/rounds.h"

namespace copse {

namespace {

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

}  // namespace

namespace methods {

Method atrbvh() {
  return {
      .name = "atrbvh",
      .source = "Domingues and Pedrini 2015",
      .meaning = "lbvh with treelets of nine leaves rebuilt by joining what is closest",
      .family = "treelets",
      .page = "docs/builders/atrbvh.md",
      .build = buildAtrbvh,
      .parameters = {{.name = "atrbvh.rounds",
                      .standard = 2,
                      .min = 0,
                      .max = 25,
                      .meaning = "passes over the tree; each doubles the triangles below a treelet"},
                     {.name = "atrbvh.treelet", .standard = 9, .min = 3, .max = 20, .meaning = "leaves of a treelet"}}};
}

}  // namespace methods

}  // namespace copse
