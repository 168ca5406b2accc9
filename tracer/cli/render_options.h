// The options of `copse render`, and the checks on each and on combinations.
#pragma once

#include <map>
#include <optional>

#include "tracer/cli/options.h"
#include "tracer/cli/render_files.h"
#include "tracer/integrators/registry.h"

namespace copse::cli {

struct RenderCommand {
  RenderFiles files;
  float exposure = 0;
  bool aov = false, quiet = false, resume = false, countTraversal = false, endPointOverlap = false;
  /// Integrators' own options.
  std::map<const IntegratorOption*, std::optional<int>> integers;
  std::map<const IntegratorOption*, std::optional<double>> numbers;
  SceneOptions scene;
  RenderOptions render;
  BuilderOptions builder;
  DeviceOptions device;

  void add(CommandLine& command);
  /// Throws InputError; `chosen` is what --builder names.
  void check(const TreeSource& chosen) const;
  /// Throws InputError if there is none of that name.
  const IntegratorEntry& integrator() const { return findIntegrator(files.integrator); }
  IntegratorOptions integratorOptions() const;
};

}  // namespace copse::cli
