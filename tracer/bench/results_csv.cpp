// results.csv: the records flattened, one column per value; each phase has a column under its own name.
#include <algorithm>
#include <nlohmann/json.hpp>

#include "tracer/bench/results.h"

namespace copse {

namespace {

using Json = nlohmann::ordered_json;

struct Column {
  const char* name;
  const char* pointer;  ///< Where it is in a record, as RFC 6901 writes it.
};

constexpr Column columns[] = {
    {"key", "/run/key"},
    {"scene", "/scene/name"},
    {"view", "/image/view"},
    {"label", "/run/label"},
    {"spp", "/image/spp"},
    {"repetition", "/run/repetition"},
    {"status", "/run/status"},
    {"error", "/run/error"},
    {"triangles", "/scene/triangles"},
    {"builder", "/builder/name"},
    {"device", "/device/kind"},
    {"device_name", "/device/name"},
    {"threads", "/device/threads"},
    {"width", "/image/width"},
    {"height", "/image/height"},
    {"sah_cost", "/bvh/sah_cost"},
    {"wide_cost", "/bvh/wide_cost"},
    {"end_point_overlap", "/bvh/end_point_overlap"},
    {"nodes", "/bvh/nodes"},
    {"leaves", "/bvh/leaves"},
    {"depth", "/bvh/depth"},
    {"arity", "/bvh/arity"},
    {"max_leaf_triangles", "/bvh/max_leaf_triangles"},
    {"build_ms", "/time_ms/build"},
    {"render_ms", "/time_ms/render"},
    {"total_ms", "/time_ms/total"},
    {"load_ms", "/time_ms/load"},
    {"rays_primary", "/rays/primary"},
    {"rays_bounce", "/rays/bounce"},
    {"rays_shadow", "/rays/shadow"},
    {"mrays_per_s_primary", "/mrays_per_s/primary"},
    {"mrays_per_s_bounce", "/mrays_per_s/bounce"},
    {"mrays_per_s_shadow", "/mrays_per_s/shadow"},
    {"mrays_per_s_all", "/mrays_per_s/all"},
    {"nodes_per_primary", "/traversal/primary/nodes"},
    {"nodes_per_bounce", "/traversal/bounce/nodes"},
    {"nodes_per_shadow", "/traversal/shadow/nodes"},
    {"triangles_per_primary", "/traversal/primary/triangles"},
    {"triangles_per_bounce", "/traversal/bounce/triangles"},
    {"triangles_per_shadow", "/traversal/shadow/triangles"},
    {"tree_bytes", "/memory/tree_bytes"},
    {"build_peak_bytes", "/memory/build_peak_bytes"},
    {"process_peak_bytes", "/memory/process_peak_bytes"},
    {"seed", "/image/seed"},
    {"warm_up", "/run/warm_up"},
    {"time", "/time"},
    {"tracer", "/tracer/name"},
    {"optimise", "/builder/optimise"},
};

std::string field(const Json& value) {
  if (value.is_null()) return "";
  std::string text;
  if (value.is_array())  // Names, as the command line lists them.
    for (const Json& name : value) text += (text.empty() ? "" : ",") + name.get<std::string>();
  else
    text = value.is_string() ? value.get<std::string>() : value.dump();
  if (text.find_first_of(",\"\n\r") == std::string::npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

/// "kmeans.k=8 kmeans.p=5 …", followed by the tracer's, if any.
std::string parametersText(const Json& record) {
  std::string text;
  for (const auto& list : {"/builder/parameters"_json_pointer, "/tracer/parameters"_json_pointer}) {
    if (!record.contains(list)) continue;
    for (const auto& [name, value] : record.at(list).items())
      text += (text.empty() ? "" : " ") + name + "=" + (value.is_string() ? value.get<std::string>() : value.dump());
  }
  return text;
}

Json at(const Json& record, const Json::json_pointer& pointer) {
  return record.contains(pointer) ? record.at(pointer) : Json();
}

}  // namespace

std::string resultsCsv(const std::vector<Journal::Entry>& entries) {
  std::vector<Json> records;
  for (const Journal::Entry& entry : entries) records.push_back(Json::parse(entry.line));

  // Every phase in the records, in order of first appearance.
  std::vector<std::pair<std::string, Json::json_pointer>> phases;
  for (const char* kind : {"build", "render"})
    for (const Json& record : records) {
      const Json::json_pointer list(std::string("/time_ms/") + kind + "_phases");
      if (!record.contains(list)) continue;
      for (const auto& [name, ms] : record.at(list).items()) {
        const std::string column = std::string(kind) + ": " + name;
        if (std::none_of(phases.begin(), phases.end(), [&](const auto& p) { return p.first == column; }))
          phases.emplace_back(column, list / name);
      }
    }

  std::string text;
  for (const Column& column : columns) text += (text.empty() ? "" : ",") + std::string(column.name);
  text += ",parameters";
  for (const auto& [name, pointer] : phases) text += "," + field(name);
  text += "\n";
  for (const Json& record : records) {
    std::string line;
    for (const Column& column : columns)
      line += (&column == columns ? "" : ",") + field(at(record, Json::json_pointer(column.pointer)));
    line += "," + field(parametersText(record));
    for (const auto& [name, pointer] : phases) line += "," + field(at(record, pointer));
    text += line + "\n";
  }
  return text;
}

}  // namespace copse
