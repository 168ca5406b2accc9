// Names → integrators. Adding one is a file or a folder here and a row in registry.cpp; tests, `copse list`, the
// command line and reports find it there.
#pragma once

#include <span>
#include <string_view>

#include "tracer/integrators/integrator.h"

namespace copse {

/// In the order in which they are listed; the first is the default of a render, and what a bench measures.
std::span<const IntegratorEntry* const> integrators();

/// Null if there is none of that name.
const IntegratorEntry* integratorNamed(std::string_view name);
/// Throws InputError that lists the names.
const IntegratorEntry& findIntegrator(std::string_view name);

/// Whether the builder can show its clusters.
bool hasClusters(const BuilderEntry& builder);

/// Throws InputError where the integrator cannot use the tree.
void checkTree(const IntegratorEntry& integrator, const TreeSource& source);

}  // namespace copse
