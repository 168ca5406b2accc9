// The table of integrators: one row each.
#include "tracer/integrators/registry.h"

#include <fmt/format.h>

#include "builder/base/error.h"
#include "builder/registry.h"

namespace copse {

extern const IntegratorEntry pathIntegrator, referenceIntegrator, normalsIntegrator, albedoIntegrator, depthIntegrator,
    heatmapIntegrator, clustersIntegrator;

std::span<const IntegratorEntry* const> integrators() {
  static constexpr const IntegratorEntry* table[] = {&pathIntegrator,    &referenceIntegrator, &normalsIntegrator,
                                                     &albedoIntegrator,  &depthIntegrator,     &heatmapIntegrator,
                                                     &clustersIntegrator};
  return table;
}

const IntegratorEntry* integratorNamed(std::string_view name) {
  for (const IntegratorEntry* entry : integrators())
    if (name == entry->name) return entry;
  return nullptr;
}

const IntegratorEntry& findIntegrator(std::string_view name) {
  if (const IntegratorEntry* entry = integratorNamed(name)) return *entry;
  std::string names;
  for (const IntegratorEntry* entry : integrators())
    names += fmt::format("{}{}", names.empty() ? "" : ", ", entry->name);
  throw InputError(fmt::format("unknown integrator '{}' (available: {})", name, names));
}

bool hasClusters(const BuilderEntry& builder) { return builder.method->passClusters != nullptr; }

namespace {

std::string methodsWithClusters() {
  std::string names;
  for (const Method& method : methods::all())
    if (method.passClusters) names += (names.empty() ? "" : ", ") + std::string(method.name);
  return names;
}

}  // namespace

void checkTree(const IntegratorEntry& integrator, const TreeSource& source) {
  if (integrator.tree == TreeUse::clusters && (source.isOwnTree() || !hasClusters(source.builder())))
    throw InputError(fmt::format("--integrator {}: builder {} makes no clusters (expected {} or one of its presets)",
                                 integrator.name, source.name(), methodsWithClusters()));
  if (integrator.tree == TreeUse::counted && source.isOwnTree())
    throw InputError(
        fmt::format("--integrator {}: the tree of {} cannot be inspected", integrator.name, source.name()));
}

}  // namespace copse
