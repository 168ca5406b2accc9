// The order of the page: what was asked, the table, the figures, the images, how it was measured, what failed.
#include "tracer/report/page.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "tracer/report/html.h"
#include "tracer/report/style.h"
#include "tracer/report/table.h"

namespace copse::report {

namespace {

std::string titleOf(const Results& results) {
  const Experiment& experiment = results.loaded.experiment;
  if (!experiment.title.empty()) return experiment.title;
  if (!experiment.name.empty()) return experiment.name;
  return "Time to image";
}

int failedRuns(const Results& results) {
  return static_cast<int>(
      std::count_if(results.loaded.runs.begin(), results.loaded.runs.end(), [](const Run& run) { return run.failed; }));
}

std::string fact(const Facts& facts, const char* name) {
  for (const auto& [key, value] : facts)
    if (key == name) return value;
  return "";
}

/// "22 Nov 2026, Xeon …, 2 threads, copse 0.1.0 (ecc6d12): 54 runs of 3 scenes and 9 methods".
std::string about(const Results& results) {
  const std::vector<Run>& runs = results.loaded.runs;
  if (runs.empty()) return "No runs.";
  const Run& first = runs.front();
  std::vector<std::string> methods;
  for (const Run& run : runs)
    if (std::find(methods.begin(), methods.end(), run.label) == methods.end()) methods.push_back(run.label);
  const auto several = [](std::size_t count, const char* what) {
    return fmt::format("{} {}{}", shownCount(static_cast<double>(count)), what, count == 1 ? "" : "s");
  };
  std::string text = fmt::format("{} of {} and {}", several(runs.size(), "run"),
                                 several(results.scenes.size(), "scene"), several(methods.size(), "method"));
  const std::string device = fact(first.device, "name"), threads = fact(first.device, "threads");
  if (!device.empty()) text += fmt::format(" on {}", device);
  if (!first.onGpu() && !threads.empty()) text += fmt::format(", {} thread{}", threads, threads == "1" ? "" : "s");
  if (const std::string version = fact(first.program, "version"); !version.empty())
    text += fmt::format("; copse {} ({})", version, fact(first.program, "commit"));
  if (!first.time.empty()) text += ", " + first.time.substr(0, 10);
  return text + ".";
}

std::string warnings(const Results& results, const std::string& note) {
  const Experiment& experiment = results.loaded.experiment;
  std::string out;
  const auto warn = [&](const std::string& text) { out += fmt::format("<p class=\"warning\">{}</p>\n", text); };
  if (results.loaded.runs.empty()) warn("No results yet: no run has finished.");
  // Counted here: the experiment's own account is written when a bench ends, not when it is killed.
  if (const int left = experiment.planned - static_cast<int>(results.loaded.runs.size()); left > 0)
    warn(fmt::format("Incomplete: {} of {} planned runs are missing. Rows with fewer views are marked.", left,
                     experiment.planned));
  if (const int failed = failedRuns(results)) {
    warn(fmt::format("{} run{} failed and {} in no figure; see <a href=\"#failed\">what failed</a>.", failed,
                     failed > 1 ? "s" : "", failed > 1 ? "are" : "is"));
  }
  if (!note.empty()) warn(escape(note));
  return out;
}

std::string section(const char* id, const char* title, const std::string& content) {
  if (content.empty()) return "";
  return fmt::format("<section id=\"{}\">\n<h2>{}</h2>\n{}</section>\n", id, title, content);
}

/// Table 1; a sweep of many parameters is told better by its figures, so there it is to be opened.
std::string tableSection(const Results& results) {
  std::size_t maxRows = 0;
  for (const Scene& scene : results.scenes) maxRows = std::max(maxRows, scene.rows.size());
  if (maxRows == 0 || !results.asksFor("table")) return "";
  const std::string table = tableHtml(results);
  if (maxRows > 40) return fmt::format("<details><summary>All {} methods</summary>\n{}</details>\n", maxRows, table);
  return table + winnersHtml(results);
}

std::string filesHtml(const Results& results, const std::vector<Figure>& figures) {
  const std::string source = std::filesystem::path(results.loaded.source).filename().string();
  std::string out = fmt::format(
      "<p>Beside this page: <a href=\"{0}\">{0}</a>, every run with all that was recorded; <a href=\"table1.csv\">"
      "table1.csv</a>, Table 1 with ranges, the paper's values and all ratios.",
      escape(source));
  if (!figures.empty())
    out +=
        " <code>figures/</code> has each picture as <code>.svg</code>, its data as <code>.csv</code>, and the "
        "<code>.gp</code> that draws it: change what you like and run <code>gnuplot NAME.gp</code> there.";
  return out + "</p>\n";
}

}  // namespace

std::string document(const std::string& title, const std::string& body) {
  return fmt::format(
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n"
      "<title>{}</title>\n<style>{}</style>\n</head>\n<body>\n{}</body>\n</html>\n",
      escape(title), style, body);
}

std::string figureHtml(const Figure& figure) {
  std::string out = "<figure>\n<div class=\"panels\">\n";
  for (const Panel& panel : figure.panels)
    out += fmt::format("<div{}>{}</div>\n", panel.wide ? " class=\"wide\"" : "", panel.svg);
  return fmt::format("<h3>{}</h3>\n{}</div>\n<figcaption>{}</figcaption>\n</figure>\n", escape(figure.title), out,
                     figure.caption);
}

std::string pageOf(const Results& results, const std::vector<Figure>& figures, const std::string& note) {
  const Experiment& experiment = results.loaded.experiment;
  std::string drawn;
  for (const Figure& figure : figures)
    if (std::any_of(figure.panels.begin(), figure.panels.end(), [](const Panel& p) { return !p.svg.empty(); }))
      drawn += figureHtml(figure);
  const std::pair<const char*, std::pair<const char*, std::string>> sections[] = {
      {"table", {"Table 1", tableSection(results)}},
      {"figures", {"Figures", drawn}},
      {"images", {"Images", imagesHtml(results)}},
      {"rays", {"Rays by kind", raysHtml(results)}},
      {"trees", {"Trees", treesHtml(results)}},
      {"measured", {"How it was measured", measuredHtml(results) + parametersHtml(results)}},
      {"failed", {"What failed", failuresHtml(results)}},
      {"files", {"Files", filesHtml(results, figures)}},
  };
  std::string links, content;
  for (const auto& [id, part] : sections) {
    if (part.second.empty()) continue;
    links += fmt::format("<a href=\"#{}\">{}</a> ", id, part.first);
    content += section(id, part.first, part.second);
  }
  std::string head = fmt::format("<header>\n<h1>{}</h1>\n", escape(titleOf(results)));
  if (!experiment.description.empty())
    head += fmt::format("<p class=\"lead\">{}</p>\n", escape(experiment.description));
  head += fmt::format("<p class=\"about\">{}</p>\n{}<nav>{}</nav>\n</header>\n", escape(about(results)),
                      warnings(results, note), links);
  return document(
      titleOf(results),
      head + "<main>\n" + content +
          "</main>\n<footer>Made by <code>copse report</code>. The paper: D. Meister, J. Bittner, "
          "“Parallel BVH Construction using k-means Clustering”, The Visual Computer 32 (2016).</footer>\n");
}

}  // namespace copse::report
