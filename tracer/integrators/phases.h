// The phases that renders share. Ray rates are over the phases of the ray groups; figures have one colour per group.
#pragma once

#include "builder/parallel/timeline.h"

namespace copse {

namespace groups {

inline constexpr PhaseGroup generate{"generate"}, primaryRays{"trace primary"}, bounceRays{"trace bounce"},
    shade{"shade"}, shadowRays{"trace shadow"}, accumulate{"accumulate"};
/// What pictures other than light take besides their camera rays.
inline constexpr PhaseGroup pictures{"pictures"};

}  // namespace groups

namespace phases {

inline constexpr PhaseName generate{"generate", &groups::generate};
inline constexpr PhaseName tracePrimary{"trace primary", &groups::primaryRays};
inline constexpr PhaseName traceBounce{"trace bounce", &groups::bounceRays};
inline constexpr PhaseName shade{"shade", &groups::shade};
inline constexpr PhaseName traceShadow{"trace shadow", &groups::shadowRays};
inline constexpr PhaseName accumulate{"accumulate", &groups::accumulate};

}  // namespace phases

}  // namespace copse
