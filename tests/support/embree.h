// Whether this build has Embree's trees: where its library was not found, tests of them are skipped.
#pragma once

#include <algorithm>

#include "tracer/accel/tracers.h"

namespace copse::test {

inline bool hasEmbree() {
  return std::ranges::any_of(tracers(), [](const TracerEntry& entry) { return !entry.ownTrees.empty(); });
}

}  // namespace copse::test
