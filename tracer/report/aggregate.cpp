// Grouping by scene, row and view. Failed runs are left out here; the page lists them.
#include "tracer/report/aggregate.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <set>

#include "builder/base/statistics.h"
#include "tracer/integrators/registry.h"
#include "tracer/report/html.h"

namespace copse::report {

namespace {

using Runs = std::vector<const Run*>;

/// Values by view of those runs for which `get` knows one.
Value gather(const Runs& runs, const std::function<double(const Run&)>& get) {
  std::map<std::string, std::vector<double>> values;
  for (const Run* run : runs)
    if (const double value = get(*run); known(value)) values[run->view].push_back(value);
  return overViews(values);
}

double medianOf(const Runs& runs, double Run::*member) {
  std::vector<double> values;
  for (const Run* run : runs) values.push_back(run->*member);
  return median(values);
}

/// Whether a builder's tree took part. Of an integrator that this version does not know it is taken to be so.
bool showsTree(const Run& run) {
  const IntegratorEntry* integrator = integratorNamed(run.integrator);
  return !integrator || integrator->tree != TreeUse::none;
}

/// A tree does not depend on view or samples, so all builds of the row are repetitions of one another.
Value buildTime(const Runs& runs) {
  std::map<std::string, std::vector<double>> values;
  for (const Run* run : runs)
    if (known(run->build)) values[""].push_back(run->build);
  return overViews(values);
}

Numbers buildPhases(const Runs& runs) {
  std::vector<std::string> order;
  std::map<std::string, std::vector<double>> values;
  for (const Run* run : runs)
    for (const auto& [name, ms] : run->buildPhases) {
      if (!values.count(name)) order.push_back(name);
      values[name].push_back(ms);
    }
  Numbers phases;
  for (const std::string& name : order) phases.emplace_back(name, median(values[name]));
  return phases;
}

/// A phase that some view lacks took no time there.
Numbers renderPhases(const Runs& runs) {
  std::vector<std::string> order;
  std::map<std::string, std::map<std::string, std::vector<double>>> values;  // By phase, view.
  std::set<std::string> views;
  for (const Run* run : runs) {
    if (!run->renderPhases.empty()) views.insert(run->view);
    for (const auto& [name, ms] : run->renderPhases) {
      if (!values.count(name)) order.push_back(name);
      values[name][run->view].push_back(ms);
    }
  }
  Numbers phases;
  for (const std::string& name : order) {
    const Value mean = overViews(values[name]);
    phases.emplace_back(name, mean.value * mean.views / static_cast<double>(views.size()));
  }
  return phases;
}

Row toRow(const Runs& runs) {
  Row row;
  const Run& first = *runs.front();
  row.label = first.label;
  row.builder = first.builder;
  row.parameters = first.parameters;
  row.runs = static_cast<int>(runs.size());
  row.build = buildTime(runs);
  row.cost = gather(runs, [](const Run& run) { return run.cost; });
  row.buildPhases = buildPhases(runs);
  int maxSpp = 0;
  for (const Run* run : runs) maxSpp = std::max(maxSpp, run->spp);
  std::map<int, Runs> bySpp;
  for (const Run* run : runs)
    if (run->spp > 0) bySpp[run->spp].push_back(run);
  for (const auto& [spp, some] : bySpp) {
    row.total[spp] = gather(some, [](const Run& run) { return run.total; });
    row.render[spp] = gather(some, [](const Run& run) { return run.render; });
  }
  // Rates of the longest renders: there the most rays were timed.
  const Runs& longest = maxSpp > 0 ? bySpp[maxSpp] : runs;
  row.renderPhases = renderPhases(longest);
  row.rate = gather(longest, [](const Run& run) { return run.rate; });
  for (std::size_t kind = 0; kind < rayKinds.size(); ++kind) {
    row.rates[kind] = gather(longest, [=](const Run& run) { return run.rates[kind]; });
    row.rays[kind] = gather(longest, [=](const Run& run) { return run.rays[kind]; });
    row.nodesPerRay[kind] = gather(longest, [=](const Run& run) { return run.nodesPerRay[kind]; }).value;
    row.trianglesPerRay[kind] = gather(longest, [=](const Run& run) { return run.trianglesPerRay[kind]; }).value;
  }
  row.nodes = medianOf(runs, &Run::nodes);
  row.leaves = medianOf(runs, &Run::leaves);
  row.depth = medianOf(runs, &Run::depth);
  row.overlap = medianOf(runs, &Run::overlap);
  row.treeBytes = medianOf(runs, &Run::treeBytes);
  row.buildPeakBytes = medianOf(runs, &Run::buildPeakBytes);
  return row;
}

/// What a full sweep would give if it took no time: the bound that the paper holds all methods against.
Row idealised(Row row) {
  row.ideal = true;
  row.label = std::string(idealBuilder) + ", ideal";
  row.build = {};
  row.total = row.render;
  row.buildPhases.clear();
  return row;
}

template <class T>
void addOnce(std::vector<T>& all, const T& value) {
  if (std::find(all.begin(), all.end(), value) == all.end()) all.push_back(value);
}

/// What besides its name tells one scene of a folder from another.
struct Setting {
  std::string scene;
  double triangles;
  int width, height;
  bool onGpu;
  bool operator==(const Setting&) const = default;
};

Scene toScene(const Setting& setting, const Runs& runs) {
  Scene scene;
  scene.plain = scene.name = setting.scene;
  scene.onGpu = setting.onGpu;
  std::vector<std::string> labels;
  std::map<std::string, Runs> byLabel;
  for (const Run* run : runs) {
    if (run->width > 0) {
      scene.width = run->width;
      scene.height = run->height;
    }
    if (known(run->triangles) && (!run->failed || !known(scene.triangles))) scene.triangles = run->triangles;
    scene.generated = scene.generated || run->generated;
    if (run->failed) continue;
    if (!run->view.empty()) addOnce(scene.views, run->view);
    addOnce(labels, run->label);
    byLabel[run->label].push_back(run);
  }
  for (const std::string& label : labels) scene.rows.push_back(toRow(byLabel[label]));
  std::stable_sort(scene.rows.begin(), scene.rows.end(),
                   [](const Row& a, const Row& b) { return builderRank(a.builder) < builderRank(b.builder); });
  if (const Row* best = scene.find(idealBuilder); best && !best->render.empty())
    scene.rows.insert(scene.rows.begin(), idealised(*best));
  return scene;
}

}  // namespace

double median(std::vector<double> values) {
  std::erase_if(values, [](double v) { return !known(v); });
  return values.empty() ? missing : copse::median(std::move(values));
}

Value overViews(const std::map<std::string, std::vector<double>>& values) {
  Value mean;
  if (values.empty()) return mean;
  mean = {0, 0, 0, 0, 0};
  for (const auto& [view, some] : values) {
    mean.value += median(some);
    mean.low += *std::min_element(some.begin(), some.end());
    mean.high += *std::max_element(some.begin(), some.end());
    mean.runs += static_cast<int>(some.size());
    ++mean.views;
  }
  for (double* sum : {&mean.value, &mean.low, &mean.high}) *sum /= mean.views;
  return mean;
}

double Row::parameter(const std::string& name) const {
  Run run;
  run.parameters = parameters;
  return run.parameter(name);
}

const Value* Row::totalAt(int spp) const {
  const auto found = total.find(spp);
  return found == total.end() || !found->second.known() ? nullptr : &found->second;
}

const Row* Scene::find(const std::string& label) const {
  for (const Row& row : rows)
    if (!row.ideal && row.label == label) return &row;
  return nullptr;
}

const Row* Scene::ideal() const { return !rows.empty() && rows.front().ideal ? &rows.front() : nullptr; }

bool Results::asksFor(const std::string& figure) const {
  const std::vector<std::string>& asked = loaded.experiment.report;
  return asked.empty() || std::find(asked.begin(), asked.end(), figure) != asked.end();
}

Results aggregate(Loaded loaded) {
  Results results;
  std::vector<Setting> settings;
  std::vector<Runs> runs;
  std::set<int> spp;
  std::map<std::string, std::set<std::pair<int, int>>> sizes;
  std::map<std::string, std::set<bool>> devices;
  std::map<std::string, std::set<double>> triangles;
  for (const Run& run : loaded.runs)
    if (known(run.triangles) && !run.failed) triangles[run.scene].insert(run.triangles);
  for (const Run& run : loaded.runs) {
    if (!showsTree(run)) continue;
    // A run that failed says at most how large its scene was to be.
    const std::set<double>& all = triangles[run.scene];
    double count = known(run.triangles) ? run.triangles : 0;
    if (!all.empty() && !all.contains(count))
      count = *std::min_element(all.begin(), all.end(),
                                [=](double a, double b) { return std::abs(a - count) < std::abs(b - count); });
    const Setting setting{run.scene, count, run.width, run.height, run.onGpu()};
    const auto found = std::find(settings.begin(), settings.end(), setting);
    const std::size_t index = static_cast<std::size_t>(found - settings.begin());
    if (found == settings.end()) {
      settings.push_back(setting);
      runs.emplace_back();
    }
    runs[index].push_back(&run);
    sizes[run.scene].insert({run.width, run.height});
    devices[run.scene].insert(run.onGpu());
    if (run.spp > 0 && !run.failed) spp.insert(run.spp);
  }
  for (std::size_t i = 0; i < settings.size(); ++i) {
    Scene scene = toScene(settings[i], runs[i]);
    if (triangles[scene.plain].size() > 1) scene.name += fmt::format(", {}", shownCount(scene.triangles));
    if (sizes[scene.plain].size() > 1) scene.name += fmt::format(", {}x{}", scene.width, scene.height);
    if (devices[scene.plain].size() > 1) scene.name += scene.onGpu ? ", GPU" : ", CPU";
    results.scenes.push_back(std::move(scene));
  }
  results.spp.assign(spp.begin(), spp.end());
  results.loaded = std::move(loaded);
  return results;
}

}  // namespace copse::report
