// Optimisers by name, and the stage that runs them.
#include "builder/optimise/optimiser.h"

#include <fmt/format.h>

#include "builder/base/error.h"

namespace copse {

const Optimiser& findOptimiser(std::string_view name) {
  std::vector<const char*> names;
  for (const Optimiser& optimiser : optimisers::all()) {
    if (name == optimiser.name) return optimiser;
    names.push_back(optimiser.name);
  }
  throw InputError(fmt::format("unknown optimiser '{}' (available: {})", name, fmt::join(names, ", ")));
}

OptimiserNames optimiserNames(std::string_view list) {
  OptimiserNames names;
  while (!list.empty()) {
    const std::size_t comma = list.find(',');
    names.emplace_back(findOptimiser(list.substr(0, comma)).name);
    if (comma == std::string_view::npos) break;
    list.remove_prefix(comma + 1);
    if (list.empty()) findOptimiser(list);  // "NAME," ends in an empty name.
  }
  return names;
}

void optimise(const Device& device, OpenTree& tree, const Primitives& primitives, const OptimiserNames& names,
              const Parameters& parameters) {
  for (const std::string& name : names) {
    const Optimiser& optimiser = findOptimiser(name);
    if (optimiser.binaryOnly && tree.arity > 2)
      throw InputError(
          fmt::format("optimiser {}: expected a binary tree, got up to {} children per node", name, tree.arity));
    if (tree.nodeCount == 0) continue;
    linkParents(device, tree);
    optimiser.run(device, tree, primitives, parameters);
  }
}

}  // namespace copse
