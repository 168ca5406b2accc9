// copse list: what can be named on the command line.
#include <fmt/format.h>

#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>

#include "builder/base/error.h"
#include "builder/parallel/device_facts.h"
#include "tracer/accel/peers.h"
#include "tracer/cli/commands.h"
#include "tracer/cli/print.h"
#include "tracer/cli/summary.h"
#include "tracer/generators/generators.h"

namespace copse::cli {

namespace {

std::string text(const ParameterValue& value) {
  return std::visit([](const auto& v) { return fmt::format("{}", v); }, value);
}

void listRows(std::span<const BuilderEntry> rows) {
  for (const BuilderEntry& entry : rows) {
    print("{:<16} {} ({}){}{}\n", entry.name, entry.meaning, entry.source, entry.onCpuOnly ? " [cpu]" : "",
          isPeer(entry) ? " [peer]" : "");
    std::string preset;
    for (const auto& [name, value] : entry.preset) preset += fmt::format(" {}={}", name, text(value));
    if (!preset.empty()) print("{:<16}{}\n", "", preset);
  }
}

void listBuilders() {
  for (const auto rows : {builders(), peerBuilders()}) listRows(rows);
}

void listParameters() {
  for (const ParameterSpec& spec : parameterTable()) {
    std::string values;
    if (std::holds_alternative<std::string>(spec.defaultValue))
      for (const char* choice : spec.choices) values += fmt::format("{}{}", values.empty() ? "" : "|", choice);
    else
      values = fmt::format("{:.10g} … {:.10g}", spec.least, spec.most);
    print("{:<20} {:<8} {:<22} {}\n", spec.name, text(spec.defaultValue), values, spec.meaning);
  }
}

void listGenerators() {
  for (const GeneratorEntry& entry : generators())
    print("{:<12} {:>12} triangles  {}\n", entry.name, grouped(entry.defaultTriangles), entry.meaning);
}

void listAllDevices() {
  for (const Device& device : listDevices()) {
    print("{:<6} {}{}\n", device.isCuda() ? "cuda" : "cpu", device.name,
          device.isCuda() ? "" : fmt::format(", {} threads", device.threads));
    if (device.isCuda()) print("{:<6} {:<32} {}\n", "", "driver", driverOf(device));
    for (const auto& [name, value] : propertiesOf(device)) print("{:<6} {:<32} {:.0f}\n", "", name, value);
  }
}

void printDevicesJson() {
  nlohmann::ordered_json devices = nlohmann::ordered_json::array();
  for (const Device& device : listDevices()) {
    nlohmann::ordered_json json{{"kind", device.isCuda() ? "cuda" : "cpu"}, {"name", device.name}};
    if (device.isCuda())
      json["driver"] = driverOf(device);
    else
      json["threads"] = device.threads;
    for (const auto& [name, value] : propertiesOf(device)) json[name] = std::llround(value);
    devices.push_back(json);
  }
  print("{}\n", devices.dump(1));
}

int run(const std::string& what, bool json) {
  if (json && what != "devices") throw InputError("--json is for `copse list devices`");
  if (json) {
    printDevicesJson();
    return done;
  }
  if (what == "builders")
    listBuilders();
  else if (what == "parameters")
    listParameters();
  else if (what == "generators")
    listGenerators();
  else if (what == "devices")
    listAllDevices();
  else
    throw InputError(fmt::format("list {}: builders, parameters, generators or devices", what));
  return done;
}

}  // namespace

Command addList(CommandLine& program) {
  CommandLine command = program.addCommand("list", "Builders, parameters, generators or devices");
  auto what = std::make_shared<std::string>();
  auto json = std::make_shared<bool>(false);
  command.option("WHAT", *what, "builders, parameters, generators or devices").required();
  command.flag("--json", *json, "devices as JSON");
  return [what, json] { return run(*what, *json); };
}

}  // namespace copse::cli
