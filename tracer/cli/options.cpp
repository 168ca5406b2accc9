// Shared options: declared once, checked once.
#include "tracer/cli/options.h"

#include <fmt/format.h>
#include <omp.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>

#include "builder/base/error.h"
#include "builder/base/files.h"
#include "builder/base/whole_file.h"
#include "tracer/cli/print.h"
#include "tracer/image/image_io.h"
#include "tracer/integrators/parameters.h"

namespace copse::cli {

namespace {

constexpr int maxSize = 8192;

int checked(const char* option, long long value, long long min, long long max) {
  if (value < min || value > max)
    throw InputError(fmt::format("{}: expected an integer from {} to {}, got {}", option, min, max, value));
  return static_cast<int>(value);
}

/// "1024x768" → both numbers; false for anything else.
bool parseSize(const std::string& text, long long& width, long long& height) {
  const char* const end = text.data() + text.size();
  const auto [afterWidth, widthError] = std::from_chars(text.data(), end, width);
  if (widthError != std::errc() || afterWidth == end || *afterWidth != 'x') return false;
  const auto [afterHeight, heightError] = std::from_chars(afterWidth + 1, end, height);
  return heightError == std::errc() && afterHeight == end;
}

}  // namespace

void DeviceOptions::add(CommandLine& command) {
  command.option("--device", device, fmt::format("{}; auto is CUDA where available", deviceChoices)).showDefault();
  command.option("--threads", threads, "CPU threads; 0 for all").showDefault();
}

Device DeviceOptions::open(bool quiet) const {
  // More threads than this gain nothing.
  const int max = 4 * processorCount(), asked = checked("--threads", threads, 0, 1024);
  if (asked > max && !quiet) say("note: --threads {}: using {}, four per processor\n", asked, max);
  const Device opened = openDevice(device, std::min(asked, max));
  omp_set_num_threads(opened.threads);  // For loops that know no device, such as the one over textures.
  return opened;
}

void SceneOptions::add(CommandLine& command) {
  command.option("--up", up, "y or z: the axis that points up in meshes' files; views and skies stay y-up")
      .showDefault();
}

void SceneOptions::addSky(CommandLine& command) {
  command.option("--sky-rotation", skyRotation, "Degrees by which the sky's image is turned; replaces the scene's");
}

LoadOptions SceneOptions::load() const {
  LoadOptions options;
  try {
    options.up = upAxis(up);
  } catch (const InputError& error) {
    throw InputError(fmt::format("--up: {}", error.what()));
  }
  options.skyRotation = skyRotation;
  if (skyRotation && !(std::abs(*skyRotation) <= 1e30))
    throw InputError(fmt::format("--sky-rotation: expected a finite number of degrees, got {}", *skyRotation));
  return options;
}

std::string defaultBuilder() { return findBuilder("kmeans-q2").name; }

void BuilderOptions::add(CommandLine& command) {
  command.option("--builder", name, "Builder's name, see `copse list builders`").showDefault();
  command.option("--tracer", tracerName, "What rays traverse, see `copse list tracers`; auto picks one").showDefault();
  command.option("--set", settings, "KEY=VALUE, see `copse list parameters`; may be repeated")
      .oneValueEach()
      .typeName("KEY=VALUE");
  command.option("--optimise", optimise, "Optimisers to run over the builder's tree, see `copse list optimisers`")
      .notEmpty()
      .typeName("NAME[,NAME…]");
}

std::string BuilderOptions::given() const {
  const std::pair<bool, const char*> options[] = {{name != defaultBuilder(), "--builder"},
                                                  {tracerName != "auto", "--tracer"},
                                                  {!settings.empty(), "--set"},
                                                  {!optimise.empty(), "--optimise"}};
  std::string list;
  for (const auto& [isGiven, option] : options)
    if (isGiven) list += (list.empty() ? "" : ", ") + std::string(option);
  return list;
}

TreeSource BuilderOptions::source() const { return findTreeSource(name); }

TracerChoice BuilderOptions::tracer() const {
  const TreeSource built = source();
  try {
    const TracerChoice tracer(tracerName);
    tracer.check(built);
    return tracer;
  } catch (const InputError& error) {
    throw InputError(fmt::format("--tracer {}: {}", tracerName, error.what()));
  }
}

Device BuilderOptions::deviceFor(const DeviceOptions& device, bool quiet) const {
  if (!tracer().isOnCpuOnly(source())) return device.open(quiet);
  if (deviceChoice(device.device) == DeviceChoice::cuda)
    throw InputError(fmt::format("--builder {} runs on the CPU only; use --device cpu", name));
  DeviceOptions cpu = device;
  if (deviceChoice(device.device) == DeviceChoice::automatic) cpu.device = "cpu";
  return cpu.open(quiet);
}

Parameters BuilderOptions::parameters() const {
  Parameters parameters(tracerParameters());
  for (const std::string& setting : settings) parameters.set(setting);
  return parameters;
}

OptimiserNames BuilderOptions::optimisers() const {
  if (!optimise.empty() && source().isOwnTree())
    throw InputError(fmt::format("--optimise: the tree of {} cannot be optimised", name));
  return optimiserNames(optimise);
}

void RenderOptions::add(CommandLine& command) {
  command.option("--size", size, "Pixels, at most 8192x8192").showDefault().typeName("WxH");
  command.option("--spp", spp, "Samples per pixel").showDefault().allowUnderscores();
  command.option("--max-depth", maxDepth, "Surface hits that are lit, the camera ray's being the first").showDefault();
  command.option("--light-samples", lightSamples, "Shadow rays per hit").showDefault();
  command.option("--seed", seed, "Random seed; the same seed gives the same image").showDefault().allowUnderscores();
}

RenderSettings RenderOptions::settings() const {
  long long width = 0, height = 0;
  if (!parseSize(size, width, height) || width < 1 || height < 1 || width > maxSize || height > maxSize)
    throw InputError(fmt::format("--size: expected WIDTHxHEIGHT, each from 1 to {}, got '{}'", maxSize, size));
  RenderSettings settings;
  settings.width = static_cast<int>(width);
  settings.height = static_cast<int>(height);
  settings.spp = checked("--spp", spp, 1, 1 << 20);
  settings.maxDepth = checked("--max-depth", maxDepth, 0, 1000);
  settings.lightSamples = checked("--light-samples", lightSamples, 1, 4096);
  if (seed < 0) throw InputError(fmt::format("--seed: expected an integer of 0 or more, got {}", seed));
  settings.seed = static_cast<uint64_t>(seed);
  return settings;
}

void checkApart(const std::vector<NamedFile>& outputs, const std::vector<NamedFile>& inputs) {
  const auto same = [](const std::string& a, const std::string& b) {
    std::error_code error;
    if (std::filesystem::exists(a, error) && std::filesystem::exists(b, error))
      return std::filesystem::is_regular_file(a, error) && std::filesystem::equivalent(a, b, error);
    const auto whole = [&](const std::string& file) {
      return std::filesystem::weakly_canonical(std::filesystem::absolute(file, error), error);
    };
    return whole(a) == whole(b) && !error;
  };
  const auto named = [](const NamedFile& f) { return f.option.empty() ? f.file : f.option + " " + f.file; };
  std::vector<NamedFile> earlier = inputs;
  for (const NamedFile& output : outputs) {
    if (output.file.empty()) continue;
    for (const NamedFile& other : earlier)
      if (same(output.file, other.file))
        throw InputError(fmt::format("{} and {} are the same file", named(output), named(other)));
    earlier.push_back(output);
  }
}

void checkWritable(const std::string& file) {
  if (!file.empty()) WholeFile{file};  // Makes the temporary file and removes it.
}

void checkPng(const std::string& option, const std::string& file) {
  if (!file.empty() && !hasOpenImageIO())
    throw InputError(fmt::format("{} {}: cannot write PNG: {}", option, file, whyNoOpenImageIO()));
}

void checkOutput(const std::string& option, const std::string& file, const std::string& extension) {
  if (extensionOf(file) != extension)
    throw InputError(fmt::format("{} {}: the file name must end in {}", option, file, extension));
  checkWritable(file);
}

std::string asFileName(const std::string& name) {
  std::string safe = name;
  for (char& c : safe)
    if (c == '/' || c == '\\' || static_cast<unsigned char>(c) < ' ') c = '_';
  if (safe.empty() || safe[0] == '.') safe.insert(0, "_");
  return safe;
}

std::string withSuffix(const std::string& file, const std::string& suffix) {
  std::filesystem::path path(file);
  const std::string stem = path.stem().string(), extension = path.extension().string();
  return path.replace_filename(fmt::format("{}-{}{}", stem, asFileName(suffix), extension)).string();
}

}  // namespace copse::cli
