// copse list: what can be named on the command line.
#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>

#include "builder/base/error.h"
#include "builder/base/text.h"
#include "builder/parallel/device_facts.h"
#include "tracer/accel/tracers.h"
#include "tracer/cli/commands.h"
#include "tracer/cli/print.h"
#include "tracer/generators/generators.h"
#include "tracer/integrators/parameters.h"
#include "tracer/integrators/registry.h"

namespace copse::cli {

namespace {

std::string text(const ParameterValue& value) {
  return std::visit([](const auto& v) { return fmt::format("{}", v); }, value);
}

void listRows(std::span<const BuilderEntry> rows) {
  for (const BuilderEntry& entry : rows) {
    print("{:<16} {} ({}){}\n", entry.name, entry.meaning, entry.source, entry.method->onCpuOnly ? " [cpu]" : "");
    std::string preset;
    for (const auto& [name, value] : entry.preset) preset += fmt::format(" {}={}", name, text(value));
    if (!preset.empty()) print("{:<16}{}\n", "", preset);
  }
}

/// The README's table, one row per method. It has no baselines, since these depend on what was installed.
void listBuildersAsMarkdown() {
  print("| name | method | source |\n|---|---|---|\n");
  for (const Method& method : methods::all()) {
    std::vector<std::string> names;
    if (!method.presetsOnly) names.push_back(fmt::format("`{}`", method.name));
    for (const Preset& preset : method.presets) names.push_back(fmt::format("`{}`", preset.name));
    if (method.page) names[0] = fmt::format("[{}]({})", names[0], method.page);
    print("| {} | {}{} | {} |\n", fmt::to_string(fmt::join(names, ", ")), method.meaning,
          method.onCpuOnly ? "; on the CPU" : "", method.source);
  }
}

void listBuilders() {
  listRows(builders());
  for (const TracerEntry& tracer : tracers())
    for (const OwnTree& tree : tracer.ownTrees)
      print("{:<16} {} ({}){} [baseline]\n", tree.name, tree.meaning, tree.source, tracer.onCpuOnly ? " [cpu]" : "");
}

void listTracers() {
  for (const TracerEntry& entry : tracers())
    print("{:<16} {}{}{}\n", entry.name, entry.meaning, *entry.source ? fmt::format(" ({})", entry.source) : "",
          entry.onCpuOnly ? " [cpu]" : "");
}

void listOptimisers() {
  for (const Optimiser& optimiser : optimisers::all())
    print("{:<24} {} ({})\n", optimiser.name, optimiser.meaning, optimiser.source);
}

void listIntegrators() {
  for (const IntegratorEntry* entry : integrators()) {
    print("{:<16} {}{}\n", entry->name, entry->meaning, entry->onCpuOnly ? " [cpu]" : "");
    for (const IntegratorOption* option : entry->options)
      print("{:<16} --{}: {}; {}\n", "", option->name, option->meaning, option->range);
    if (!entry->channels.empty()) cli::print("{:<16} channels {}\n", "", fmt::join(entry->channels, " "));
  }
}

void listParameters() {
  for (const ParameterSpec& spec : tracerParameters()) {
    std::string values;
    if (const auto choices = spec.choices(); !choices.empty())
      for (const char* choice : choices) values += fmt::format("{}{}", values.empty() ? "" : "|", choice);
    else
      values = fmt::format("{:.10g} … {:.10g}", spec.min, spec.max);
    print("{:<20} {:<8} {:<22} {}\n", spec.name, text(spec.defaultValue()), values, spec.meaning);
  }
}

void listGenerators() {
  for (const GeneratorEntry& entry : generators())
    print("{:<12} {:>12} triangles  {}\n", entry.name, grouped(entry.defaultTriangles), entry.meaning);
}

void listAllDevices() {
  for (const Device& device : listDevices()) {
    print("{:<6} {}{}\n", device.kindName(), device.name,
          device.isCuda() ? "" : fmt::format(", {} threads", device.threads));
    if (device.isCuda()) print("{:<6} {:<32} {}\n", "", "driver", driverOf(device));
    for (const auto& [name, value] : propertiesOf(device)) print("{:<6} {:<32} {:.0f}\n", "", name, value);
  }
}

void printDevicesJson() {
  nlohmann::ordered_json devices = nlohmann::ordered_json::array();
  for (const Device& device : listDevices()) {
    nlohmann::ordered_json json{{"kind", device.kindName()}, {"name", device.name}};
    if (device.isCuda())
      json["driver"] = driverOf(device);
    else
      json["threads"] = device.threads;
    for (const auto& [name, value] : propertiesOf(device)) json[name] = std::llround(value);
    devices.push_back(json);
  }
  print("{}\n", devices.dump(1));
}

int run(const std::string& what, bool json, bool markdown) {
  if (json && what != "devices") throw InputError("--json is for `copse list devices`");
  if (markdown && what != "builders") throw InputError("--markdown is for `copse list builders`");
  if (markdown) {
    listBuildersAsMarkdown();
    return done;
  }
  if (json) {
    printDevicesJson();
    return done;
  }
  if (what == "builders")
    listBuilders();
  else if (what == "optimisers")
    listOptimisers();
  else if (what == "tracers")
    listTracers();
  else if (what == "integrators")
    listIntegrators();
  else if (what == "parameters")
    listParameters();
  else if (what == "generators")
    listGenerators();
  else if (what == "devices")
    listAllDevices();
  else
    throw InputError(fmt::format(
        "list: expected builders, optimisers, tracers, integrators, parameters, generators or devices, got '{}'",
        what));
  return done;
}

}  // namespace

Command addList(CommandLine& program) {
  CommandLine command =
      program.addCommand("list", "List builders, optimisers, tracers, integrators, parameters, generators or devices");
  auto what = std::make_shared<std::string>();
  auto json = std::make_shared<bool>(false), markdown = std::make_shared<bool>(false);
  command.option("WHAT", *what, "builders, optimisers, tracers, integrators, parameters, generators or devices")
      .required();
  command.flag("--json", *json, "devices as JSON");
  command.flag("--markdown", *markdown, "builders as the table in README.md");
  return [what, json, markdown] { return run(*what, *json, *markdown); };
}

}  // namespace copse::cli
