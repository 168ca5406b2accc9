// The method itself, with its settings as a struct: what buildKmeans calls, and tests.
#pragma once

#include "builder/method.h"
#include "builder/methods/kmeans/clusters.h"

namespace copse::kmeans {

Settings settingsOf(const Parameters& parameters);

/// One triangle a leaf, with parents. `input.count` may be 0.
OpenTree build(const Device& device, const Primitives& input, const Settings& settings);

class PassWatch;
/// Its passes alone, as long as `watch` wants more of them. No tree is made.
void watchPasses(const Device& device, const Primitives& input, const Settings& settings, PassWatch& watch);

}  // namespace copse::kmeans
