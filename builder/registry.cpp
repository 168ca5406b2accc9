// The methods of builder/methods/CMakeLists.txt under all of their names, and the parameters that a build reads.
#include "builder/registry.h"

#include <fmt/format.h>

#include "builder/base/error.h"
#include "builder/collapse/leaf_rule.h"
#include "builder/phases.h"
#include "builder/primitives/morton_order.h"

namespace copse {

std::span<const BuilderEntry> builders() {
  static const std::vector<BuilderEntry> table = [] {
    std::vector<BuilderEntry> rows;
    for (const Method& method : methods::all()) {
      if (!method.presetsOnly) rows.push_back({method.name, method.source, method.meaning, &method, {}});
      for (const Preset& preset : method.presets)
        rows.push_back({preset.name, method.source, preset.meaning, &method, preset.settings});
    }
    return rows;
  }();
  return table;
}

const BuilderEntry& findBuilder(std::string_view name) {
  std::vector<const char*> names;
  for (const BuilderEntry& entry : builders()) {
    if (name == entry.name) return entry;
    names.push_back(entry.name);
  }
  throw InputError(fmt::format("unknown builder '{}' (available: {})", name, fmt::join(names, ", ")));
}

const std::vector<PhaseName>& phasesOfBuilds() {
  static const std::vector<PhaseName> table = [] {
    std::vector<PhaseName> all{phases::boxes, phases::morton, phases::sort, phases::hierarchy, phases::fit};
    for (const Method& method : methods::all()) all.insert(all.end(), method.phases.begin(), method.phases.end());
    all.push_back(phases::treelets);
    for (const Optimiser& optimiser : optimisers::all())
      all.insert(all.end(), optimiser.phases.begin(), optimiser.phases.end());
    all.insert(all.end(), {phases::collapse, phases::layout, phases::widen});
    return all;
  }();
  return table;
}

std::span<const ParameterSpec> builderParameters() {
  static const std::vector<ParameterSpec> table = [] {
    std::vector<ParameterSpec> all;
    const auto append = [&](const std::vector<ParameterSpec>& more) {
      all.insert(all.end(), more.begin(), more.end());
    };
    append(leafParameters());
    append(mortonParameters());
    for (const Optimiser& optimiser : optimisers::all()) append(optimiser.parameters);
    for (const Method& method : methods::all()) append(method.parameters);
    return all;
  }();
  return table;
}

}  // namespace copse
