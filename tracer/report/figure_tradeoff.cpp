// Two qualities against each other: points, their names, and the front of those that no other beats on both.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tracer/report/figures.h"
#include "tracer/report/html.h"
#include "tracer/report/paper.h"
#include "tracer/report/plot.h"

namespace copse::report {

namespace {

struct Mark {
  double x, y;
  std::string label;
  unsigned color;
  bool named = true, onFront = false;
};

/// Marks on the front: minimum x, and maximum y or, with `lower`, minimum y.
void findFront(std::vector<Mark>& marks, bool lower) {
  for (Mark& mark : marks)
    mark.onFront = std::none_of(marks.begin(), marks.end(), [&](const Mark& other) {
      const bool noWorse = other.x <= mark.x && (lower ? other.y <= mark.y : other.y >= mark.y);
      return noWorse && (other.x < mark.x || other.y != mark.y);
    });
}

struct Axes {
  std::string x, y, xColumn, yColumn;
  bool lowerIsBetter;  ///< For y; for x it always is.
};

Panel tradeoffPanel(const std::string& name, const std::string& title, const std::string& alt, const Axes& axes,
                    std::vector<Mark> marks, const std::vector<std::pair<std::string, unsigned>>& legend) {
  findFront(marks, axes.lowerIsBetter);
  constexpr int width = 480, height = 380, left = 62, right = 16, top = 34, bottom = 50;
  double xLow = 1e300, xHigh = 0, yLow = 1e300, yHigh = 0;
  for (const Mark& mark : marks) {
    xLow = std::min(xLow, mark.x);
    xHigh = std::max(xHigh, mark.x);
    yLow = std::min(yLow, mark.y);
    yHigh = std::max(yHigh, mark.y);
  }
  // Room for the names, in the measure of each axis.
  const double widen = std::max(std::pow(xHigh / xLow, 0.12), 1.08);
  xLow /= widen;
  xHigh *= widen;
  const double room = std::max(0.12 * (yHigh - yLow), 0.01 * yHigh);
  yLow = std::max(yLow - room, 0.0);
  yHigh += room;

  Script script(name, width, height, title);
  script.margins(left, right, top, bottom);
  script.axis('x', xLow, xHigh, true, axes.x);
  script.logTics('x', xLow, xHigh);
  script.axis('y', yLow, yHigh, false, axes.y);
  std::vector<std::vector<std::string>> points, front;
  std::string csv = csvLine({"name", axes.xColumn, axes.yColumn, "on_front"});
  std::vector<Label> labels;
  std::sort(marks.begin(), marks.end(), [](const Mark& a, const Mark& b) { return a.x < b.x; });
  for (const Mark& mark : marks) {
    points.push_back({number(mark.x), number(mark.y), std::to_string(mark.color), field(mark.label)});
    if (mark.onFront) front.push_back({number(mark.x), number(mark.y)});
    csv += csvLine({mark.label, csvNumber(mark.x), csvNumber(mark.y), mark.onFront ? "1" : "0"});
    const double px = left + (width - left - right) * std::log(mark.x / xLow) / std::log(xHigh / xLow);
    const double py = bottom + (height - top - bottom) * (mark.y - yLow) / (yHigh - yLow);
    labels.push_back({px, py, mark.named ? mark.label : "", darker(mark.color)});
  }
  // The front's steps: from each of its points level to the next, then up or down.
  std::vector<Area> steps;
  const Label* before = nullptr;
  for (std::size_t i = 0; i < marks.size(); ++i) {
    if (!marks[i].onFront) continue;
    const Label& to = labels[i];
    if (before) {
      steps.push_back({before->x, to.x, before->y - 1, before->y + 1});
      steps.push_back({to.x - 1, to.x + 1, std::min(before->y, to.y), std::max(before->y, to.y)});
    }
    before = &to;
  }
  place(labels, {left + 3, width - 4, bottom + 3, height - top}, 12, steps);
  draw(script, labels, width, height, 12);
  for (std::size_t i = 0; i < legend.size(); ++i)
    script.line(
        fmt::format("set label {} at screen {:.4f},{:.4f} right front font 'sans-serif,13' textcolor rgb '#{:06x}'",
                    gnuplotString(legend[i].first), double(width - right - 8) / width,
                    double(height - top - 16 - 18 * double(i)) / height, legend[i].second));
  script.data("points", points);
  script.data("front", front);
  script.line(
      fmt::format("plot $front using 1:2 with {} linecolor rgb '#9aa3ad' linewidth 1.5 dashtype (5,3), \\\n"
                  "  $points using 1:2:3 with points pointtype 7 pointsize {} linecolor rgb variable",
                  front.size() > 1 ? "steps" : "lines", marks.size() > 30 ? 0.6 : 0.9));
  return std::move(script).panel(alt, csv);
}

}  // namespace

std::optional<Figure> scatterFigure(const Results& results) {
  if (!results.asksFor("scatter")) return std::nullopt;
  Figure figure{"Build time against trace speed", "", {}};
  for (const Scene& scene : results.scenes) {
    std::vector<Mark> marks;
    for (std::size_t i = 0; i < scene.rows.size(); ++i) {
      const Row& row = scene.rows[i];
      if (row.ideal || !row.build.known() || !row.rate.known() || row.build.value <= 0) continue;
      marks.push_back({row.build.value, row.rate.value, row.label, builderColor(row.builder)});
    }
    if (marks.size() < 2 || marks.size() > 30) continue;
    figure.panels.push_back(tradeoffPanel(
        "tradeoff-" + slug(scene.name), scene.name, "Build time against trace speed of each method, " + scene.name,
        {"build time [ms]", "trace speed [MRays/s]", "build_ms", "mrays_per_s", false}, marks, {}));
  }
  figure.caption =
      "Up and to the left is better. The dashed line joins the methods that no other beats on both (the Pareto "
      "front): for every build time, the fastest available tree. Means over the views.";
  return figure;
}

std::optional<Figure> parametersFigure(const Results& results) {
  if (!results.asksFor("parameters")) return std::nullopt;
  Figure figure{"Parameters of k-means: build time against cost", "", {}};
  std::size_t combinations = 0;
  for (const Scene& scene : results.scenes) {
    std::vector<Mark> marks;
    std::vector<std::pair<std::string, unsigned>> legend;
    for (const Row& row : scene.rows) {
      const double k = row.parameter("kmeans.k"), p = row.parameter("kmeans.p"), i = row.parameter("kmeans.i");
      if (!readsParameter(row.builder, "kmeans.k") || !known(k) || !row.build.known() || !row.cost.known()) continue;
      const int step = k <= 8 ? 0 : k <= 16 ? 1 : k <= 32 ? 2 : 3;
      static const unsigned colors[] = {0x56b4e9, 0x0072b2, 0xe69f00, 0xd55e00};
      const std::string name = fmt::format("k = {:g}", k);
      if (std::none_of(legend.begin(), legend.end(), [&](const auto& entry) { return entry.first == name; }))
        legend.emplace_back(name, colors[step]);
      static const double presets[][3] = {{8, 5, 0}, {8, 5, 2}, {16, 5, 5}, {32, 20, 10}, {64, 30, 15}};
      std::string label = fmt::format("k={:g} p={:g} i={:g}", k, p, i);
      bool named = false;
      for (int q = 0; q < 5; ++q)
        if (k == presets[q][0] && p == presets[q][1] && i == presets[q][2]) {
          label = fmt::format("Q{}", q + 1);
          named = true;
        }
      marks.push_back({row.build.value, row.cost.value, label, colors[step], named});
    }
    if (marks.size() < 8) continue;  // The presets alone are in the other figures.
    combinations = std::max(combinations, marks.size());
    figure.panels.push_back(tradeoffPanel("parameters-" + slug(scene.name), scene.name,
                                          "Build time against SAH cost of combinations of k, p and i, " + scene.name,
                                          {"build time [ms]", "SAH cost", "build_ms", "sah_cost", true}, marks,
                                          legend));
  }
  figure.caption = fmt::format(
      "{} combinations of k, p and i; the paper chose its Q1 to Q5 from 88. Down and to the left is better; the "
      "dashed line joins those that no other beats on both. Q1 to Q5 are named where they were run.",
      combinations);
  return figure;
}

std::optional<Figure> agreementFigure(const Results& results) {
  if (!results.asksFor("table")) return std::nullopt;
  Figure figure{"Each method over lbvh: here against the paper", "", {}};
  struct Part {
    const char *name, *title;
    double (*ours)(const Row&);
    double PaperRow::*theirs;
  };
  static const Part parts[] = {
      {"cost", "SAH cost", [](const Row& row) { return row.cost.value; }, &PaperRow::cost},
      {"speed", "trace speed", [](const Row& row) { return row.rate.value; }, &PaperRow::rate},
      {"build", "build time", [](const Row& row) { return row.build.value; }, &PaperRow::build},
      {"total-8", "time to image, 8 spp",
       [](const Row& row) { return row.totalAt(8) ? row.totalAt(8)->value : missing; }, &PaperRow::total8},
      {"total-128", "time to image, 128 spp",
       [](const Row& row) { return row.totalAt(128) ? row.totalAt(128)->value : missing; }, &PaperRow::total128}};
  for (const Part& part : parts) {
    std::vector<std::vector<std::string>> points;
    std::string csv = csvLine({"scene", "method", "paper_over_lbvh", "ours_over_lbvh"});
    double low = 1, high = 1;
    std::vector<std::pair<std::string, unsigned>> seen;
    for (const Scene& scene : results.scenes) {
      const PaperRow* paperBase = paperBaseline(scene);
      const Row* base = scene.baseline();
      if (!paperBase || !base) continue;
      for (const Row& row : scene.rows) {
        const PaperRow* paper = paperRow(scene, row);
        if (!paper || row.ideal || &row == base) continue;
        const double ours = part.ours(row) / part.ours(*base), theirs = paper->*part.theirs / paperBase->*part.theirs;
        if (!known(ours) || !known(theirs) || ours <= 0) continue;
        points.push_back({number(theirs), number(ours), std::to_string(builderColor(row.builder))});
        csv += csvLine({scene.name, row.label, csvNumber(theirs), csvNumber(ours)});
        low = std::min({low, ours, theirs});
        high = std::max({high, ours, theirs});
        if (std::none_of(seen.begin(), seen.end(), [&](const auto& s) { return s.first == row.label; }))
          seen.emplace_back(row.label, builderColor(row.builder));
      }
    }
    if (points.size() < 2) continue;
    low *= 0.93;
    high *= 1.07;
    constexpr int width = 480, height = 400;
    Script script(fmt::format("paper-{}", part.name), width, height, std::string(part.title) + " over lbvh");
    script.margins(62, 110, 34, 50);
    for (const char which : {'x', 'y'}) {
      script.axis(which, low, high, true, which == 'x' ? "in the paper" : "here");
      script.logTics(which, low, high);
    }
    for (std::size_t i = 0; i < seen.size(); ++i) {
      const double up = (height - 44 - 18 * double(i)) / height;
      script.line(fmt::format("set label '●' at screen {:.4f},{:.4f} left font 'sans-serif,12' textcolor rgb '#{:06x}'",
                              376.0 / width, up, seen[i].second));
      script.line(fmt::format("set label {} at screen {:.4f},{:.4f} left font 'sans-serif,12' textcolor rgb '#1b1f24'",
                              gnuplotString(seen[i].first), 390.0 / width, up));
    }
    script.data("points", points);
    script.line(
        "plot x with lines linecolor rgb '#9aa3ad' linewidth 1.5 dashtype (5,3), \\\n"
        "  $points using 1:2:3 with points pointtype 7 pointsize 0.9 linecolor rgb variable");
    figure.panels.push_back(
        std::move(script).panel(std::string(part.title) + " of each method over lbvh, here against the paper", csv));
  }
  figure.caption =
      "One point per scene and method, on the paper's own meshes. On the dashed line a method has the same ratio to "
      "lbvh as in the paper; this compares methods and not machines, so it holds across devices and image sizes. "
      "Below the line, in costs and times, a method does better here than there.";
  return figure;
}

}  // namespace copse::report
