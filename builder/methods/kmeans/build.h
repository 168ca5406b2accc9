// The method itself, with its settings as a struct: what buildKmeans calls, and tests.
#pragma once

#include "builder/method.h"
#include "builder/methods/kmeans/clusters.h"
#include "builder/phases.h"

namespace copse::kmeans {

/// The steps of k-means in the paper's terms: figures of k-means alone tell these groups apart.
namespace groups {
inline constexpr PhaseGroup kmeans{"k-means"};
inline constexpr PhaseGroup representatives{"representatives", &kmeans}, loop{"k-means loop", &kmeans},
    clusterSizes{"cluster sizes", &kmeans}, tasks{"tasks, reorder", &kmeans};
}  // namespace groups

namespace phases {
inline constexpr PhaseName initialise{"initialise", &copse::groups::boxes};
inline constexpr PhaseName representatives{"representatives", &groups::representatives};
inline constexpr PhaseName assignAndSum{"assign and sum", &groups::loop}, normalise{"normalise", &groups::loop};
inline constexpr PhaseName clusterSizes{"cluster sizes", &groups::clusterSizes};
inline constexpr PhaseName tasks{"tasks", &groups::tasks}, reorder{"reorder", &groups::tasks};
inline constexpr PhaseName leafQueue{"leaf queue", &groups::tasks}, leaves{"leaves", &groups::tasks};
inline constexpr PhaseName agglomerate{"agglomerate", &copse::groups::agglomeration};

inline constexpr PhaseName all[] = {initialise, representatives, assignAndSum, normalise, clusterSizes,
                                    tasks,      reorder,         leafQueue,    leaves,    agglomerate};
}  // namespace phases

Settings settingsOf(const Parameters& parameters);

/// One triangle per leaf, with parents. `input.count` may be 0.
OpenTree build(const Device& device, const Primitives& input, const Settings& settings);

class PassWatch;
/// Its passes alone, as long as `watch` wants more of them. No tree is made.
void watchPasses(const Device& device, const Primitives& input, const Settings& settings, PassWatch& watch);

}  // namespace copse::kmeans
