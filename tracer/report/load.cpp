// JSON to runs. Every key may be absent or null; one of the wrong kind is an error that names the record's line.
#include "tracer/report/load.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>

#include "builder/base/error.h"

namespace copse::report {

namespace {

using Json = nlohmann::ordered_json;

std::string contents(const std::string& file) {
  std::ifstream stream(file, std::ios::binary);
  if (!stream) throw InputError(file + ": cannot open");
  return {std::istreambuf_iterator<char>(stream), {}};
}

std::size_t lineAt(const std::string& text, std::size_t byte) {
  return 1 + static_cast<std::size_t>(std::count(text.begin(), text.begin() + std::min(byte, text.size()), '\n'));
}

/// nlohmann's message without its own prefix: "[json.exception.parse_error.101] parse error at line 1, column 2: …".
std::string reason(const std::string& message) {
  const std::size_t position = message.find("column ");
  const std::size_t colon = position == std::string::npos ? position : message.find(": ", position);
  return "no JSON: " + (colon == std::string::npos ? message : message.substr(colon + 2));
}

Json parse(const std::string& file, const std::string& text, std::size_t firstLine = 1) {
  try {
    return Json::parse(text);
  } catch (const Json::parse_error& error) {
    const std::size_t line = firstLine - 1 + lineAt(text, error.byte > 0 ? error.byte - 1 : 0);
    throw InputError(fmt::format("{}:{}: {}", file, line, reason(error.what())));
  } catch (const Json::exception& error) {  // A number that no double holds.
    throw InputError(fmt::format("{}: {}", file, error.what()));
  }
}

/// The byte at which each element of the outermost array starts; for one object alone its own.
std::vector<std::size_t> elementStarts(const std::string& text) {
  std::vector<std::size_t> starts;
  int depth = 0;
  bool inString = false, expected = false;
  for (std::size_t i = 0; i < text.size(); ++i) {
    const char c = text[i];
    if (inString) {
      if (c == '\\')
        ++i;
      else if (c == '"')
        inString = false;
      continue;
    }
    if (c == ' ' || c == '\n' || c == '\r' || c == '\t') continue;
    if (depth == 1 && c == ',') {
      expected = true;
      continue;
    }
    if (expected && depth == 1) starts.push_back(i);
    expected = false;
    if (c == '"') inString = true;
    if (c == '[' || c == '{') expected = depth++ == 0;
    if (c == ']' || c == '}') --depth;
  }
  return starts;
}

/// Reads one record and says where in it something is of the wrong kind.
class Reader {
 public:
  Reader(const Json& json, std::string where) : json_(json), where_(std::move(where)) {
    if (!json.is_object()) fail("", "expected an object");
  }

  Reader at(const char* name) const {
    static const Json empty = Json::object();
    const Json* found = find(name);
    return {found ? *found : empty, where_, path_ + name + "."};
  }
  double number(const char* name) const {
    const Json* found = find(name);
    if (!found) return missing;
    if (!found->is_number()) fail(name, "expected a number");
    return found->get<double>();
  }
  /// A count that fits an int.
  int count(const char* name, int otherwise) const {
    const double value = number(name);
    if (!known(value)) return otherwise;
    if (!(value >= 0 && value <= 2e9)) fail(name, "out of range");
    return static_cast<int>(value);
  }
  bool flag(const char* name) const {
    const Json* found = find(name);
    if (found && !found->is_boolean()) fail(name, "expected true or false");
    return found && found->get<bool>();
  }
  std::string text(const char* name) const {
    const Json* found = find(name);
    if (!found) return "";
    if (!found->is_string()) fail(name, "expected a string");
    return found->get<std::string>();
  }
  std::vector<std::string> texts(const char* name) const {
    std::vector<std::string> all;
    const Json* found = find(name);
    if (!found) return all;
    if (!found->is_array()) fail(name, "expected an array of strings");
    for (const Json& element : *found) {
      if (!element.is_string()) fail(name, "expected an array of strings");
      all.push_back(element.get<std::string>());
    }
    return all;
  }
  std::vector<Reader> objects(const char* name) const {
    std::vector<Reader> all;
    const Json* found = find(name);
    if (!found) return all;
    if (!found->is_array()) fail(name, "expected an array of objects");
    for (const Json& element : *found) all.push_back({element, where_, path_ + name + "."});
    return all;
  }
  Numbers numbers(const char* name) const {
    Numbers all;
    for (const auto& [key, value] : at(name).json_.items()) {
      if (value.is_null()) continue;
      if (!value.is_number()) fail((std::string(name) + "." + key).c_str(), "expected a number");
      all.emplace_back(key, value.template get<double>());
    }
    return all;
  }
  std::array<double, 3> byKind() const { return {number(rayKinds[0]), number(rayKinds[1]), number(rayKinds[2])}; }
  /// Whatever is there: texts as they are, all else as JSON.
  Facts facts() const {
    Facts all;
    for (const auto& [key, value] : json_.items()) {
      if (value.is_null() || (value.is_string() && value.template get<std::string>().empty())) continue;
      all.emplace_back(key, value.is_string() ? value.template get<std::string>() : value.dump());
    }
    return all;
  }

 private:
  Reader(const Json& json, std::string where, std::string path)
      : json_(json), where_(std::move(where)), path_(std::move(path)) {
    if (!json.is_object()) fail("", "expected an object");
  }
  const Json* find(const char* name) const {
    const auto found = json_.find(name);
    return found == json_.end() || found->is_null() ? nullptr : &*found;
  }
  [[noreturn]] void fail(const std::string& name, const char* what) const {
    std::string key = path_ + name;
    if (!key.empty() && key.back() == '.') key.pop_back();
    throw InputError(fmt::format("{}: {}{}{}", where_, key, key.empty() ? "" : ": ", what));
  }

  const Json& json_;
  std::string where_, path_;
};

Run toRun(const Reader& record) {
  Run run;
  const Reader about = record.at("run"), scene = record.at("scene"), builder = record.at("builder");
  const Reader image = record.at("image"), bvh = record.at("bvh"), time = record.at("time_ms");
  run.scene = scene.text("name");
  run.triangles = scene.number("triangles");
  run.generated = scene.flag("generated");
  run.builder = builder.text("name");
  run.parameters = builder.at("parameters").facts();
  for (const auto& fact : record.at("tracer").at("parameters").facts()) run.parameters.push_back(fact);
  run.label = about.text("label");
  if (run.label.empty()) run.label = run.builder;
  run.failed = about.text("status") == "failed";
  run.error = about.text("error");
  run.repetition = about.count("repetition", 1);
  run.warmUp = about.count("warm_up", -1);
  run.view = image.text("view");
  run.width = image.count("width", 0);
  run.height = image.count("height", 0);
  run.spp = image.count("spp", 0);
  run.integrator = image.text("integrator");
  for (const char* name : {"integrator", "max_depth", "light_samples", "seed"})
    for (const auto& fact : image.facts())
      if (fact.first == name) run.settings.push_back(fact);
  run.device = record.at("device").facts();
  run.machine = record.at("machine").facts();
  run.compiler = record.at("compiler").facts();
  run.program = record.at("copse").facts();
  run.time = record.text("time");
  if (run.failed) return run;

  run.cost = bvh.number("sah_cost");
  run.nodes = bvh.number("nodes");
  run.leaves = bvh.number("leaves");
  run.depth = bvh.number("depth");
  run.overlap = bvh.number("end_point_overlap");
  const Reader memory = record.at("memory");
  run.treeBytes = memory.number("tree_bytes");
  if (!known(run.treeBytes)) run.treeBytes = bvh.number("bytes");
  run.buildPeakBytes = memory.number("build_peak_bytes");
  run.build = time.number("build");
  run.render = time.number("render");
  run.total = time.number("total");
  run.buildPhases = time.numbers("build_phases");
  run.renderPhases = time.numbers("render_phases");
  run.rays = record.at("rays").byKind();
  run.rates = record.at("mrays_per_s").byKind();
  run.rate = record.at("mrays_per_s").number("all");
  const Reader traversal = record.at("traversal");
  for (std::size_t kind = 0; kind < rayKinds.size(); ++kind) {
    run.nodesPerRay[kind] = traversal.at(rayKinds[kind]).number("nodes");
    run.trianglesPerRay[kind] = traversal.at(rayKinds[kind]).number("triangles");
  }
  return run;
}

Experiment toExperiment(const Reader& json) {
  Experiment experiment;
  experiment.name = json.text("name");
  experiment.title = json.text("title");
  experiment.description = json.text("description");
  experiment.config = json.text("config");
  experiment.started = json.text("started");
  experiment.finished = json.text("finished");
  experiment.planned = json.count("planned", -1);
  experiment.machine = json.at("machine").facts();
  experiment.compiler = json.at("compiler").facts();
  for (const Reader& left : json.objects("left_out"))
    experiment.leftOut.emplace_back(left.text("kind") + " " + left.text("name"), left.text("why"));
  experiment.report = json.texts("report");
  return experiment;
}

std::vector<Run> runsOfArray(const std::string& file) {
  const std::string text = contents(file);
  Json json = parse(file, text);
  if (json.is_object()) json = Json::array({json});  // What --stats writes.
  if (!json.is_array()) throw InputError(file + ":1: expected an array of records");
  const std::vector<std::size_t> starts = elementStarts(text);
  std::vector<Run> runs;
  for (std::size_t i = 0; i < json.size(); ++i) {
    const std::size_t start = starts.size() == json.size() ? starts[i] : 0;
    runs.push_back(toRun({json[i], fmt::format("{}:{}", file, lineAt(text, start))}));
  }
  return runs;
}

std::size_t linesOf(const std::string& file) {
  const std::string text = contents(file);
  return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
}

/// The journal of a bench that was cut off: its last line may be torn.
std::vector<Run> runsOfJournal(const std::string& file) {
  const std::string text = contents(file);
  std::vector<Run> runs;
  std::size_t number = 1;
  for (std::size_t start = 0; start < text.size(); ++number) {
    const std::size_t end = text.find('\n', start);
    if (end == std::string::npos) break;
    const std::string line = text.substr(start, end - start);
    if (line.find_first_not_of(" \t\r") != std::string::npos)
      runs.push_back(toRun({parse(file, line, number), fmt::format("{}:{}", file, number)}));
    start = end + 1;
  }
  return runs;
}

}  // namespace

double Run::parameter(const std::string& name) const {
  for (const auto& [key, value] : parameters)
    if (key == name) {
      char* end = nullptr;
      const double number = std::strtod(value.c_str(), &end);
      return end != value.c_str() && *end == 0 ? number : missing;
    }
  return missing;
}

bool Run::onGpu() const {
  return std::find(device.begin(), device.end(), std::pair<std::string, std::string>("kind", "cuda")) != device.end();
}

Loaded load(const std::string& folder) {
  namespace fs = std::filesystem;
  std::error_code ignored;
  if (!fs::is_directory(folder, ignored)) throw InputError(folder + ": no such folder");
  const std::string array = (fs::path(folder) / "results.json").string();
  const std::string journal = (fs::path(folder) / "results.jsonl").string();
  const std::string experiment = (fs::path(folder) / "experiment.json").string();
  Loaded loaded;
  loaded.folder = folder;
  if (fs::exists(array, ignored)) {
    loaded.source = array;
    loaded.runs = runsOfArray(array);
  }
  // The array is written when a bench ends; one that was resumed and cut off again has more in its journal.
  if (fs::exists(journal, ignored) && (loaded.source.empty() || linesOf(journal) > loaded.runs.size())) {
    loaded.source = journal;
    loaded.runs = runsOfJournal(journal);
  }
  if (loaded.source.empty()) {
    throw InputError(folder + ": not a results folder (no results.json or results.jsonl)");
  }
  if (fs::exists(experiment, ignored)) {
    const std::string text = contents(experiment);
    const Json json = parse(experiment, text);
    loaded.experiment = toExperiment({json, experiment + ":1"});
  }
  return loaded;
}

}  // namespace copse::report
