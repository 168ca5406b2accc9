// Table 1 of the paper that Copse follows: D. Meister, J. Bittner, "Parallel BVH Construction using k-means
// Clustering", The Visual Computer 32, 2016. GTX TITAN Black, 1024x768, c_T = 3, c_I = 2, mean of three views.
#pragma once

#include <span>

#include "tracer/report/aggregate.h"

namespace copse::report {

constexpr int paperWidth = 1024, paperHeight = 768;

/// NaN: the paper has no value there, or it is not legible in the copy at hand.
struct PaperRow {
  const char* scene;
  double thousandTriangles;
  const char* builder;
  double cost, rate, build, total8, total128;
};

std::span<const PaperRow> paperTable();

/// The paper's row for a builder on a scene of that name, or nullptr. "sah" is the idealised one, and only that.
const PaperRow* paperRow(const Scene& scene, const Row& row);
/// The paper's row that others are set against.
const PaperRow* paperBaseline(const Scene& scene);

/// The very mesh of the paper: its name, not generated, and its number of triangles within two in a hundred.
bool isPapersMesh(const Scene& scene);

}  // namespace copse::report
