// experiment.json and results.json.
#include "tracer/bench/results.h"

#include <fmt/format.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "builder/base/error.h"
#include "builder/base/files.h"
#include "builder/base/text.h"
#include "builder/base/version.h"
#include "builder/base/whole_file.h"
#include "tracer/session/record.h"

namespace copse {

namespace {

using Json = nlohmann::ordered_json;

/// What must be the same for results in one table. It is a part of experiment.json.
Json identityOf(const Experiment& experiment, const Device& device) {
  Json json = Json::parse(environmentJson(device));
  json["config"] = experiment.text;
  if (!experiment.tracer.empty()) json["tracer"] = experiment.tracer;
  json["scenes"] = Json::array();
  for (const ExperimentScene& scene : experiment.scenes) {
    const bool described = extensionOf(scene.file) == ".toml";
    json["scenes"].push_back({{"name", scene.name},
                              {"description", described ? Json(readFile(scene.file)) : Json(nullptr)},
                              {"mesh_bytes", scene.bytes}});
    if (scene.options.up == UpAxis::z) json["scenes"].back()["up"] = "z";
  }
  json["left_out"] = Json::array();
  for (const LeftOut& left : experiment.leftOut)
    json["left_out"].push_back({{"kind", left.kind}, {"name", left.name}, {"why", left.why}});
  return json;
}

/// The name of a part of the identity in messages.
struct Part {
  const char* key;
  const char* words;
};
constexpr Part parts[] = {{"config", "the configuration"},
                          {"tracer", "--tracer"},
                          {"scenes", "a scene's description or mesh"},
                          {"copse", "the version of Copse"},
                          {"compiler", "the compiler or its configuration"},
                          {"machine", "the machine"},
                          {"device", "the device or its number of threads"},
                          {"left_out", "the set of scenes and builders left out"}};

}  // namespace

bool holdsExperiment(const std::string& folder) {
  for (const char* name : {"experiment.json", "results.jsonl", "results.json"}) {
    std::error_code error;
    if (std::filesystem::exists(std::filesystem::path(folder) / name, error)) return true;
  }
  return false;
}

void writeExperimentJson(const std::string& folder, const Experiment& experiment, const Device& device,
                         const Progressed& progressed) {
  Json json{{"schema", 1},
            {"name", experiment.name},
            {"title", experiment.title},
            {"description", experiment.description},
            {"report", experiment.report},
            {"planned", progressed.planned},
            {"done", progressed.done},
            {"failed", progressed.failed},
            {"started", progressed.started.empty() ? timeNow() : progressed.started},
            {"finished", progressed.finished.empty() ? Json(nullptr) : Json(progressed.finished)}};
  json["repetitions"] = experiment.repetitions;
  const WarmUp& warm = experiment.warmUp;
  json["warm_up"] = {{"least", warm.min}, {"most", warm.max}, {"within", warm.within}, {"builds", warm.builds}};
  json.update(identityOf(experiment, device));
  writeWholeFile(folder + "/experiment.json", json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
}

Progressed checkSameExperiment(const std::string& folder, const Experiment& experiment, const Device& device) {
  const std::string file = folder + "/experiment.json";
  std::error_code error;
  if (!std::filesystem::exists(file, error))
    throw InputError(fmt::format("{}: has results but no experiment.json, so their experiment is unknown", folder));
  const Json was = Json::parse(readFile(file), nullptr, false);
  if (!was.is_object() || !was.contains("started") || !was["started"].is_string())
    throw InputError(file + ": expected the description of an experiment");
  // Converted to text and back, as the file was: bytes that are not UTF-8 are replaced on both sides.
  const Json now = Json::parse(identityOf(experiment, device).dump(-1, ' ', false, Json::error_handler_t::replace));
  for (const Part& part : parts) {
    Json before = was.value(part.key, Json()), after = now.value(part.key, Json());
    if (before.is_object()) before.erase("memory_bytes");  // It differs by some pages from boot to boot.
    if (after.is_object()) after.erase("memory_bytes");
    if (before == after) continue;
    std::string detail;
    if (part.key != std::string_view("config") && part.key != std::string_view("scenes"))
      detail = fmt::format("\n  then {}\n  now  {}", before.dump(), after.dump());
    throw InputError(
        fmt::format("{}: cannot resume: {} has changed since it was started{}\n  name another folder with -o", folder,
                    part.words, detail));
  }
  Progressed progressed;
  progressed.started = was["started"];
  if (const Json finished = was.value("finished", Json()); finished.is_string()) progressed.finished = finished;
  return progressed;
}

void writeResults(const std::string& folder, const std::vector<Journal::Entry>& entries) {
  std::string text = "[";
  for (const Journal::Entry& entry : entries) text += (text.size() > 1 ? ",\n" : "\n") + entry.line;
  writeWholeFile(folder + "/results.json", text + "\n]\n");
  writeWholeFile(folder + "/results.csv", resultsCsv(entries));
}

}  // namespace copse
