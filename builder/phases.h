// The phases of a build: one place for the names that its stages launch under, and for the groups that figures know
// them by. What runs inside one of them needs no more than a text of its own.
#pragma once

#include "builder/parallel/timeline.h"

namespace copse {

namespace groups {

inline constexpr PhaseGroup boxes{"boxes"}, sorting{"sorting"}, hierarchy{"hierarchy"}, sweep{"sweep"},
    treelets{"treelets"}, agglomeration{"agglomeration"}, collapseAndLayout{"collapse, layout"};
/// The steps of k-means in the paper's terms: figures of k-means alone tell them apart.
inline constexpr PhaseGroup kmeans{"k-means"};
inline constexpr PhaseGroup representatives{"representatives", &kmeans}, kmeansLoop{"k-means loop", &kmeans},
    clusterSizes{"cluster sizes", &kmeans}, tasks{"tasks, reorder", &kmeans};

}  // namespace groups

namespace phases {

inline constexpr PhaseName boxes{"boxes", &groups::boxes};
inline constexpr PhaseName morton{"morton", &groups::sorting}, sort{"sort", &groups::sorting};
inline constexpr PhaseName hierarchy{"hierarchy", &groups::hierarchy};
inline constexpr PhaseName mortonClusters{"clusters", &groups::hierarchy}, topTree{"top tree", &groups::hierarchy};
inline constexpr PhaseName sweep{"sweep", &groups::sweep};
inline constexpr PhaseName fit{"fit", &groups::hierarchy}, treelets{"treelets", &groups::treelets};
inline constexpr PhaseName clustering{"clustering", &groups::agglomeration};
inline constexpr PhaseName collapse{"collapse", &groups::collapseAndLayout};
inline constexpr PhaseName layout{"layout", &groups::collapseAndLayout};

inline constexpr PhaseName initialise{"initialise", &groups::boxes};
inline constexpr PhaseName representatives{"representatives", &groups::representatives};
inline constexpr PhaseName assignAndSum{"assign and sum", &groups::kmeansLoop};
inline constexpr PhaseName normalise{"normalise", &groups::kmeansLoop};
inline constexpr PhaseName clusterSizes{"cluster sizes", &groups::clusterSizes};
inline constexpr PhaseName tasks{"tasks", &groups::tasks}, reorder{"reorder", &groups::tasks};
inline constexpr PhaseName leafQueue{"leaf queue", &groups::tasks}, leaves{"leaves", &groups::tasks};
inline constexpr PhaseName agglomerate{"agglomerate", &groups::agglomeration};

/// In the order in which figures stack their groups.
inline constexpr PhaseName ofBuilds[] = {boxes,      initialise,   morton,   sort,     hierarchy,       mortonClusters,
                                         topTree,    fit,          sweep,    treelets, representatives, assignAndSum,
                                         normalise,  clusterSizes, tasks,    reorder,  leafQueue,       leaves,
                                         clustering, agglomerate,  collapse, layout};

}  // namespace phases

}  // namespace copse
