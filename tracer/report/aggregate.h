// From runs to what a table prints: the median over repetitions, then the mean over views. One Row per scene and
// builder.
#pragma once

#include <map>
#include <string>
#include <vector>

#include "tracer/report/builders.h"
#include "tracer/report/load.h"

namespace copse::report {

/// `value` with its minimum and maximum: of the repetitions for one view, the mean of those for several.
struct Value {
  double value = missing, low = missing, high = missing;
  int views = 0, runs = 0;
  bool known() const { return report::known(value); }
  /// Half the range, relative to the value.
  double spread() const { return (high - low) / (2 * value); }
};

/// The middle of the known ones; of an even count the mean of the two in the middle. NaN of none.
double median(std::vector<double> values);

/// The median of each view's values with its range, then the mean over the views.
Value overViews(const std::map<std::string, std::vector<double>>& values);

struct Row {
  std::string label, builder;
  bool ideal = false;  ///< Made of the ideal builder's: its build counts as nothing.
  Facts parameters;
  Value cost, rate, build;
  std::array<Value, 3> rates, rays;
  std::map<int, Value> total, render;  ///< By samples per pixel.
  Numbers buildPhases;                 ///< Median of each; in the order of the first run.
  Numbers renderPhases;                ///< Those of the longest renders: medians, then means over the views.
  double nodes = missing, leaves = missing, depth = missing, overlap = missing;
  double treeBytes = missing, buildPeakBytes = missing;
  std::array<double, 3> nodesPerRay{missing, missing, missing}, trianglesPerRay{missing, missing, missing};
  int runs = 0;

  double parameter(const std::string& name) const;
  const Value* totalAt(int spp) const;
};

struct Scene {
  std::string name;   ///< With size or device where a folder has several of them.
  std::string plain;  ///< The scene's own name.
  double triangles = missing;
  bool generated = false, onGpu = false;
  int width = 0, height = 0;
  std::vector<std::string> views;
  std::vector<Row> rows;  ///< The ideal row first, then in the order of builderRank.

  const Row* find(const std::string& label) const;
  /// The row that others are set against.
  const Row* baseline() const { return find(baselineBuilder); }
  const Row* ideal() const;
};

struct Results {
  Loaded loaded;
  std::vector<Scene> scenes;  ///< In the order of the file.
  std::vector<int> spp;       ///< All that occur, ascending; none where nothing was rendered.

  bool asksFor(const std::string& figure) const;
};

Results aggregate(Loaded loaded);

}  // namespace copse::report
