// From triangles to the tree that is traversed: boxes, the method's tree, leaves and layout.
#include "builder/build.h"

#include <fmt/format.h>

#include "builder/base/error.h"

namespace copse {

Parameters withPreset(const BuilderEntry& builder, const Parameters& chosen) {
  Parameters parameters = chosen;
  for (const auto& [name, value] : builder.preset)
    if (!chosen.isSet(name)) parameters.set(name, value);
  if (builder.method->derive) builder.method->derive(parameters, chosen);
  return parameters;
}

Bvh buildBvh(const Device& device, const TrianglesView& triangles, const BuilderEntry& builder,
             const Parameters& parameters) {
  // Node indices are 32 bits with two of them for marks, and there are 2n-1 nodes.
  constexpr uint32_t most = 1u << 29;
  if (triangles.count > most)
    throw InputError(fmt::format("{} triangles: a tree holds at most {}", triangles.count, most));
  if (triangles.count == 0) return {};
  Buffer<Box> boxes = triangleBoxes(device, triangles);
  Bvh tree = builder.method->build(device, inputOf(boxes), parameters);
  boxes = {};  // The stages that follow may have its memory.
  return collapseAndLayout(device, std::move(tree), parameters);
}

}  // namespace copse
