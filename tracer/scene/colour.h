// Colours of a screen (sRGB, IEC 61966-2-1) as light.
#pragma once

#include <cmath>

namespace copse {

/// What is sent to a screen, 0 … 1, as linear light.
inline float linearOfScreen(float s) { return s <= 0.04045f ? s / 12.92f : std::pow((s + 0.055f) / 1.055f, 2.4f); }

}  // namespace copse
