// What a reviewer asks: on what, with what, how often, and what the numbers mean. And what failed.
#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>

#include "tracer/report/html.h"
#include "tracer/report/page.h"

namespace copse::report {

namespace {

/// The facts of all runs: where runs differ, all values of the name.
Facts together(const std::vector<Run>& runs, Facts Run::*member) {
  Facts all;
  std::map<std::string, std::set<std::string>> seen;
  for (const Run& run : runs)
    for (const auto& [name, value] : run.*member) {
      if (!seen[name].insert(value).second) continue;
      const auto same = [&name = name](const auto& fact) { return fact.first == name; };
      const auto found = std::find_if(all.begin(), all.end(), same);
      if (found == all.end())
        all.emplace_back(name, value);
      else if (seen[name].size() <= 8)
        found->second += " | " + value;
    }
  return all;
}

std::string readable(std::string name) {
  std::replace(name.begin(), name.end(), '_', ' ');
  return name;
}

/// Names as words, bytes as sizes.
Facts readable(const Facts& facts) {
  Facts out;
  for (const auto& [name, value] : facts) {
    const bool bytes = name.size() > 6 && name.substr(name.size() - 6) == "_bytes";
    out.emplace_back(bytes ? readable(name.substr(0, name.size() - 6)) : readable(name),
                     bytes && value.find_first_not_of("0123456789") == std::string::npos
                         ? shownBytes(std::strtod(value.c_str(), nullptr))
                         : value);
  }
  return out;
}

void append(Facts& all, const Facts& more, const std::string& prefix) {
  for (const auto& [name, value] : more) {
    const auto same = [&value = value](const auto& fact) { return fact.second == value; };
    const bool there = std::any_of(all.begin(), all.end(), same);
    if (!there) all.emplace_back(prefix + name, value);
  }
}

/// "±1.8 % in the median row, ±6.2 % in the worst": half the range of times to image over their value.
std::string spread(const Results& results) {
  std::vector<double> all;
  for (const Scene& scene : results.scenes)
    for (const Row& row : scene.rows)
      for (const auto& [spp, value] : row.total)
        if (!row.ideal && value.runs > value.views) all.push_back(value.spread());
  if (all.empty()) return "";
  return fmt::format("±{:.1f} % in the median row, ±{:.1f} % in the worst", 100 * median(all),
                     100 * *std::max_element(all.begin(), all.end()));
}

const char* const meaning =
    "<p>One run builds the tree anew and renders one view once. <i>Build</i> begins with the triangles in the "
    "device's memory and ends with the tree that rays traverse: boxes, sorting, hierarchy, leaves and layout are "
    "included, reading files is not. <i>Time to image</i> is build and render of that run, by device events on CUDA "
    "and by the clock on a CPU; loading the scene and writing the image are not included. <i>Trace speed</i> is rays "
    "of all kinds, closest-hit and any-hit, over the time of the kernels that trace them, from the runs with the "
    "highest samples per pixel. <i>SAH cost</i> is Σ c<sub>T</sub>·A/A<sub>root</sub> over inner nodes plus Σ "
    "c<sub>I</sub>·n·A/A<sub>root</sub> over leaves of the tree that is traversed, with the parameters below (the "
    "paper: c<sub>T</sub> = 3, c<sub>I</sub> = 2, at most 8 triangles per leaf).</p>\n"
    "<p>Figures are medians over the repetitions of a view, then means over the views; build times, which do not "
    "depend on the view, are medians over all builds of the row. The range is from minimum to maximum; for several "
    "views, the mean of their ranges.</p>\n";

}  // namespace

std::string measuredHtml(const Results& results) { return meaning + measuredFacts(results); }

std::string measuredFacts(const Results& results) {
  const std::vector<Run>& runs = results.loaded.runs;
  Facts facts;
  const Experiment& experiment = results.loaded.experiment;
  append(facts, readable(together(runs, &Run::program)), "copse ");
  append(facts, readable(together(runs, &Run::device)), "device ");
  append(facts, readable(experiment.machine), "machine ");
  append(facts, readable(together(runs, &Run::machine)), "machine ");
  append(facts, readable(experiment.compiler), "compiler ");
  append(facts, readable(together(runs, &Run::compiler)), "compiler ");
  append(facts, readable(together(runs, &Run::settings)), "render ");
  std::set<std::string> sizes, counts;
  int repetitions = 0, warmUp = -1;
  for (const Run& run : runs) {
    if (run.width > 0) sizes.insert(fmt::format("{}×{}", run.width, run.height));
    repetitions = std::max(repetitions, run.repetition);
    warmUp = std::max(warmUp, run.warmUp);
  }
  for (const int spp : results.spp) counts.insert(std::to_string(spp));
  if (!sizes.empty()) facts.emplace_back("image size", fmt::format("{}", fmt::join(sizes, ", ")));
  if (!results.spp.empty()) facts.emplace_back("samples per pixel", fmt::format("{}", fmt::join(results.spp, ", ")));
  if (repetitions > 0) facts.emplace_back("repetitions", std::to_string(repetitions));
  if (warmUp >= 0) facts.emplace_back("warm-up", fmt::format("at most {} runs discarded", warmUp));
  if (const std::string text = spread(results); !text.empty()) facts.emplace_back("spread of time to image", text);
  if (!experiment.started.empty()) facts.emplace_back("started", experiment.started);
  if (!experiment.finished.empty()) facts.emplace_back("finished", experiment.finished);
  return factList(facts);
}

std::string parametersHtml(const Results& results) {
  std::vector<std::pair<std::string, const Row*>> rows;
  for (const Scene& scene : results.scenes)
    for (const Row& row : scene.rows) {
      const bool there = std::any_of(rows.begin(), rows.end(), [&](const auto& r) { return r.first == row.label; });
      if (!row.ideal && !there) rows.emplace_back(row.label, &row);
    }
  // A parameter is everybody's where all rows that have any agree; otherwise it is told of the rows that differ from
  // most, and of those whose method reads it. Rows have the tracer's where these are not the usual ones.
  std::map<std::string, std::map<std::string, int>> values;
  std::vector<std::string> order;
  for (const auto& [label, row] : rows)
    for (const auto& [name, value] : row->parameters) {
      if (!values.count(name)) order.push_back(name);
      ++values[name][value];
    }
  if (order.empty()) return "";
  Facts common;
  PlainTable table;
  table.caption = "Parameters in which rows differ.";
  table.headers = {"method", "builder", "its own parameters"};
  table.texts = 3;
  const auto withAny =
      std::count_if(rows.begin(), rows.end(), [](const auto& r) { return !r.second->parameters.empty(); });
  const auto everybodys = [&](const std::string& name) {
    return values[name].size() == 1 && values[name].begin()->second == withAny;
  };
  std::map<std::string, std::string> usual;
  for (const std::string& name : order) {
    const auto commonest = std::max_element(values[name].begin(), values[name].end(),
                                            [](const auto& a, const auto& b) { return a.second < b.second; });
    usual[name] = commonest->first;
    if (everybodys(name)) common.emplace_back(name, commonest->first);
  }
  for (const auto& [label, row] : rows) {
    std::string own;
    for (const auto& [name, value] : row->parameters) {
      const bool shared = !isOfOneMethod(name) && value != usual[name];
      if (everybodys(name) || !(readsParameter(row->builder, name) || isOfTracer(name) || shared)) continue;
      own += fmt::format("{}{} = {}", own.empty() ? "" : ", ", name, value);
    }
    if (!own.empty()) table.rows.push_back({escape(label), escape(row->builder), escape(own)});
  }
  std::string out = table.rows.empty() ? "" : table.html();
  out += "<details><summary>Parameters that are the same for all rows</summary>\n" + factList(common) + "</details>\n";
  if (const std::string& config = results.loaded.experiment.config; !config.empty())
    out += "<details><summary>The experiment's description</summary><pre>" + escape(config) + "</pre></details>\n";
  return out;
}

std::string failuresHtml(const Results& results) {
  PlainTable table;
  table.caption = "Failed runs; the others continued.";
  table.headers = {"scene", "view", "method", "spp", "repetition", "why"};
  table.texts = 6;
  for (const Run& run : results.loaded.runs)
    if (run.failed)
      table.rows.push_back({escape(run.scene), escape(run.view), escape(run.label),
                            run.spp > 0 ? std::to_string(run.spp) : "", std::to_string(run.repetition),
                            escape(run.error.empty() ? "not said" : run.error)});
  const Facts& leftOut = results.loaded.experiment.leftOut;
  return foldedWhereLong(table) +
         (leftOut.empty() ? "" : "<p>Skipped, as it cannot be measured here:</p>\n" + factList(leftOut));
}

}  // namespace copse::report
