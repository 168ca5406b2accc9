// The phases that builds share, and the groups that figures know phases by. What a method or an optimiser alone
// launches is declared in its own file and named by its descriptor. What runs inside a phase needs no more than a text
// of its own.
#pragma once

#include <vector>

#include "builder/parallel/timeline.h"

namespace copse {

namespace groups {

inline constexpr PhaseGroup boxes{"boxes"}, sorting{"sorting"}, hierarchy{"hierarchy"}, treelets{"treelets"},
    agglomeration{"agglomeration"}, collapseAndLayout{"collapse, layout"};

}  // namespace groups

namespace phases {

inline constexpr PhaseName boxes{"boxes", &groups::boxes};
inline constexpr PhaseName morton{"morton", &groups::sorting}, sort{"sort", &groups::sorting};
inline constexpr PhaseName hierarchy{"hierarchy", &groups::hierarchy}, fit{"fit", &groups::hierarchy};
inline constexpr PhaseName treelets{"treelets", &groups::treelets};
inline constexpr PhaseName collapse{"collapse", &groups::collapseAndLayout};
inline constexpr PhaseName layout{"layout", &groups::collapseAndLayout};
inline constexpr PhaseName widen{"widen", &groups::collapseAndLayout};

}  // namespace phases

/// The phases declared here and those of every method and optimiser, in the order in which figures stack their groups.
const std::vector<PhaseName>& phasesOfBuilds();

}  // namespace copse
