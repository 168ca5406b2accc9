// Where the time of a build and of a render goes: stacked bars, one row per method. Steps that do the same work in
// different builders have one colour.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>

#include "builder/methods/kmeans/build.h"
#include "builder/phases.h"
#include "tracer/accel/phases.h"
#include "tracer/integrators/registry.h"
#include "tracer/report/figures.h"
#include "tracer/report/html.h"
#include "tracer/report/plot.h"

namespace copse::report {

namespace {

/// Which group of a phase is drawn: its own, or the coarsest that it is a part of.
enum class Detail { fine, coarse };

using DeclaredPhases = std::vector<PhaseName>;

/// The phases that this version has, in the order in which their groups are stacked. Records may be of other versions:
/// what is not here is drawn as "other".
const DeclaredPhases& phasesOfBuildsAndTracers() {
  static const DeclaredPhases declared = [] {
    DeclaredPhases all = phasesOfBuilds();
    all.insert(all.end(), std::begin(phases::ofTracers), std::end(phases::ofTracers));
    return all;
  }();
  return declared;
}

const DeclaredPhases& phasesOfRenders() {
  static const DeclaredPhases declared = [] {
    DeclaredPhases all;
    for (const IntegratorEntry* integrator : integrators())
      all.insert(all.end(), integrator->phases.begin(), integrator->phases.end());
    return all;
  }();
  return declared;
}

constexpr const char* rest = "not in a phase";
constexpr const char* other = "other";

/// What is drawn of a row: the phases of its build, or of its longest renders.
struct Kind {
  Numbers Row::*phases;
  double (*whole)(const Row&);
  const char* axis;
  const DeclaredPhases& (*declared)();
  Detail detail;

  const char* groupOf(const PhaseName& phase) const {
    const PhaseGroup* group = phase.group;
    while (detail == Detail::coarse && group && group->within) group = group->within;
    return group ? group->name : other;
  }
  const char* groupOf(const std::string& phase) const {
    for (const PhaseName& known : declared())
      if (phase == known.text) return groupOf(known);
    return other;
  }
};

double buildOf(const Row& row) { return row.build.value; }
double renderOf(const Row& row) { return row.render.empty() ? missing : row.render.rbegin()->second.value; }

constexpr Kind kmeansKind{&Row::buildPhases, buildOf, "build time [ms]", phasesOfBuildsAndTracers, Detail::fine};
constexpr Kind builderKind{&Row::buildPhases, buildOf, "build time [ms]", phasesOfBuildsAndTracers, Detail::coarse};
constexpr Kind renderKind{&Row::renderPhases, renderOf, "render time [ms]", phasesOfRenders, Detail::coarse};

constexpr std::size_t maxGroups = 10;

/// Phases of a row by group; what it took beyond them is a group of its own where one would see it.
Numbers grouped(const Row& row, const Kind& kind) {
  Numbers groups;
  double sum = 0;
  const auto add = [&](const std::string& name, double ms) {
    const auto found =
        std::find_if(groups.begin(), groups.end(), [&](const auto& group) { return group.first == name; });
    if (found == groups.end())
      groups.emplace_back(name, ms);
    else
      found->second += ms;
  };
  for (const auto& [phase, ms] : row.*kind.phases) {
    if (!known(ms)) continue;
    add(kind.groupOf(phase), ms);
    sum += ms;
  }
  const double whole = kind.whole(row);
  if (whole - sum > 0.01 * whole) add(rest, whole - sum);
  return groups;
}

/// The smallest 1, 2 or 5 times a power of ten of which `steps` reach `max`.
double evenStep(double max, int steps) {
  if (!(max > 0)) return 1;
  const double power = std::pow(10, std::floor(std::log10(max / steps)));
  for (const double part : {1.0, 2.0, 5.0})
    if (part * power * steps >= max) return part * power;
  return 10 * power;
}

Panel stackedPanel(const std::string& name, const std::string& title, const std::string& alt,
                   const std::vector<const Row*>& rows, const Kind& kind) {
  // The order of the phases above, then of appearance.
  std::vector<std::string> order;
  const auto addOnce = [&](const std::string& group) {
    if (std::find(order.begin(), order.end(), group) == order.end()) order.push_back(group);
  };
  std::vector<Numbers> stacks;
  for (const Row* row : rows) stacks.push_back(grouped(*row, kind));
  for (const PhaseName& phase : kind.declared())
    for (const Numbers& stack : stacks)
      for (const auto& group : stack)
        if (group.first == kind.groupOf(phase)) addOnce(group.first);
  for (const Numbers& stack : stacks)
    for (const auto& group : stack)
      if (group.first != rest) addOnce(group.first);
  for (const Numbers& stack : stacks)
    for (const auto& group : stack) addOnce(group.first);

  if (order.size() > maxGroups) {  // No more than there are colours.
    const std::vector<std::string> kept(order.begin(), order.begin() + maxGroups - 1);
    for (Numbers& stack : stacks)
      for (auto& [group, ms] : stack)
        if (std::find(kept.begin(), kept.end(), group) == kept.end()) group = other;
    order = kept;
    addOnce(other);
  }
  std::string csv = csvLine({"method", "phase", "ms"});
  std::vector<std::vector<std::string>> bars, names;
  double longest = 0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    double at = 0;
    for (std::size_t g = 0; g < order.size(); ++g)
      for (const auto& [group, ms] : stacks[i]) {
        if (group != order[g] || ms <= 0) continue;
        const unsigned color = group == rest ? 0xdfe3e7 : seriesColor(g);
        bars.push_back({number(double(i)), number(at), number(at + ms), std::to_string(color)});
        at += ms;
      }
    for (const auto& [phase, ms] : rows[i]->*kind.phases) csv += csvLine({rows[i]->label, phase, csvNumber(ms)});
    names.push_back({number(double(i)), field(rows[i]->label), number(at), field(shown(kind.whole(*rows[i])))});
    longest = std::max(longest, at);
  }
  const int keyRows = static_cast<int>(order.size() + 2) / 3;
  const int bottom = 48 + 20 * keyRows, height = 34 + 24 * static_cast<int>(rows.size()) + bottom;
  Script script(name, 480, height, title);
  script.margins(112, 46, 34, bottom);
  script.axis('x', 0, longest * 1.001, false, kind.axis);
  script.line(fmt::format("set xtics {:g}", evenStep(longest, longest >= 1000 ? 5 : 8)));
  script.axis('y', static_cast<double>(rows.size()) - 0.4, -0.6, false, "");
  script.line("unset ytics\nset border 1\nset grid noytics");
  for (std::size_t g = 0; g < order.size(); ++g) {
    const double x = 22 + 152 * double(g % 3), y = 20.0 * (keyRows - 1 - static_cast<int>(g / 3)) + 14;
    script.line(fmt::format(
        "set object {} rectangle from screen {:.5f},{:.5f} to screen {:.5f},{:.5f} fillstyle solid noborder "
        "fillcolor rgb '#{:06x}'",
        g + 1, x / 480, (y - 5) / height, (x + 10) / 480, (y + 5) / height,
        order[g] == rest ? 0xdfe3e7 : seriesColor(g)));
    script.line(fmt::format("set label {} at screen {:.5f},{:.5f} left font 'sans-serif,12' textcolor rgb '#1b1f24'",
                            gnuplotString(order[g]), (x + 15) / 480, y / height));
  }
  script.data("bars", bars);
  script.data("names", names);
  script.line(
      "plot $bars using (0.5*($2+$3)):1:2:3:($1-0.38):($1+0.38):4 with boxxyerror fillstyle solid noborder linecolor "
      "rgb variable, \\\n"
      "  $names using (0):1:2 with labels right offset -0.5,0 font 'sans-serif,12' textcolor rgb '#1b1f24', \\\n"
      "  $names using 3:1:4 with labels left offset 0.3,0 font 'sans-serif,11' textcolor rgb '#3c444d'");
  return std::move(script).panel(alt, csv);
}

/// The k-means loop's share of builds, in words.
std::string loopShare(const std::vector<const Row*>& rows) {
  double low = 1e300, high = 0;
  for (const Row* row : rows)
    for (const auto& [group, ms] : grouped(*row, kmeansKind))
      if (group == kmeans::groups::loop.name && row->build.value > 0) {
        low = std::min(low, ms / row->build.value);
        high = std::max(high, ms / row->build.value);
      }
  if (high <= 0) return "";
  const std::string lowest = fmt::format("{:.0f}", 100 * low), highest = fmt::format("{:.0f}", 100 * high);
  return fmt::format("Here it takes {} % where there are iterations. ",
                     lowest == highest ? highest : "from " + lowest + " to " + highest);
}

}  // namespace

std::optional<Figure> phasesFigure(const Results& results) {
  if (!results.asksFor("phases")) return std::nullopt;
  const Scene* largest = nullptr;
  for (const Scene& scene : results.scenes) {
    const bool any =
        std::any_of(scene.rows.begin(), scene.rows.end(), [](const Row& row) { return row.buildPhases.size() > 1; });
    if (any && (!largest || scene.triangles > largest->triangles)) largest = &scene;
  }
  if (!largest) return std::nullopt;
  std::vector<const Row*> kmeans, all;
  for (const Row& row : largest->rows) {
    if (row.buildPhases.empty() || row.ideal) continue;
    const bool preset = row.label == row.builder;
    if (readsParameter(row.builder, "kmeans.k")) kmeans.push_back(&row);
    if (preset) all.push_back(&row);
  }
  if (kmeans.size() > 24)
    kmeans.erase(
        std::remove_if(kmeans.begin(), kmeans.end(), [](const Row* row) { return row->label != row->builder; }),
        kmeans.end());
  Figure figure{"Where the time goes", "", {}};
  const std::string on = ", " + largest->name;
  if (!kmeans.empty())
    figure.panels.push_back(
        stackedPanel("phases-kmeans", "k-means" + on, "Phases of k-means builds" + on, kmeans, kmeansKind));
  if (all.size() > kmeans.size())
    figure.panels.push_back(
        stackedPanel("phases-builders", "all builders" + on, "Phases of all builders" + on, all, builderKind));
  std::vector<const Row*> rendered;
  for (const Row* row : all)
    if (!row->renderPhases.empty() && known(renderOf(*row))) rendered.push_back(row);
  const std::string spp = rendered.empty() ? "" : fmt::format(", {} spp", rendered.front()->render.rbegin()->first);
  if (!rendered.empty())
    figure.panels.push_back(
        stackedPanel("phases-render", "rendering" + on + spp, "Phases of renders" + on, rendered, renderKind));
  if (figure.panels.empty()) return std::nullopt;
  figure.caption = fmt::format(
      "{}on the largest scene here, medians of each phase. {}{}{}The figure's CSV has every phase by its own name.",
      kmeans.empty() ? "Build time by phase " : "Compare figure 6 of the paper, on Power Plant: build time by phase ",
      kmeans.empty() ? ""
                     : "In the paper the k-means loop, in which triangles are assigned and representatives computed, "
                       "takes more than half of every build. ",
      loopShare(kmeans), rendered.empty() ? "" : "Renders with the highest samples per pixel; means over the views. ");
  return figure;
}

}  // namespace copse::report
