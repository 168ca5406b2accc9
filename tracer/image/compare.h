// How two images differ: a render and its reference, or the same scene by two renderers.
#pragma once

#include "tracer/scene/image.h"

namespace copse {

/// rmse, relMse and maxError are infinite where a pixel is finite in only one image, and FLIP is 1 at that pixel.
struct Difference {
  double rmse = 0;      ///< Root of the mean squared difference over pixels and channels.
  double relMse = 0;    ///< Mean of (a-b)² / (b² + 0.01).
  double flip = 0;      ///< Mean perceptual difference, 0 … 1 (Andersson et al. 2020), b giving the exposures.
  double maxError = 0;  ///< Largest difference of a channel.
  double meanA = 0, meanB = 0;
  int badPixels = 0;  ///< Not finite in one image or both; elsewhere left out.
  int blocks = 0;     ///< 16x16 blocks compared; those at the border count if they hold 64 pixels.
  /// Root mean square over blocks of the mean of a-b over its standard error, which the block's own pixels give:
  /// about 1 where only noise differs.
  double blockRms = 0;
  double blockWorst = 0;  ///< The largest of these ratios.
  double blockBias = 0;   ///< Their sum over the root of their number: about -2 … 2 where only noise differs.
};

/// b is the reference. Throws InputError where the sizes differ or there are no pixels. `flipMap`, if not null,
/// receives the difference per pixel as a heat map, dark for none.
Difference compareImages(const Image& a, const Image& b, Image* flipMap = nullptr);

/// The heat map's colour, linear RGB, for 0 … 1: its luminance rises all the way.
vec3 heatColour(float value);

}  // namespace copse
