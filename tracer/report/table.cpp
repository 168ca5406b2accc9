// Table 1 as HTML and as CSV.
//
// Beside each value stands its ratio to the paper's where the two may be set side by side: costs on the very mesh,
// times on a GPU, times to image at the paper's size as well. Elsewhere it is the method's ratio to `lbvh`, with the
// paper's own such ratio in brackets: that compares methods and not machines.
#include "tracer/report/table.h"

#include <fmt/format.h>

#include <algorithm>

#include "tracer/report/html.h"
#include "tracer/report/paper.h"

namespace copse::report {

namespace {

/// Times, rates and costs as the table prints them; what prints alike is equally good.
std::string printed(const Value& value) { return shown(value.value); }

enum class Beside { paper, baseline };

Beside besideOf(const Results& results, const Metric& metric) {
  bool any = false, gpu = true, size = true;
  for (const Scene& scene : results.scenes) {
    if (!isPapersMesh(scene)) continue;
    any = true;
    gpu = gpu && scene.onGpu;
    size = size && scene.width == paperWidth && scene.height == paperHeight;
  }
  if (!any) return Beside::baseline;
  if (metric.kind == Metric::cost) return Beside::paper;
  return gpu && (size || metric.kind != Metric::total) ? Beside::paper : Beside::baseline;
}

double paperValue(const Scene& scene, const Row& row, const Metric& metric) {
  const PaperRow* paper = paperRow(scene, row);
  return paper ? metric.ofPaper(*paper) : missing;
}

double paperOverBaseline(const Scene& scene, const Row& row, const Metric& metric) {
  const PaperRow* baseline = paperBaseline(scene);
  return baseline ? paperValue(scene, row, metric) / metric.ofPaper(*baseline) : missing;
}

double overBaseline(const Scene& scene, const Row& row, const Metric& metric) {
  const Row* baseline = scene.baseline();
  return baseline ? metric.of(row).value / metric.of(*baseline).value : missing;
}

std::string smallPrint(const Scene& scene, const Row& row, const Metric& metric, Beside beside) {
  const double ours = metric.of(row).value;
  if (beside == Beside::paper) {
    const double ratio = ours / paperValue(scene, row, metric);
    return known(ratio) ? "×" + shownRatio(ratio) : "";
  }
  const double theirs = paperOverBaseline(scene, row, metric);
  std::string text = shownRatio(overBaseline(scene, row, metric));
  if (known(theirs)) text += fmt::format(" ({})", shownRatio(theirs));
  return text;
}

/// What the cell shows on hover.
std::string hint(const Scene& scene, const Row& row, const Metric& metric) {
  const Value value = metric.of(row);
  std::string text = fmt::format("{} of {}: {}", metric.title(), row.label, printed(value));
  if (value.runs > 1)
    text += fmt::format(", from {} to {} in {} runs", shown(value.low), shown(value.high), value.runs);
  if (const double theirs = paperValue(scene, row, metric); known(theirs))
    text += fmt::format("; the paper: {}, ours is {} times that", shown(theirs), shownRatio(value.value / theirs));
  return text;
}

std::string cells(const Scene& scene, const Row& row, const Metric& metric, Beside beside) {
  const Value value = metric.of(row);
  if (!value.known()) {
    const bool idealBuild = row.ideal && metric.kind == Metric::build;
    return fmt::format("<td class=\"none\">{}</td><td class=\"beside\"></td>", idealBuild ? "0" : "–");
  }
  const bool best = !row.ideal && printed(value) == bestOf(scene, metric);
  const bool fewer = metric.kind != Metric::build && value.views < static_cast<int>(scene.views.size());
  return fmt::format("<td title=\"{0}\">{1}{2}{3}{4}</td><td class=\"beside\">{5}</td>",
                     escape(hint(scene, row, metric)), best ? "<b>" : "", printed(value), best ? "</b>" : "",
                     fewer ? "<sup>*</sup>" : "", smallPrint(scene, row, metric, beside));
}

std::string sceneHead(const Scene& scene, std::size_t columns) {
  std::string about = known(scene.triangles) ? fmt::format("{} triangles", shownCount(scene.triangles)) : "";
  if (!scene.views.empty()) about += fmt::format(", {} view{}", scene.views.size(), scene.views.size() > 1 ? "s" : "");
  if (scene.width > 0) about += fmt::format(", {}×{}", scene.width, scene.height);
  if (scene.generated) about += ", generated";
  return fmt::format(
      "<tr class=\"scene\"><th scope=\"rowgroup\" colspan=\"{}\"><span>{} <small>{}</small></span></th></tr>\n",
      columns, escape(scene.name), escape(about));
}

std::string besideTitle(Beside beside, bool paper) {
  if (beside == Beside::paper) return "÷ paper";
  return paper ? "÷ lbvh (paper)" : "÷ lbvh";
}

std::string legend(const Results& results, const std::vector<Metric>& columns, bool paper) {
  std::string text =
      "Each value is the median over repetitions, then the mean over the views; hover to see the range. <b>Bold</b>: "
      "best of the scene and column among methods actually built. ";
  bool ideal = false, fewer = false, relative = false;
  for (const Scene& scene : results.scenes) {
    ideal = ideal || scene.ideal();
    for (const Row& row : scene.rows)
      for (const Metric& metric : columns)
        fewer = fewer || (metric.kind != Metric::build && metric.of(row).known() &&
                          metric.of(row).views < static_cast<int>(scene.views.size()));
  }
  for (const Metric& metric : columns) relative = relative || besideOf(results, metric) == Beside::baseline;
  if (ideal)
    text +=
        "<i>sah, ideal</i> is the full sweep with its build time counted as 0, a bound, not a method; <i>sah</i> is "
        "the same tree with the time that its build took. ";
  if (paper) {
    text += "The paper measured on a GTX TITAN Black at 1024×768. ";
    text += "<i>÷ paper</i>: ours over the paper's value. ";
  }
  if (relative && paper)
    text +=
        "Where device or image size are not the paper's, its times and ours are not comparable; shown instead: <i>÷ "
        "lbvh</i>, each method over <code>lbvh</code> here and, in brackets, in the paper. ";
  if (relative && !paper) text += "<i>÷ lbvh</i>: each method over <code>lbvh</code> on the same scene. ";
  if (fewer) text += "<sup>*</sup> Mean of fewer views than the scene has: some runs failed or were not done. ";
  return text;
}

/// Facts of each kind but `total`, whose values depend on the samples per pixel.
struct Facts {
  Value Row::*value;
  double PaperRow::*paper;
  const char *title, *unit, *column;
};
constexpr Facts facts[] = {
    {&Row::cost, &PaperRow::cost, "SAH cost", "", "sah_cost"},
    {&Row::rate, &PaperRow::rate, "trace speed", "MRays/s", "trace_mrays_s"},
    {&Row::build, &PaperRow::build, "build time", "ms", "build_ms"},
};
static_assert(Metric::cost == 0 && Metric::rate == 1 && Metric::build == 2);

}  // namespace

Value Metric::of(const Row& row) const {
  if (kind != total) return row.*facts[kind].value;
  const Value* found = row.totalAt(spp);
  return found ? *found : Value{};
}

double Metric::ofPaper(const PaperRow& row) const {
  if (kind != total) return row.*facts[kind].paper;
  return spp == 8 ? row.total8 : spp == 128 ? row.total128 : missing;
}

std::string Metric::title() const {
  return kind != total ? facts[kind].title : fmt::format("time to image, {} spp", spp);
}

std::string Metric::unit() const { return kind != total ? facts[kind].unit : "ms"; }

std::string Metric::column() const { return kind != total ? facts[kind].column : fmt::format("total_{}spp_ms", spp); }

std::vector<Metric> metrics(const Results& results) {
  std::vector<Metric> all{{Metric::cost}, {Metric::rate}, {Metric::build}};
  for (const int spp : results.spp) all.push_back({Metric::total, spp});
  const auto unused = [&](const Metric& metric) {
    for (const Scene& scene : results.scenes)
      for (const Row& row : scene.rows)
        if (metric.of(row).known()) return false;
    return true;
  };
  all.erase(std::remove_if(all.begin(), all.end(), unused), all.end());
  return all;
}

std::string bestOf(const Scene& scene, const Metric& metric) {
  double best = missing;
  for (const Row& row : scene.rows) {
    const double value = metric.of(row).value;
    if (row.ideal || !known(value)) continue;
    if (!known(best) || (metric.higherIsBetter() ? value > best : value < best)) best = value;
  }
  return known(best) ? shown(best) : "";
}

std::string tableHtml(const Results& results) {
  const std::vector<Metric> columns = metrics(results);
  const bool paper = std::any_of(results.scenes.begin(), results.scenes.end(), isPapersMesh);
  std::string head = "<tr><th scope=\"col\" rowspan=\"2\" class=\"text\">method</th>", units = "<tr>";
  for (const Metric& metric : columns) {
    head += fmt::format("<th scope=\"colgroup\" colspan=\"2\">{}</th>", metric.title());
    units += fmt::format("<th scope=\"col\">{}</th><th scope=\"col\" class=\"beside\">{}</th>", metric.unit(),
                         besideTitle(besideOf(results, metric), paper));
  }
  std::string out = fmt::format(
      "<p class=\"legend\">{}</p>\n<div class=\"scroll\" tabindex=\"0\"><table class=\"results\">\n"
      "<caption><span>Table 1. Cost of the tree, trace speed, build time and time to image of every "
      "method.</span></caption>\n"
      "<thead>{}</tr>\n{}</tr></thead>\n",
      legend(results, columns, paper), head, units);
  for (const Scene& scene : results.scenes) {
    if (scene.rows.empty()) continue;
    out += "<tbody>\n" + sceneHead(scene, 1 + 2 * columns.size());
    for (const Row& row : scene.rows) {
      out += fmt::format("<tr{}><th scope=\"row\">{}</th>", row.ideal ? " class=\"ideal\"" : "", escape(row.label));
      for (const Metric& metric : columns) out += cells(scene, row, metric, besideOf(results, metric));
      out += "</tr>\n";
    }
    out += "</tbody>\n";
  }
  return out + "</table></div>\n";
}

std::string tableCsv(const Results& results) {
  const std::vector<Metric> columns = metrics(results);
  std::vector<std::string> head{"scene", "triangles", "method", "builder", "views", "runs"};
  for (const Metric& metric : columns)
    for (const char* suffix : {"", "_low", "_high", "_paper", "_over_paper", "_over_lbvh", "_paper_over_lbvh"})
      head.push_back(metric.column() + suffix);
  head.insert(head.end(), {"tree_bytes_per_triangle", "build_peak_bytes_per_triangle"});
  std::string out = csvLine(head);
  for (const Scene& scene : results.scenes)
    for (const Row& row : scene.rows) {
      std::vector<std::string> line{scene.name,  csvNumber(scene.triangles),         row.label,
                                    row.builder, std::to_string(scene.views.size()), std::to_string(row.runs)};
      for (const Metric& metric : columns) {
        const Value value = metric.of(row);
        const double theirs = paperValue(scene, row, metric);
        for (const double number : {value.value, value.low, value.high, theirs, value.value / theirs,
                                    overBaseline(scene, row, metric), paperOverBaseline(scene, row, metric)})
          line.push_back(csvNumber(number));
      }
      for (const double bytes : {row.treeBytes, row.buildPeakBytes}) line.push_back(csvNumber(bytes / scene.triangles));
      out += csvLine(line);
    }
  return out;
}

std::string winnersHtml(const Results& results) {
  PlainTable table;
  table.caption = "In how many scenes each method is best; equal printed values share a scene.";
  table.headers = {"", "best (scenes)"};
  table.texts = 2;
  for (const Metric& metric : metrics(results)) {
    std::vector<std::pair<std::string, int>> wins;
    for (const Scene& scene : results.scenes)
      for (const Row& row : scene.rows) {
        const Value value = metric.of(row);
        if (row.ideal || !value.known() || printed(value) != bestOf(scene, metric)) continue;
        const auto found =
            std::find_if(wins.begin(), wins.end(), [&](const auto& win) { return win.first == row.label; });
        if (found == wins.end())
          wins.emplace_back(row.label, 1);
        else
          ++found->second;
      }
    std::stable_sort(wins.begin(), wins.end(), [](const auto& a, const auto& b) { return a.second > b.second; });
    std::string text;
    for (const auto& [label, count] : wins)
      text += fmt::format("{}{} ({})", text.empty() ? "" : ", ", escape(label), count);
    if (!text.empty()) table.rows.push_back({metric.title(), text});
  }
  return table.rows.empty() ? "" : table.html();
}

}  // namespace copse::report
