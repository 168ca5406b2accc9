// Declared, and checked before anything is read.
#include "tracer/cli/render_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "builder/base/error.h"
#include "builder/parallel/device.h"

namespace copse::cli {

namespace {

/// "path, reference, …" of those for which `has` holds.
template <class Has>
std::string namesOf(Has has) {
  std::string names;
  for (const IntegratorEntry* entry : integrators())
    if (has(*entry)) names += fmt::format("{}{}", names.empty() ? "" : ", ", entry->name);
  return names;
}

bool isOwn(const IntegratorEntry& entry, const IntegratorOption* option) {
  return std::find(entry.options.begin(), entry.options.end(), option) != entry.options.end();
}

}  // namespace

void RenderCommand::add(CommandLine& command) {
  builder.name = defaultBuilder();
  files.integrator = integrators().front()->name;
  command.option("SCENE", files.scene, "Scene TOML, or a bare mesh (.obj, .ply)").required();
  command.option("-o,--output", files.output, "FILE.exr; out/NAME.exr and a preview beside it by default").notEmpty();
  command.option("--view", files.view, "View's name, or all; the first by default").notEmpty();
  scene.add(command);
  scene.addSky(command);
  render.add(command);
  builder.add(command);
  device.add(command);
  command.option("--integrator", files.integrator, namesOf([](const IntegratorEntry&) { return true; })).showDefault();
  command.flag("--aov", aov, "Add normals, albedo and depth to the EXR as channels");
  for (const IntegratorEntry* entry : integrators())
    for (const IntegratorOption* option : entry->options) {
      if (integers.contains(option) || numbers.contains(option)) continue;
      const std::string help =
          fmt::format("With --integrator {}: {}",
                      namesOf([&](const IntegratorEntry& other) { return isOwn(other, option); }), option->meaning);
      const std::string name = fmt::format("--{}", option->name);
      if (option->isInteger)
        command.option(name, integers[option], help);
      else
        command.option(name, numbers[option], help);
    }
  command.flag("--resume", resume,
               "Go on from FILE.exr where it is there, up to --spp, and keep what a later --resume needs");
  command.option("--preview", files.preview, "FILE.png: an sRGB preview").notEmpty();
  command.option("--exposure", exposure, "Exposure of the preview, in stops").showDefault();
  command.option("--stats", files.stats, "FILE.json: the record of the run").notEmpty();
  command.flag("--count-traversal", countTraversal,
               "Count nodes and triangles per ray, in a second render that is not timed");
  command.flag("--end-point-overlap", endPointOverlap, "End-point overlap (Aila, Karras and Laine 2013); not timed");
  command.flag("--quiet", quiet, "Only errors and warnings");
}

IntegratorOptions RenderCommand::integratorOptions() const {
  IntegratorOptions options{aov};
  for (const auto& [option, value] : integers)
    if (value) options.own[option] = *value;
  for (const auto& [option, value] : numbers)
    if (value) options.own[option] = *value;
  return options;
}

void RenderCommand::check(const TreeSource& chosen) const {
  if (!integratorNamed(files.integrator))
    throw InputError(fmt::format("--integrator {}: unknown integrator (available: {})", files.integrator,
                                 namesOf([](const IntegratorEntry&) { return true; })));
  const IntegratorEntry& entry = integrator();
  if (entry.onCpuOnly && deviceChoice(device.device) == DeviceChoice::cuda)
    throw InputError(fmt::format("--integrator {} runs on the CPU only; use --device cpu", entry.name));
  const auto notWith = [&](const char* option) {
    throw InputError(fmt::format("--{} does not go with --integrator {}", option, entry.name));
  };
  const std::map<const IntegratorOption*, double> own = integratorOptions().own;
  if (aov && !entry.takes.aov) notWith("aov");
  if (resume && !entry.takes.resume) notWith("resume");
  for (const auto& [option, value] : own)
    if (!isOwn(entry, option)) notWith(option->name);
  if (countTraversal && !entry.takes.countTraversal) notWith("count-traversal");
  if (endPointOverlap && !entry.takes.endPointOverlap) notWith("end-point-overlap");
  if (exposure != 0 && !std::isnan(exposure) && !entry.takes.exposure) notWith("exposure");
  checkTree(entry, chosen);
  for (const auto& [asked, option] :
       {std::pair{countTraversal, "--count-traversal"}, std::pair{endPointOverlap, "--end-point-overlap"}})
    if (asked && chosen.isOwnTree())
      throw InputError(fmt::format("{}: the tree of {} cannot be inspected", option, chosen.name()));
  for (const auto& [option, value] : own)
    if (!option->accepts(value))
      throw InputError(fmt::format("--{}: expected a number {}, got {}", option->name, option->range, value));
  if (!(exposure >= -100 && exposure <= 100))
    throw InputError(fmt::format("--exposure: expected stops from -100 to 100, got {}", exposure));
}

}  // namespace copse::cli
