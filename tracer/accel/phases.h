// The phases in which tracers make what rays read: part of the build.
#pragma once

#include "builder/phases.h"

namespace copse {

namespace groups {
inline constexpr PhaseGroup embree{"embree"};
}

namespace phases {

inline constexpr PhaseName traversalLayout{"traversal layout", &groups::collapseAndLayout};
inline constexpr PhaseName embree{"embree", &groups::embree};

inline constexpr PhaseName ofTracers[] = {traversalLayout, embree};

}  // namespace phases

}  // namespace copse
