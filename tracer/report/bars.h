// Horizontal bars in groups: one row per method, its name to the left and its value at the end of the bar.
#pragma once

#include <string>
#include <vector>

#include "tracer/report/page.h"

namespace copse::report {

struct Bar {
  std::string group, label;
  unsigned color = 0;
  double value = missing, low = missing, high = missing;
};

struct BarGroup {
  std::string title;
  std::vector<Bar> bars;
};

/// Bars from zero. With `reference` a line at 1, and bars longer than three times that are cut and say so. `columns`
/// are the CSV's: group, label, value, low, high.
Panel barPanel(const std::string& name, const std::string& title, const std::string& axis, const std::string& alt,
               const std::vector<BarGroup>& groups, bool reference, const std::vector<std::string>& columns);

}  // namespace copse::report
