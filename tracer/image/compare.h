// How two images differ.
#pragma once

#include "tracer/scene/image.h"

namespace copse {

struct Difference {
  double rmse = 0;         ///< Root of the mean squared difference over pixels and channels.
  double relMse = 0;       ///< Mean of (a-b)² / (b² + 0.01).
  double flip = 0;         ///< Mean perceptual difference, 0 … 1 (Andersson et al. 2020).
  double maxError = 0;     ///< Largest difference of a channel.
  double meanA = 0, meanB = 0;
  int blocks = 0;          ///< 16x16 blocks compared.
  double blockRms = 0;     ///< Root mean square of the blocks' differences of means over their standard errors: about 1 where only noise differs.
  double blockWorst = 0;   ///< The largest of them.
};

/// Throws InputError where the sizes differ. `flipMap`, if not null, receives the difference per pixel as a heat map.
Difference compareImages(const Image& a, const Image& b, Image* flipMap = nullptr);

}  // namespace copse
