// Results as they are read: one Run a record, and what the experiment was. What was not measured is NaN or empty.
#pragma once

#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

namespace copse::report {

constexpr double missing = std::numeric_limits<double>::quiet_NaN();
inline bool known(double value) { return std::isfinite(value); }

/// Names and numbers in the order of the file.
using Numbers = std::vector<std::pair<std::string, double>>;
/// Names and texts, such as {"cpu", "…"}; numbers are written out.
using Facts = std::vector<std::pair<std::string, std::string>>;

/// Kinds of rays, in the order of every array here.
constexpr std::array<const char*, 3> rayKinds{"primary", "bounce", "shadow"};

/// One build and one render. Times in milliseconds, rates in millions of rays per second, sizes in bytes.
struct Run {
  std::string scene, view, builder, label, error;
  bool failed = false, generated = false;
  int repetition = 1, width = 0, height = 0, spp = 0;
  double triangles = missing;
  Facts parameters, device, machine, compiler, program, settings;
  double cost = missing, nodes = missing, leaves = missing, depth = missing, overlap = missing;
  double treeBytes = missing, buildPeakBytes = missing;
  double build = missing, render = missing, total = missing;
  Numbers buildPhases, renderPhases;
  std::array<double, 3> rays{missing, missing, missing}, rates{missing, missing, missing};
  double rate = missing;  ///< Over all kinds together.
  std::array<double, 3> nodesPerRay{missing, missing, missing}, trianglesPerRay{missing, missing, missing};
  std::string time, integrator;
  int warmUp = -1;

  /// A parameter as a number, or NaN.
  double parameter(const std::string& name) const;
  bool onGpu() const;
};

struct Experiment {
  std::string name, title, description, config, started, finished;
  int planned = -1;
  Facts machine, compiler;
  Facts leftOut;                    ///< {"scene conference", why}: what was asked for and could not be measured.
  std::vector<std::string> report;  ///< Figures asked for; none: all that the results allow.
};

struct Loaded {
  std::string folder, source;  ///< `source`: the file that the runs come from.
  Experiment experiment;
  std::vector<Run> runs;
};

/// Throws InputError "FILE:LINE: what" for what is no JSON, and for a record with a value of the wrong kind.
Loaded load(const std::string& folder);

}  // namespace copse::report
