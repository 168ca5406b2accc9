// Bars grouped by scene: over the ideal sah, and trace speed by kind of ray.
#include <fmt/format.h>

#include <algorithm>
#include <functional>

#include "tracer/report/bars.h"
#include "tracer/report/figures.h"
#include "tracer/report/html.h"
#include "tracer/report/plot.h"
#include "tracer/report/table.h"

namespace copse::report {

Panel barPanel(const std::string& name, const std::string& title, const std::string& axis, const std::string& alt,
               const std::vector<BarGroup>& groups, bool reference, const std::vector<std::string>& columns) {
  double longest = reference ? 1.1 : 0;
  std::vector<std::vector<std::string>> bars, heads;
  std::string csv = csvLine(columns);
  double y = 0;
  for (const BarGroup& group : groups)
    for (const Bar& bar : group.bars) longest = std::max(longest, bar.value);
  const double end = reference ? std::min(longest, 3.0) : longest;
  for (const BarGroup& group : groups) {
    heads.push_back({number(y += 0.3), field(group.title)});
    for (const Bar& bar : group.bars) {
      y += 1;
      const bool cut = bar.value > end;
      const std::string text = (reference ? shownRatio(bar.value) : shown(bar.value)) + (cut ? " →" : "");
      bars.push_back(
          {number(y), number(std::min(bar.value, end)), std::to_string(bar.color), field(bar.label), field(text)});
      csv += csvLine({bar.group, bar.label, csvNumber(bar.value), csvNumber(bar.low), csvNumber(bar.high)});
    }
    y += 1.5;
  }
  const int height = static_cast<int>(62 + 17 * (y + 0.2));
  Script script(name, 480, height, title);
  script.margins(112, 46, 34, 44);
  script.axis('x', 0, end * 1.001, false, axis);
  script.axis('y', y - 0.4, -0.5, false, "");
  script.line("unset ytics\nset border 1\nset grid noytics");
  if (reference)
    script.line(
        "set arrow 1 from 1, graph 0 to 1, graph 1 nohead back linecolor rgb '#59636e' linewidth 1 dashtype (4,3)");
  script.data("bars", bars);
  script.data("heads", heads);
  script.line(
      "plot $bars using (0.5*$2):1:(0):2:($1-0.4):($1+0.4):3 with boxxyerror fillstyle solid noborder linecolor rgb "
      "variable, \\\n"
      "  $bars using (0):1:4 with labels right offset -0.5,0 font 'sans-serif,12' textcolor rgb '#1b1f24', \\\n"
      "  $bars using 2:1:5 with labels left offset 0.3,0 font 'sans-serif,11' textcolor rgb '#3c444d', \\\n"
      "  $heads using (0):1:2 with labels left offset 0,0 font 'sans-serif,14' textcolor rgb '#1b1f24'");
  return std::move(script).panel(alt, csv);
}

namespace {

constexpr std::size_t scenesPerPanel = 3, maxBars = 24;

/// A panel for every three scenes of whatever has bars.
void addPanels(Figure& figure, const std::string& name, const std::string& title, const std::string& axis,
               const std::string& alt, const std::vector<BarGroup>& groups, bool reference, const std::string& column) {
  for (std::size_t start = 0; start < groups.size(); start += scenesPerPanel) {
    const auto first = groups.begin() + static_cast<std::ptrdiff_t>(start);
    const std::vector<BarGroup> some(
        first, first + static_cast<std::ptrdiff_t>(std::min(scenesPerPanel, groups.size() - start)));
    std::string scenes;
    for (const BarGroup& group : some) scenes += (scenes.empty() ? "" : ", ") + group.title;
    const std::string number = groups.size() > scenesPerPanel ? fmt::format("-{}", start / scenesPerPanel + 1) : "";
    figure.panels.push_back(barPanel(name + number, title, axis, fmt::format("{} for {}", alt, scenes), some, reference,
                                     {"scene", "method", column, column + "_low", column + "_high"}));
  }
}

std::vector<BarGroup> groupsOf(const Results& results, const std::function<Bar(const Scene&, const Row&)>& barOf) {
  std::vector<BarGroup> groups;
  for (const Scene& scene : results.scenes) {
    BarGroup group{scene.name, {}};
    for (std::size_t i = 0; i < scene.rows.size(); ++i) {
      Bar bar = barOf(scene, scene.rows[i]);
      if (!known(bar.value)) continue;
      bar.group = scene.name;
      bar.label = scene.rows[i].label;
      bar.color = builderColor(scene.rows[i].builder);
      group.bars.push_back(bar);
    }
    // More than that are a sweep of parameters, which has figures of its own.
    if (!group.bars.empty() && group.bars.size() <= maxBars) groups.push_back(std::move(group));
  }
  return groups;
}

}  // namespace

std::optional<Figure> relativeFigure(const Results& results) {
  if (!results.asksFor("total")) return std::nullopt;
  Figure figure{"Cost and time to image relative to the ideal sah", "", {}};
  for (const Metric& metric : metrics(results)) {
    if (metric.kind == Metric::build) continue;
    const std::vector<BarGroup> groups = groupsOf(results, [&](const Scene& scene, const Row& row) {
      Bar bar;
      const Row* ideal = scene.ideal();
      // The sah row's own cost and speed are those of the ideal one.
      if (!ideal || row.ideal || (row.builder == idealBuilder && metric.kind != Metric::total)) return bar;
      const Value value = metric.of(row);
      const double one = metric.of(*ideal).value;
      bar.value = value.value / one;
      bar.low = value.low / one;
      bar.high = value.high / one;
      return bar;
    });
    const std::string name = metric.kind == Metric::total  ? fmt::format("relative-total-{}", metric.spp)
                             : metric.kind == Metric::cost ? "relative-cost"
                                                           : "relative-speed";
    addPanels(figure, name, metric.title(),
              metric.higherIsBetter() ? "over ideal sah, longer is better" : "over ideal sah, shorter is better",
              metric.title() + " of each method over the ideal sah", groups, true, name + "_over_ideal_sah");
  }
  if (figure.panels.empty()) return std::nullopt;
  figure.caption =
      "Compare figure 4 of the paper. The dashed line is a full-sweep SAH tree whose build counts as 0; a method left "
      "of it in time to image has paid for its own build and still wins. Bars longer than three times the ideal are "
      "cut off; the number at the end is exact. Means over the views.";
  return figure;
}

std::optional<Figure> raysFigure(const Results& results) {
  if (!results.asksFor("table") && !results.asksFor("rays")) return std::nullopt;
  Figure figure{"Trace speed by kind of ray", "", {}};
  for (std::size_t kind = 0; kind < rayKinds.size(); ++kind) {
    const std::vector<BarGroup> groups = groupsOf(results, [&](const Scene&, const Row& row) {
      Bar bar;
      if (row.ideal) return bar;
      bar.value = row.rates[kind].value;
      bar.low = row.rates[kind].low;
      bar.high = row.rates[kind].high;
      return bar;
    });
    addPanels(figure, fmt::format("rays-{}", rayKinds[kind]), fmt::format("{} rays", rayKinds[kind]), "MRays/s",
              fmt::format("Trace speed of {} rays", rayKinds[kind]), groups, false, "mrays_per_s");
  }
  figure.caption =
      "Millions of rays per second by kind, from the runs with the highest samples per pixel. Primary rays leave the "
      "camera side by side, bounce rays go anywhere, shadow rays end at the first hit: a tree may be good for one "
      "kind and not for another.";
  return figure;
}

}  // namespace copse::report
