// What measurements are summed up by.
#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

namespace copse {

/// The middle value, or the mean of both middle ones; NaN of none. No value may be NaN.
inline double median(std::vector<double> values) {
  if (values.empty()) return NAN;
  std::sort(values.begin(), values.end());
  const std::size_t half = values.size() / 2;
  return values.size() % 2 ? values[half] : (values[half - 1] + values[half]) / 2;
}

}  // namespace copse
