// Curves with their names at their right ends: k-means iterations, and build time as scenes grow.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "tracer/report/figures.h"
#include "tracer/report/html.h"
#include "tracer/report/plot.h"

namespace copse::report {

namespace {

struct Curve {
  std::string name;
  unsigned color;
  std::map<double, Value> points;  ///< By x.
};

struct Axes {
  std::string x, y, xColumn, yColumn;
  bool logX = false, logY = false;
};

/// Moves names apart that would cover each other; heights in units, kept in order.
void spread(std::vector<Label>& labels, double distance, double highest) {
  std::sort(labels.begin(), labels.end(), [](const Label& a, const Label& b) { return a.up < b.up; });
  for (std::size_t i = 1; i < labels.size(); ++i) labels[i].up = std::max(labels[i].up, labels[i - 1].up + distance);
  if (labels.empty() || labels.back().up <= highest) return;
  labels.back().up = highest;
  for (std::size_t i = labels.size() - 1; i-- > 0;) labels[i].up = std::min(labels[i].up, labels[i + 1].up - distance);
}

Panel curvePanel(const std::string& name, const std::string& title, const std::string& alt, const Axes& axes,
                 const std::vector<Curve>& curves) {
  constexpr int width = 480, right = 104, top = 34, bottom = 50;
  const int height = std::max(360, static_cast<int>(15 * curves.size()) + 110);
  double xLow = 1e300, xHigh = -1e300, yLow = 1e300, yHigh = -1e300;
  std::string csv = csvLine({"series", axes.xColumn, axes.yColumn, axes.yColumn + "_low", axes.yColumn + "_high"});
  for (const Curve& curve : curves)
    for (const auto& [x, y] : curve.points) {
      xLow = std::min(xLow, x);
      xHigh = std::max(xHigh, x);
      yLow = std::min(yLow, y.value);
      yHigh = std::max(yHigh, y.value);
      csv += csvLine({curve.name, csvNumber(x), csvNumber(y.value), csvNumber(y.low), csvNumber(y.high)});
    }
  // Room for the numbers of the axis, of which the largest is the longest.
  const int left = 66 + 8 * std::max(0, static_cast<int>(shown(yHigh).size()) - 3);
  if (axes.logX) {
    xLow *= 0.9;
    xHigh *= 1.05;
  }
  if (axes.logY) {
    yLow *= 0.85;
    yHigh *= 1.15;
  } else {
    const double room = 0.06 * (yHigh - yLow) + 0.005 * yHigh;
    // From zero where little is lost by it, so that a length is a quantity.
    yLow = yLow < 0.45 * yHigh ? 0 : yLow - room;
    yHigh += room;
  }
  const auto share = [](double value, double low, double high, bool logarithmic) {
    return logarithmic ? std::log(value / low) / std::log(high / low) : (value - low) / (high - low);
  };
  Script script(name, width, height, title);
  script.margins(left, right, top, bottom);
  script.axis('x', xLow, xHigh, axes.logX, axes.x);
  script.axis('y', yLow, yHigh, axes.logY, axes.y);
  if (axes.logX) script.logTics('x', xLow, xHigh, true);
  if (axes.logY) script.logTics('y', yLow, yHigh);
  std::vector<Label> labels;
  std::string plot;
  for (std::size_t i = 0; i < curves.size(); ++i) {
    const Curve& curve = curves[i];
    std::vector<std::vector<std::string>> rows;
    for (const auto& [x, y] : curve.points) rows.push_back({number(x), number(y.value), number(y.low), number(y.high)});
    const std::string block = fmt::format("curve{}", i + 1);
    script.data(block, rows);
    plot +=
        fmt::format("{}${} using 1:2 with linespoints linecolor rgb '#{:06x}' linewidth 1.8 pointtype 7 pointsize 0.5",
                    plot.empty() ? "plot " : ", \\\n  ", block, curve.color);
    const auto last = std::prev(curve.points.end());
    Label label{0, 0, curve.name, darker(curve.color)};
    label.left = left + (width - left - right) * share(last->first, xLow, xHigh, axes.logX) + 8;
    label.up = bottom + (height - top - bottom) * share(last->second.value, yLow, yHigh, axes.logY);
    labels.push_back(label);
  }
  spread(labels, 14, height - top);
  draw(script, labels, width, height, 12);
  script.line(plot);
  return std::move(script).panel(alt, csv);
}

/// The paper's name of a pair of k and p.
std::string seriesName(double k, double p) {
  static const double named[][2] = {{8, 5}, {16, 5}, {32, 20}, {64, 30}};
  for (int r = 0; r < 4; ++r)
    if (k == named[r][0] && p == named[r][1]) return fmt::format("R{} (k={:g})", r + 1, k);
  return fmt::format("k={:g} p={:g}", k, p);
}

}  // namespace

std::optional<Figure> iterationsFigure(const Results& results) {
  if (!results.asksFor("iterations")) return std::nullopt;
  Figure figure{"How many iterations of k-means", "", {}};
  for (const Scene& scene : results.scenes) {
    std::map<std::pair<double, double>, std::map<double, const Row*>> series;
    for (const Row& row : scene.rows) {
      const double k = row.parameter("kmeans.k"), p = row.parameter("kmeans.p"), i = row.parameter("kmeans.i");
      if (readsParameter(row.builder, "kmeans.i") && known(k) && known(p) && known(i)) series[{k, p}].emplace(i, &row);
    }
    // Where the paper's four are among many combinations they alone are drawn.
    const auto papers = [](const auto& one) { return seriesName(one.first.first, one.first.second)[0] == 'R'; };
    if (std::any_of(series.begin(), series.end(), papers))
      std::erase_if(series, [&](const auto& one) { return !papers(one); });
    const auto panel = [&](const char* what, const Axes& axes, Value Row::*member) {
      std::vector<Curve> curves;
      static const unsigned colors[] = {0x56b4e9, 0x0072b2, 0xe69f00, 0xd55e00};
      for (const auto& [kp, rows] : series) {
        if (rows.size() < 4) continue;
        Curve curve{seriesName(kp.first, kp.second), colors[curves.size() % 4], {}};
        for (const auto& [i, row] : rows)
          if ((row->*member).known()) curve.points[i] = row->*member;
        if (curve.points.size() >= 4 && curves.size() < 12) curves.push_back(curve);
      }
      if (!curves.empty())
        figure.panels.push_back(curvePanel(fmt::format("iterations-{}-{}", what, slug(scene.name)), scene.name,
                                           fmt::format("{} against k-means iterations, {}", axes.y, scene.name), axes,
                                           curves));
    };
    panel("build", {"iterations i", "build time [ms]", "iterations", "build_ms"}, &Row::build);
    panel("cost", {"iterations i", "SAH cost", "iterations", "sah_cost"}, &Row::cost);
  }
  figure.caption =
      "Compare figure 5 of the paper, on Power Plant: R1 (k = 8, p = 5), R2 (16, 5), R3 (32, 20), R4 (64, 30). In the "
      "paper the first two iterations bring most of the gain in cost, and the build time grows in proportion to i.";
  return figure;
}

std::optional<Figure> scalingFigure(const Results& results) {
  if (!results.asksFor("scaling")) return std::nullopt;
  std::vector<Curve> times, rates;
  std::map<double, bool> sizes;
  for (const Scene& scene : results.scenes)
    for (std::size_t r = 0; r < scene.rows.size(); ++r) {
      const Row& row = scene.rows[r];
      if (row.ideal || !row.build.known() || !known(scene.triangles) || scene.triangles <= 0) continue;
      const auto found = std::find_if(times.begin(), times.end(), [&](const Curve& c) { return c.name == row.label; });
      const std::size_t index = static_cast<std::size_t>(found - times.begin());
      if (found == times.end()) {
        times.push_back({row.label, builderColor(row.builder), {}});
        rates.push_back(times.back());
      }
      sizes[scene.triangles] = true;
      times[index].points[scene.triangles] = row.build;
      Value rate = row.build;
      for (double* value : {&rate.value, &rate.low, &rate.high}) *value *= 1e6 / scene.triangles;
      rates[index].points[scene.triangles] = rate;
    }
  const bool asked = !results.loaded.experiment.report.empty();
  if (sizes.size() < (asked ? 2u : 3u) || times.size() > 24) return std::nullopt;
  Figure figure{"Build time as scenes grow", "", {}};
  figure.panels.push_back(curvePanel("scaling-time", "build time", "Build time against triangles",
                                     {"triangles", "build time [ms]", "triangles", "build_ms", true, true}, times));
  figure.panels.push_back(curvePanel(
      "scaling-rate", "build time per million triangles", "Build time per million triangles against triangles",
      {"triangles", "ms per million triangles", "triangles", "ms_per_million", true, true}, rates));
  figure.caption =
      "Left: build time against triangles, both axes logarithmic; a builder of linear cost rises by one decade per "
      "decade. Right: the same divided by the number of triangles; linear builders are level, rising ones sort, sweep "
      "or leave the caches.";
  return figure;
}

}  // namespace copse::report
