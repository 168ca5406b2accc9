// Polygons that touch themselves in every way that a simple polygon's limit can, of which the area is known without any
// geometry: the outline of random cells of a lattice, their holes and islands joined by ways without width.
#pragma once

#include <cstdint>
#include <random>
#include <vector>

#include <glm/vec2.hpp>

namespace copse::test {

struct LatticePolygon {
  int width = 0, height = 0;        ///< In cells, each of 2 by 2 units, so that edges have a middle.
  std::vector<bool> cells;          ///< Whether the polygon covers the cell, rows from below.
  std::vector<glm::ivec2> outline;  ///< Counter-clockwise, with doubled corners, runs along a line, spikes and bridges.
  int coveredCells() const;
};

/// `fill` is the share of cells that are covered, 0 … 1; `spikes` how many spikes with bends are tried; `decoration`
/// the chance of each corner to be doubled, and of each edge to be gone back along for a while.
LatticePolygon randomLatticePolygon(std::mt19937& random, int width, int height, double fill, int spikes,
                                    double decoration);

}  // namespace copse::test
