// Options that several sub-commands share, with checks whose messages name the option.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "builder/registry.h"
#include "tracer/accel/tracers.h"
#include "tracer/cli/command_line.h"
#include "tracer/integrators/settings.h"
#include "tracer/scene/scene.h"

namespace copse::cli {

/// --device and --threads.
struct DeviceOptions {
  std::string device = "auto";
  int threads = 0;
  void add(CommandLine& command);
  /// Threads beyond four per processor are not started; a note says so unless `quiet`.
  Device open(bool quiet = false) const;
};

/// --up, and --sky-rotation where a scene is rendered.
struct SceneOptions {
  std::string up = "y";
  std::optional<double> skyRotation;
  void add(CommandLine& command);
  void addSky(CommandLine& command);
  /// Throws InputError that names the option.
  LoadOptions load() const;
};

/// --builder, --tracer, --set and --optimise.
struct BuilderOptions {
  std::string name, tracerName = "auto", optimise;
  std::vector<std::string> settings;
  void add(CommandLine& command);
  TreeSource source() const;
  /// Throws InputError where it cannot trace the builder's tree.
  TracerChoice tracer() const;
  /// The CPU for what runs on the CPU only, if --device allows it; otherwise throws InputError.
  Device deviceFor(const DeviceOptions& device, bool quiet = false) const;
  Parameters parameters() const;
  /// Throws InputError for an unknown one, and for a tracer's own tree.
  OptimiserNames optimisers() const;
  /// The options that are not at their defaults: "--builder, --set"; "" where all are.
  std::string given() const;
};

/// `kmeans-q2` where it is registered, otherwise `lbvh`.
std::string defaultBuilder();

/// --size, --spp, --max-depth, --light-samples, --seed.
struct RenderOptions {
  std::string size = "1024x768";
  long long spp = 8, maxDepth = 8, lightSamples = 2, seed = 1;
  void add(CommandLine& command);
  /// Throws InputError that names the option and its range.
  RenderSettings settings() const;
};

struct NamedFile {
  std::string option, file;
};
/// Throws InputError where an output would replace an input or another output, by any path; "" is no file.
void checkApart(const std::vector<NamedFile>& outputs, const std::vector<NamedFile>& inputs);

/// To be called before long work: throws InputError unless `file` can be written; "" is no file.
void checkWritable(const std::string& file);
/// Throws InputError that names `option` where PNG cannot be written; "" is no file.
void checkPng(const std::string& option, const std::string& file);
/// Throws InputError unless `file` ends in `extension` and can be written.
void checkOutput(const std::string& option, const std::string& file, const std::string& extension);

/// "a/b.exr" and "nave": "a/b-nave.exr". What a file name cannot have becomes `_`.
std::string withSuffix(const std::string& file, const std::string& suffix);
/// `name` as the name of a file: no separators, not empty, not hidden.
std::string asFileName(const std::string& name);

}  // namespace copse::cli
