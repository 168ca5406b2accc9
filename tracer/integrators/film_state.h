// What a film holds once some samples are in it, exactly: enough to go on as if the render had never stopped. The means
// of an image are not, since dividing a sum by its number of samples rounds.
#pragma once

#include <cstdint>
#include <vector>

#include "builder/math/vec.h"

namespace copse {

/// A pixel's samples from this number on are compensated (see film.h).
constexpr uint64_t exactFilmSamples = 1024;

struct FilmState {
  uint64_t samples = 0;    ///< Over all pixels, in the order of pixel_order.h.
  std::vector<vec3> sums;  ///< By pixel, row by row; of no samples empty.
  std::vector<vec3> lost;  ///< What rounding took from each sum; empty where the film keeps none.
};

}  // namespace copse
