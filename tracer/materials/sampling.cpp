// Walker's alias table, built with Vose's two worklists in double precision.
#include "tracer/materials/sampling.h"

#include <algorithm>
#include <cmath>

namespace copse {

std::vector<AliasCell> aliasTable(std::span<const double> weights) {
  const auto usable = [](double w) { return std::isfinite(w) && w > 0 ? w : 0.0; };
  double sum = 0;
  std::size_t heaviest = 0;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    sum += usable(weights[i]);
    if (usable(weights[i]) > usable(weights[heaviest])) heaviest = i;
  }
  if (!(sum > 0) || !std::isfinite(sum)) return {};

  const std::size_t n = weights.size();
  std::vector<AliasCell> cells(n);
  std::vector<double> share(n);  // In cells of the table: what is left to hand out.
  std::vector<uint32_t> small, large;
  for (std::size_t i = 0; i < n; ++i) {
    const double probability = usable(weights[i]) / sum;
    share[i] = probability * static_cast<double>(n);
    cells[i] = {1.0f, static_cast<uint32_t>(i), static_cast<float>(probability)};
    (share[i] < 1 ? small : large).push_back(static_cast<uint32_t>(i));
  }
  while (!small.empty() && !large.empty()) {
    const uint32_t s = small.back(), l = large.back();
    small.pop_back();
    cells[s].threshold = static_cast<float>(share[s]);
    cells[s].alias = l;
    share[l] -= 1 - share[s];
    if (share[l] < 1) {
      large.pop_back();
      small.push_back(l);
    }
  }
  // Cells that rounding leaves over have a share of 1, except for entries that must never be picked.
  for (const uint32_t s : small)
    if (cells[s].probability == 0) cells[s] = {0.0f, static_cast<uint32_t>(heaviest), 0.0f};
  return cells;
}

}  // namespace copse
