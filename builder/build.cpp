// From triangles to the tree that is traversed, stage by stage.
#include "builder/build.h"

#include <fmt/format.h>

#include "builder/base/error.h"
#include "builder/collapse/chosen_leaves.h"

namespace copse {

Parameters withPreset(const BuilderEntry& builder, const Parameters& chosen) {
  Parameters parameters = chosen;
  for (const auto& [name, value] : builder.preset)
    if (!chosen.isSet(name)) parameters.set(name, value);
  if (builder.method->derive) builder.method->derive(parameters, chosen);
  return parameters;
}

OpenTree buildOpenTree(const Device& device, const Primitives& primitives, const BuilderEntry& builder,
                       const Parameters& parameters, const OptimiserNames& optimisers) {
  const auto requireFew = [](uint32_t count, const char* what) {
    if (count > maxReferences)
      throw InputError(fmt::format("{} {} exceed a tree's maximum of {}", count, what, maxReferences));
  };
  requireFew(primitives.count, "triangles");
  if (primitives.count == 0) return {};
  OpenTree tree = builder.method->build(device, primitives, parameters);
  requireFew(tree.referenceCount, "references to triangles");
  tree.triangleCount = primitives.triangleCount();
  optimise(device, tree, primitives, builder.method->optimisers, parameters);
  optimise(device, tree, primitives, optimisers, parameters);
  if (primitives.triangleOf) referToTriangles(device, primitives.triangleOf, tree);
  return tree;
}

Bvh collapseAndLayout(const Device& device, OpenTree tree, const Parameters& parameters) {
  if (tree.nodeCount == 0) return {};
  const ChosenLeaves chosen = chooseLeaves(device, tree, leafRuleOf(parameters));
  return layOut(device, std::move(tree), chosen);
}

Bvh buildBvh(const Device& device, const TrianglesView& triangles, const BuilderEntry& builder,
             const Parameters& parameters, const BuildOptions& options) {
  OpenTree tree;
  {
    const OwnedPrimitives primitives = primitivesOf(device, triangles);
    tree = buildOpenTree(device, primitives.view(), builder, parameters, options.optimisers);
  }  // The stages that follow may have the boxes' memory.
  Bvh bvh = collapseAndLayout(device, std::move(tree), parameters);
  if (options.keepParents) linkParents(device, bvh);
  return bvh;
}

}  // namespace copse
