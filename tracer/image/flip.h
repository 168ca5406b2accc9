// FLIP: how different two images look to someone who flips between them.
#pragma once

#include <vector>

#include "tracer/scene/image.h"

namespace copse {

/// A screen of 3840 pixels on 0.7 m, seen from 0.7 m: what the paper takes.
inline constexpr double flipPixelsPerDegree = 67.0206;

/// Per pixel 0 … 1 for two displayed images: linear RGB of sRGB's primaries in [0, 1], of equal size. Symmetric.
std::vector<float> flip(const Image& a, const Image& b, double pixelsPerDegree = flipPixelsPerDegree);

/// The same for renders: both are exposed and tone mapped over the range of exposures that show `reference` well, and
/// each pixel has the largest difference of them. Pixels must be finite and not negative.
std::vector<float> flipHdr(const Image& image, const Image& reference, double pixelsPerDegree = flipPixelsPerDegree);

}  // namespace copse
