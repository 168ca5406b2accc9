// What the surface area heuristic charges: the two parameters in one place.
#pragma once

#include "builder/parameters.h"

namespace copse {

/// Per visit of an inner node (cT) and per ray-triangle test (cI). Their ratio alone decides about a tree.
struct SahCosts {
  double traversal, intersection;
};

inline SahCosts sahCostsOf(const Parameters& parameters) {
  return {parameters.real("sah.traversal"), parameters.real("sah.intersection")};
}

}  // namespace copse
