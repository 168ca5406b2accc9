// [[builder]] tables: a name, a label, and parameters whose lists make as many rows as their product has elements, each
// once for every tracer.
#include "tracer/bench/experiment_rows.h"

#include <fmt/format.h>

#include <algorithm>
#include <tuple>

#include "builder/base/error.h"
#include "builder/build.h"

namespace copse {

namespace {

constexpr std::size_t maxRows = 10'000;

ParameterValue valueOf(const toml::node& node, const TomlKeys& keys) {
  if (const auto* integer = node.as_integer()) return integer->get();
  if (const auto* real = node.as_floating_point()) return real->get();
  if (const auto* text = node.as_string()) return text->get();
  keys.failAt(node, "expected a parameter: a number, a string, or a list of them");
}

/// A key of `set` with its values.
struct Setting {
  std::string name;
  const toml::node* node;
  std::vector<ParameterValue> values;
  bool isList;
};

/// `"kmeans.k" = 8` and `kmeans.k = 8`, which TOML reads as a table in a table, are the same.
void collect(const toml::table& table, const std::string& prefix, const TomlKeys& keys,
             std::vector<Setting>& settings) {
  for (const auto& [key, node] : table) {
    const std::string name = prefix + std::string(key.str());
    if (const toml::table* inner = node.as_table()) {
      collect(*inner, name + ".", keys, settings);
      continue;
    }
    Setting setting{name, &node, {}, node.is_array()};
    if (const toml::array* list = node.as_array())
      for (const toml::node& item : *list) setting.values.push_back(valueOf(item, keys));
    else
      setting.values.push_back(valueOf(node, keys));
    if (setting.values.empty()) keys.failAt(node, fmt::format("'{}' is an empty list", name));
    settings.push_back(std::move(setting));
  }
}

/// The settings of the key `set`, in the order of the file (toml++ sorts its keys), each value checked.
std::vector<Setting> readSettings(const toml::table& table, const TomlKeys& keys) {
  std::vector<Setting> settings;
  const toml::node* node = table.get("set");
  if (!node) return settings;
  if (!node->is_table()) keys.fail("set", "'set': expected a table, such as { \"kmeans.k\" = 8 }");
  collect(*node->as_table(), "", keys, settings);
  const auto place = [](const Setting& s) {
    const toml::source_position at = s.node->source().begin;
    return std::tuple(at.line, at.column);
  };
  std::stable_sort(settings.begin(), settings.end(), [&](const auto& a, const auto& b) { return place(a) < place(b); });
  for (const Setting& setting : settings) try {
      for (const ParameterValue& value : setting.values) Parameters(tracerParameters()).set(setting.name, value);
    } catch (const InputError& error) {
      keys.failAt(*setting.node, error.what());
    }
  return settings;
}

/// The tracers of each row of a table.
struct RowTracers {
  std::vector<TracerChoice> choices{TracerChoice()};
  bool isOwn = false;  ///< The table names them itself.
};

/// The value of `key`: a name, or a list of them.
std::vector<TracerChoice> readTracers(const TomlKeys& keys, const toml::table& table, const char* key) {
  std::vector<TracerChoice> tracers;
  const toml::node* node = table.get(key);
  for (const std::string& name : node && node->is_string() ? std::vector<std::string>{keys.text(key)} : keys.texts(key))
    try {
      for (const TracerChoice& other : tracers)
        if (other.name() == name) throw InputError(fmt::format("'{}' is named twice", name));
      tracers.emplace_back(name);
    } catch (const InputError& error) {
      keys.fail(key, error.what());
    }
  if (tracers.empty()) keys.fail(key, fmt::format("'{}' is an empty list", key));
  return tracers;
}

/// A table's own tracers, or those of the whole experiment unless it names a tree that a tracer builds for itself.
RowTracers tracersOf(const TomlKeys& keys, const toml::table& table, const TreeSource& source,
                     const RowTracers& common) {
  if (!keys.has("tracer")) return source.isOwnTree() ? RowTracers{} : common;
  RowTracers tracers{readTracers(keys, table, "tracer"), true};
  try {
    for (const TracerChoice& tracer : tracers.choices) tracer.check(source);
  } catch (const InputError& error) {
    keys.fail("tracer", error.what());
  }
  return tracers;
}

/// `label` with "{kmeans.i}" replaced by the row's value of that parameter, and "{tracer}" by the tracer's name.
std::string filled(std::string label, const Parameters& parameters, const TracerChoice& tracer, const TomlKeys& keys) {
  for (std::size_t open = 0; (open = label.find('{', open)) != std::string::npos;) {
    const std::size_t close = label.find('}', open);
    if (close == std::string::npos) keys.fail("label", fmt::format("'{}' has no '}}' for its '{{'", label));
    try {
      const std::string name = label.substr(open + 1, close - open - 1);
      const std::string text = name == "tracer" ? tracer.name() : textOf(parameters.value(name));
      label.replace(open, close - open + 1, text);
      open += text.size();
    } catch (const InputError& error) {
      keys.fail("label", error.what());
    }
  }
  return label;
}

/// The key `optimise`, each name checked.
OptimiserNames readOptimisers(const TomlKeys& keys) {
  if (!keys.has("optimise")) return {};
  const OptimiserNames names = keys.texts("optimise");
  try {
    for (const std::string& name : names) findOptimiser(name);
  } catch (const InputError& error) {
    keys.fail("optimise", error.what());
  }
  return names;
}

/// The builder's name with its optimisers, and what tells the rows of one table apart: "kmeans-r1,i=3",
/// "lbvh+treelets-exact".
std::string standardLabel(const std::string& name, const OptimiserNames& optimisers,
                          const std::vector<Setting>& settings, const ParameterRow& row) {
  std::string label = name;
  for (const std::string& optimiser : optimisers) label += "+" + optimiser;
  for (std::size_t i = 0; i < row.size(); ++i)
    if (settings[i].isList)
      label += fmt::format(",{}={}", row[i].first.substr(row[i].first.rfind('.') + 1), textOf(row[i].second));
  return label;
}

/// The rows of a table: `start` with each of the `values` of its settings. `tell`: their labels name the tracer.
void addRows(Experiment& experiment, const TomlKeys& keys, const ExperimentBuilder& start,
             const std::vector<Setting>& settings, const std::vector<ParameterRow>& values, bool tell) {
  for (const ParameterRow& chosen : values) {
    ExperimentBuilder row = start;
    for (const auto& [parameter, value] : chosen) row.parameters.set(parameter, value);
    const std::string given = keys.text("label", "");
    const bool isOwnTree = row.source.isOwnTree();
    row.label = keys.has("label")
                    ? filled(given, isOwnTree ? row.parameters : withPreset(row.source.builder(), row.parameters),
                             row.tracer, keys)
                    : standardLabel(row.source.name(), row.optimisers, settings, chosen);
    if (tell && given.find("{tracer}") == std::string::npos) row.label += fmt::format(",tracer={}", row.tracer.name());
    checkKeyPart(row.label, "builder", [&](const std::string& what) { keys.fail("label", what); });
    for (const ExperimentBuilder& other : experiment.builders)
      if (other.label == row.label)
        keys.fail("label", fmt::format("duplicate row '{}'; give it a label, with {{PARAMETER}} for each list of 'set'",
                                       row.label));
    experiment.builders.push_back(std::move(row));
  }
}

void readTable(Experiment& experiment, const toml::table& table, const std::vector<Setting>& common,
               const RowTracers& tracers) {
  const TomlKeys keys(experiment.file, table, "[[builder]]",
                      {"name", "label", "set", "optimise", "tracer", "optional"});
  const std::string name = keys.text("name");
  const bool optional = keys.flag("optional", false);
  const std::vector<Setting> settings = readSettings(table, keys);
  ExperimentBuilder start;
  start.optimisers = readOptimisers(keys);
  try {
    start.source = findTreeSource(name);
  } catch (const InputError& error) {
    if (!optional) keys.fail("name", error.what());
    experiment.leftOut.push_back({"builder", name, error.what()});
    return;
  }
  const bool isOwnTree = start.source.isOwnTree();
  if (isOwnTree && !settings.empty()) keys.fail("set", fmt::format("'{}' has no parameters", name));
  if (isOwnTree && !start.optimisers.empty())
    keys.fail("optimise", fmt::format("the tree of '{}' cannot be optimised", name));
  if (!isOwnTree)
    for (const Setting& setting : common) start.parameters.set(setting.name, setting.values.front());
  std::vector<std::pair<std::string, std::vector<ParameterValue>>> product;
  std::size_t count = 1;
  for (const Setting& setting : settings) {
    product.emplace_back(setting.name, setting.values);
    count *= setting.values.size();
    if (count > maxRows) keys.fail("set", fmt::format("'set' makes more than {} rows", maxRows));
  }
  const std::vector<ParameterRow> values = crossProduct(product);
  const RowTracers own = tracersOf(keys, table, start.source, tracers);
  // Where a table has several tracers, or names one without a label, the label must name the tracer.
  const bool tell = own.choices.size() > 1 || (own.isOwn && !keys.has("label"));
  for (const TracerChoice& tracer : own.choices) {
    start.tracer = tracer;
    addRows(experiment, keys, start, settings, values, tell);
  }
}

}  // namespace

std::vector<ParameterRow> crossProduct(const std::vector<std::pair<std::string, std::vector<ParameterValue>>>& keys) {
  std::vector<ParameterRow> rows{{}};
  for (const auto& [name, values] : keys) {
    std::vector<ParameterRow> longer;
    for (const ParameterRow& row : rows)
      for (const ParameterValue& value : values) {
        longer.push_back(row);
        longer.back().emplace_back(name, value);
      }
    rows = std::move(longer);
  }
  return rows;
}

void readRows(Experiment& experiment, const toml::table& root, const TomlKeys& keys) {
  const std::vector<Setting> common = readSettings(root, keys);
  for (const Setting& setting : common)
    if (setting.isList)
      keys.failAt(*setting.node, fmt::format("'{}' is a list: lists belong to a [[builder]]", setting.name));
  RowTracers tracers;
  if (keys.has("tracers")) {
    tracers.choices = readTracers(keys, root, "tracers");
    for (const TracerChoice& tracer : tracers.choices)
      if (!findTracer(tracer.name()).ownTrees.empty())
        keys.fail("tracers", fmt::format("'{}' builds its own trees, which are named as builders", tracer.name()));
  }
  const std::vector<const toml::table*> tables = keys.tables("builder");
  if (tables.empty()) keys.fail({}, "an experiment needs at least one [[builder]]");
  for (const toml::table* table : tables) readTable(experiment, *table, common, tracers);
  if (experiment.builders.empty())
    throw InputError(fmt::format("{}: none of its builders is available in this build of Copse", experiment.file));
  if (experiment.tracer.empty()) return;
  const TracerChoice inPlace(experiment.tracer);
  for (ExperimentBuilder& row : experiment.builders) {
    if (row.source.isOwnTree()) continue;
    inPlace.check(row.source);
    row.tracer = inPlace;
  }
}

void leaveOutBaselines(Experiment& experiment, const Device& device) {
  if (!device.isCuda()) return;
  const auto onCpuOnly = [](const ExperimentBuilder& row) { return row.tracer.isOnCpuOnly(row.source); };
  for (const ExperimentBuilder& row : experiment.builders)
    if (onCpuOnly(row)) experiment.leftOut.push_back({"builder", row.label, "it runs on the CPU alone"});
  std::erase_if(experiment.builders, onCpuOnly);
  if (experiment.builders.empty())
    throw InputError(fmt::format("{}: none of its builders runs on CUDA", experiment.file));
}

void checkKeyPart(const std::string& name, const char* what, const std::function<void(const std::string&)>& fail) {
  const bool bad =
      std::any_of(name.begin(), name.end(), [](char c) { return c == '/' || static_cast<unsigned char>(c) < ' '; });
  if (bad || name.empty() || name[0] == '.')
    fail(fmt::format("'{}' cannot be the name of {} {}: it is part of file names and keys", name,
                     what[0] == 'e' ? "an" : "a", what));
}

}  // namespace copse
