// The options of `copse render`, and what is wrong with one by itself or with two that do not go together.
#pragma once

#include <optional>

#include "tracer/cli/options.h"
#include "tracer/cli/render_files.h"
#include "tracer/session/pictures.h"

namespace copse::cli {

struct RenderCommand {
  RenderFiles files;
  float exposure = 0;
  bool aov = false, quiet = false, countTraversal = false, endPointOverlap = false;
  std::optional<int> clusterLevel;
  std::optional<double> heatMax;
  RenderOptions render;
  BuilderOptions builder;
  DeviceOptions device;

  void add(CommandLine& command);
  /// Throws InputError; `chosen` is what was asked for as the builder.
  void check(const TreeSource& chosen) const;
  const std::string& integrator() const { return files.integrator; }
};

/// The surface buffer that an integrator's name asks for.
std::optional<SurfacePicture> surfacePicture(const std::string& integrator);

/// Whether it makes an image of light.
bool rendersLight(const std::string& integrator);

}  // namespace copse::cli
