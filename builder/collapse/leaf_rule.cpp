// The parameters of leaves and of what they cost.
#include "builder/collapse/leaf_rule.h"

#include "builder/bvh.h"

namespace copse {

std::vector<ParameterSpec> leafParameters() {
  return {{.name = "sah.traversal",
           .standard = 3.0,
           .min = 0,
           .max = 1e6,
           .meaning = "cost of a visit to an inner node (cT)"},
          {.name = "sah.intersection",
           .standard = 2.0,
           .min = 0,
           .max = 1e6,
           .meaning = "cost of a ray-triangle test (cI)"},
          {.name = "leaf.max",
           .standard = 8,
           .min = 1,
           .max = maxLeafSize,
           .meaning = "maximum number of triangles per leaf"},
          {.name = "leaf.rule",
           .standard = "sah",
           .words = {"sah", "count"},
           .meaning = "which subtrees become leaves: sah, those where that lowers the cost; count, all of at most "
                      "leaf.max triangles"}};
}

LeafRule leafRuleOf(const Parameters& parameters) {
  const SahCosts costs = sahCostsOf(parameters);
  return {static_cast<float>(costs.traversal), static_cast<float>(costs.intersection),
          static_cast<uint32_t>(parameters.integer("leaf.max")), parameters.text("leaf.rule") == "count"};
}

}  // namespace copse
