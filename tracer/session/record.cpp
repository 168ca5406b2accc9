// The record's JSON. Names and units are fixed: other people's scripts read them. What was not measured is null.
#include "tracer/session/record.h"

#include <fmt/format.h>

#include <ctime>
#include <nlohmann/json.hpp>

#include "builder/base/version.h"
#include "tracer/integrators/phases.h"
#include "tracer/session/machine.h"

namespace copse {

namespace {

using Json = nlohmann::ordered_json;

Json valueJson(const ParameterValue& value) {
  return std::visit([](const auto& v) { return Json(v); }, value);
}

Json parametersJson(const Parameters& parameters) {
  Json json = Json::object();
  for (const ParameterSpec& spec : parameters.table())
    if (spec.ofTree) json[spec.name] = valueJson(parameters.value(spec.name));
  return json;
}

/// How rays were traced: the tracer, and those of its parameters that are not the defaults. Times depend on them, trees
/// do not.
Json tracerJson(const RunRecord& record) {
  Json json;
  if (!record.tracer.empty()) json["name"] = record.tracer;
  if (!record.parameters) return json;
  for (const ParameterSpec& spec : record.parameters->table())
    if (const ParameterValue value = record.parameters->value(spec.name); !spec.ofTree && value != spec.defaultValue())
      json["parameters"][spec.name] = valueJson(value);
  return json;
}

Json phasesJson(const std::vector<PhaseTime>& phases) {
  Json json = Json::object();
  for (const PhaseTime& phase : phases) json[phase.name] = phase.ms;
  return json;
}

template <class T>
Json orNull(const std::optional<T>& value) {
  return value ? Json(*value) : Json(nullptr);
}

Json treeJson(const std::optional<TreeRecord>& tree) {
  if (!tree) return nullptr;
  Json json;
  for (const char* name : {"sah_cost", "nodes", "leaves", "depth", "max_leaf_triangles", "arity"}) json[name] = nullptr;
  if (tree->statistics) {
    const TreeStatistics& s = *tree->statistics;
    json["sah_cost"] = s.sahCost;
    json["nodes"] = s.nodes;
    json["leaves"] = s.leaves;
    json["depth"] = s.depth;
    json["max_leaf_triangles"] = s.maxLeafTriangles;
    json["arity"] = s.arity;
  }
  if (tree->wideCost) json["wide_cost"] = *tree->wideCost;
  json["bytes"] = tree->bytes;
  json["end_point_overlap"] = orNull(tree->endPointOverlap);
  return json;
}

Json countsJson(const std::optional<TraversalCounts>& counts) {
  if (!counts) return nullptr;
  return {{"nodes", counts->nodes}, {"triangles", counts->triangles}};
}

Json runJson(const RunIdentity& run) {
  Json json{{"key", run.key},
            {"label", run.label},
            {"repetition", run.repetition},
            {"status", run.error.empty() ? "done" : "failed"}};
  if (!run.error.empty()) json["error"] = run.error;
  json["experiment"] = run.experiment;
  json["warm_up"] = run.warmUp;
  return json;
}

Json textOrNull(const std::string& text) { return text.empty() ? Json(nullptr) : Json(text); }

Json machineJson(const Device& device) {
  const Machine machine = machineOf(device);
  return {{"cpu", machine.cpu},
          {"processors", machine.processors},
          {"memory_bytes", machine.memoryBytes},
          {"system", machine.system},
          {"driver", textOrNull(machine.driver)}};
}

Json compilerJson() {
  const Compiler used = compiler();
  return {{"name", used.name}, {"version", used.version}, {"flags", used.flags}, {"cuda", textOrNull(used.cuda)}};
}

Json vectorJson(const glm::dvec3& v) { return {v.x, v.y, v.z}; }

Json cameraJson(const Camera& camera) {
  return {{"eye", vectorJson(camera.exactEye())},
          {"at", vectorJson(camera.exactAt())},
          {"up", vectorJson(camera.up)},
          {"vfov", camera.vfov}};
}

Json raysJson(const RayCounts& rays) {
  return {{"primary", rays.primary}, {"bounce", rays.bounce}, {"shadow", rays.shadow}};
}

Json earlierJson(const EarlierRuns& earlier) {
  return {{"runs", earlier.runs},
          {"samples_done", earlier.samplesDone},
          {"time_ms", {{"load", earlier.loadMs}, {"build", earlier.buildMs}, {"render", earlier.renderMs}}},
          {"rays", raysJson(earlier.rays)}};
}

Json imageJson(const ImageRecord& image) {
  const RenderSettings& s = image.settings;
  Json json = {{"file", image.file},
               {"width", s.width},
               {"height", s.height},
               {"spp", s.spp},
               {"view", image.view},
               {"samples_done", image.samplesDone},
               {"integrator", image.integrator},
               {"max_depth", s.maxDepth},
               {"light_samples", s.lightSamples},
               {"seed", s.seed},
               {"camera", cameraJson(image.camera)}};
  for (const auto& [name, value] : image.figures) json["figures"][name] = value;
  return json;
}

Json rateJson(double rate) { return rate < 0 ? Json(nullptr) : Json(rate); }

Json deviceJson(const Device& device) {
  return {{"kind", device.kindName()}, {"name", device.name}, {"threads", device.threads}};
}

}  // namespace

std::string timeNow() {
  const std::time_t now = std::time(nullptr);
  std::tm parts{};
  gmtime_r(&now, &parts);
  char text[32];
  std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &parts);
  return text;
}

std::string hashText(uint64_t hash) { return fmt::format("{:016x}", hash); }

std::string environmentJson(const Device& device) {
  return Json{{"copse", {{"version", version()}, {"commit", commit()}}},
              {"machine", machineJson(device)},
              {"device", deviceJson(device)},
              {"compiler", compilerJson()}}
      .dump();
}

RayRates rayRates(const RunRecord& record) {
  RayRates rates;
  if (!record.rays) return rates;
  struct Kind {
    const PhaseGroup* group;
    uint64_t rays;
    double* rate;
  };
  const Kind kinds[] = {{&groups::primaryRays, record.rays->primary, &rates.primary},
                        {&groups::bounceRays, record.rays->bounce, &rates.bounce},
                        {&groups::shadowRays, record.rays->shadow, &rates.shadow}};
  double allRays = 0, allMs = 0;
  for (const Kind& kind : kinds)
    for (const PhaseTime& phase : record.renderPhases)
      if (phase.group == kind.group && phase.ms > 0 && kind.rays > 0) {
        *kind.rate = kind.rays / phase.ms * 1e-3;
        allRays += kind.rays;
        allMs += phase.ms;
      }
  if (allMs > 0) rates.all = allRays / allMs * 1e-3;
  return rates;
}

namespace {

/// What a completed run measured.
void addMeasured(Json& json, const RunRecord& record) {
  json["bvh"] = treeJson(record.tree);
  if (record.tree && record.tree->statistics && record.tree->statistics->references > record.triangles)
    json["bvh"]["references"] = record.tree->statistics->references;  // Where triangles were split.
  Json& time = json["time_ms"];
  time["load"] = record.loadMs;
  time["build"] = record.buildMs;
  time["build_phases"] = phasesJson(record.buildPhases);
  if (record.buildRepeats > 1) time["build_repeats"] = record.buildRepeats;
  if (record.image) {
    time["render"] = record.renderMs;
    time["render_phases"] = phasesJson(record.renderPhases);
  }
  time["total"] = record.totalMs();
  json["memory"] = {{"tree_bytes", record.tree ? Json(record.tree->bytes) : Json(nullptr)},
                    {"build_peak_bytes", record.buildPeakBytes ? Json(record.buildPeakBytes) : Json(nullptr)},
                    {"process_peak_bytes", processPeakBytes()}};
  if (record.rays) {
    json["rays"] = raysJson(*record.rays);
    const RayRates rates = rayRates(record);
    json["mrays_per_s"] = {{"primary", rateJson(rates.primary)},
                           {"bounce", rateJson(rates.bounce)},
                           {"shadow", rateJson(rates.shadow)},
                           {"all", rateJson(rates.all)}};
  }
  if (record.traversal)
    json["traversal"] = {{"primary", countsJson(record.traversal->primary)},
                         {"bounce", countsJson(record.traversal->bounce)},
                         {"shadow", countsJson(record.traversal->shadow)},
                         {"counted_by", record.traversal->countedBy}};
}

}  // namespace

std::string toJson(const RunRecord& record, bool compact) {
  Json json;
  json["schema"] = 1;
  json["copse"] = {{"version", version()}, {"commit", commit()}};
  json["time"] = timeNow();
  if (record.run) json["run"] = runJson(*record.run);
  // A run that failed may not have got as far as a scene.
  const bool counted = !record.failed();
  json["scene"] = {{"name", record.sceneName},
                   {"triangles", counted || record.triangles ? Json(record.triangles) : Json(nullptr)},
                   {"emitters", counted ? Json(record.emitters) : Json(nullptr)},
                   {"file", record.sceneFile},
                   {"generated", record.sceneGenerated}};
  if (record.sceneOptions.up == UpAxis::z) json["scene"]["up"] = "z";
  if (record.sceneOptions.skyRotation) json["scene"]["sky_rotation"] = *record.sceneOptions.skyRotation;
  if (record.sceneHash) json["scene"]["hash"] = hashText(record.sceneHash);
  json["machine"] = machineJson(record.device);
  json["device"] = deviceJson(record.device);
  json["compiler"] = compilerJson();
  json["builder"] = {{"name", record.builder},
                     {"parameters", record.parameters ? parametersJson(*record.parameters) : Json::object()}};
  if (!record.optimisers.empty()) json["builder"]["optimise"] = record.optimisers;
  if (const Json tracer = tracerJson(record); !tracer.empty()) json["tracer"] = tracer;
  if (record.image) json["image"] = imageJson(*record.image);
  if (record.earlier) json["earlier"] = earlierJson(*record.earlier);
  if (!record.failed()) addMeasured(json, record);
  // Names come from files; bytes that are not UTF-8 must not stop a render that is done.
  return json.dump(compact ? -1 : 2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace copse
