// The table at the end of `copse bench`: medians over repetitions, means over views.
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "builder/base/statistics.h"
#include "tracer/bench/results.h"

namespace copse {

namespace {

using Json = nlohmann::ordered_json;

/// Half of the range, relative to the median; negative for fewer than two runs.
double spread(const std::vector<double>& values) {
  if (values.size() < 2) return -1;
  const auto [min, max] = std::minmax_element(values.begin(), values.end());
  const double middle = median(values);
  return middle > 0 ? (*max - *min) / 2 / middle : 0;
}

struct Row {
  Json cost;
  std::vector<double> build, speed, peak;
  std::map<int, std::map<std::string, std::vector<double>>> total;  // By samples, view.
  int failed = 0;
};

struct Table {
  std::string name;
  uint64_t triangles = 0;
  std::vector<std::string> order;
  std::map<std::string, Row> rows;
  std::set<int> spp;

  Row& row(const std::string& label) {
    if (!rows.contains(label)) order.push_back(label);
    return rows[label];
  }
};

void add(Table& table, const Json& record) {
  Row& row = table.row(record["run"]["label"]);
  const bool rendered = record.contains("image");
  if (rendered) table.spp.insert(record["image"]["spp"].get<int>());
  if (record["run"]["status"] == "failed") {
    ++row.failed;
    return;
  }
  table.triangles = record["scene"]["triangles"];
  row.cost = record["bvh"]["sah_cost"];
  row.build.push_back(record["time_ms"]["build"]);
  const Json::json_pointer peak("/memory/build_peak_bytes");
  if (record.contains(peak) && record.at(peak).is_number() && table.triangles > 0)
    row.peak.push_back(record.at(peak).get<double>() / static_cast<double>(table.triangles));
  if (!rendered) return;
  row.total[record["image"]["spp"]][record["image"]["view"]].push_back(record["time_ms"]["total"]);
  if (const Json& all = record["mrays_per_s"]["all"]; all.is_number()) row.speed.push_back(all);
}

std::string textOf(const Table& table) {
  std::size_t width = 8;
  for (const std::string& label : table.order) width = std::max(width, label.size());
  const std::string count = table.triangles ? fmt::format(", {} triangles", table.triangles) : "";  // None: all failed.
  std::string text = fmt::format("\n{}{}\n{:<{}}  {:>9}  {:>10}", table.name, count, "", width, "SAH cost", "build ms");
  for (const int spp : table.spp) text += fmt::format("  {:>16}", fmt::format("ms at {} spp", spp));
  if (!table.spp.empty()) text += fmt::format("  {:>9}", "Mrays/s");
  text += fmt::format("  {:>7}  {:>10}\n", "spread", "peak B/tri");
  for (const std::string& label : table.order) {
    const Row& row = table.rows.at(label);
    text += fmt::format("{:<{}}  ", label, width);
    text += row.cost.is_number() ? fmt::format("{:>9.2f}  ", row.cost.get<double>()) : fmt::format("{:>9}  ", "-");
    text += row.build.empty() ? fmt::format("{:>10}", "-") : fmt::format("{:>10.2f}", median(row.build));
    double widest = -1;
    for (const int spp : table.spp) {
      const auto views = row.total.find(spp);
      double sum = 0;
      if (views != row.total.end())
        for (const auto& [view, times] : views->second) sum += median(times), widest = std::max(widest, spread(times));
      text += views == row.total.end() ? fmt::format("  {:>16}", "-")
                                       : fmt::format("  {:>16.1f}", sum / static_cast<double>(views->second.size()));
    }
    if (!table.spp.empty())
      text += row.speed.empty() ? fmt::format("  {:>9}", "-") : fmt::format("  {:>9.2f}", median(row.speed));
    else if (!row.build.empty())
      widest = spread(row.build);
    text += widest < 0 ? fmt::format("  {:>7}", "-") : fmt::format("  {:>5.1f} %", 100 * widest);
    text += row.peak.empty() ? fmt::format("  {:>10}", "-") : fmt::format("  {:>10.0f}", median(row.peak));
    text += row.failed ? fmt::format("  {} failed\n", row.failed) : "\n";
  }
  return text;
}

}  // namespace

std::string resultsTable(const std::vector<Journal::Entry>& entries) {
  std::vector<Table> tables;
  for (const Journal::Entry& entry : entries) {
    const Json record = Json::parse(entry.line);
    const std::string scene = record["scene"]["name"];
    auto table = std::find_if(tables.begin(), tables.end(), [&](const Table& t) { return t.name == scene; });
    if (table == tables.end()) table = tables.insert(table, Table{scene, 0, {}, {}, {}});
    add(*table, record);
  }
  std::string text;
  for (const Table& table : tables) text += textOf(table);
  return text +
         "\nmedians over repetitions, times to image as means over views\n"
         "spread: half the range over the repetitions, relative to their median; the maximum of each row\n";
}

}  // namespace copse
