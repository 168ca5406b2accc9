// What follows map_Kd and its like in an MTL: options, and the name of a file that may have blanks.
#pragma once

#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "builder/math/vec.h"

namespace copse {

struct MapLine {
  std::string file;  ///< As it is written; empty where there is none.
  vec2 scale{1, 1}, offset{0, 0};
  std::vector<std::string> ignored;  ///< Options as they are written that would change the picture, and what is none.
};

/// Options stand in front of the file's name, or behind it. Where it cannot be told what is a number and what begins a
/// name ("-s 2 2 8 ball.png"), or whether '#' begins a comment, the name that `isThere` decides.
MapLine readMapLine(std::string_view text, const std::function<bool(std::string_view)>& isThere);

}  // namespace copse
