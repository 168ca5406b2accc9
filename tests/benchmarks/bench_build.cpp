// Build times: every builder as a multiple of lbvh, against the paper's multiples; the baseline Embree on the same
// triangles; how the time grows from a small scene to a large one; sah on one thread and on two. All in turn in one
// program, so that the ratios hold on a machine with other load too. A program, not a test.
#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <numeric>
#include <thread>

#include "builder/base/error.h"
#include "builder/base/statistics.h"
#include "builder/build.h"
#include "builder/parallel/timeline.h"
#include "tests/support/timing.h"
#include "tracer/accel/tracers.h"
#include "tracer/cli/command_line.h"
#include "tracer/generators/generators.h"

using namespace copse;
using namespace copse::test;

namespace {

/// Build time over that of lbvh on the paper's GPU, over its scenes. Meister and Bittner, from Table 1.
double paperMultiple(const std::string& builder) {
  constexpr std::pair<const char*, double> multiples[] = {{"lbvh", 1},         {"hlbvh", 2.1},     {"atrbvh", 3.2},
                                                          {"kmeans-q1", 1.3},  {"kmeans-q2", 2.2}, {"kmeans-q3", 4.0},
                                                          {"kmeans-q4", 10.8}, {"kmeans-q5", 39}};
  for (const auto& [name, multiple] : multiples)
    if (builder == name) return multiple;
  return 0;
}

/// A builder and its times, in all and by phase.
struct Row {
  std::string name;
  std::function<double()> milliseconds;
  std::vector<double> ms = {};
  std::vector<std::pair<std::string, std::vector<double>>> phases = {};

  void add(const PhaseTime& phase) {
    const auto found = std::find_if(phases.begin(), phases.end(), [&](const auto& p) { return p.first == phase.name; });
    (found != phases.end() ? *found : phases.emplace_back(phase.name, std::vector<double>{}))
        .second.push_back(phase.ms);
  }
  double spent() const { return std::accumulate(ms.begin(), ms.end(), 0.0); }
};

/// All rows in turn, `repeat` times; a row that has taken `maxMs` milliseconds is left out of further rounds.
void takeTurns(std::vector<Row>& rows, int repeat, double maxMs) {
  for (int round = 0; round < repeat; ++round)
    for (Row& row : rows)
      if (round == 0 || row.spent() < maxMs) row.ms.push_back(row.milliseconds());
}

Scene sceneOf(const std::string& source, uint32_t triangles) {
  for (const GeneratorEntry& generator : generators())
    if (source == generator.name) return generator.generate(triangles ? triangles : generator.defaultTriangles, 1);
  return loadScene(source);
}

struct Options {
  std::vector<std::string> scenes{"atrium", "hairball"}, builders;
  uint32_t triangles = 0;
  int threads = 0, repeat = 5;
  double seconds = 4;
  bool mortonAlone = false, phases = false;
};

class SceneBench {
 public:
  SceneBench(const Options& options, const std::string& source)
      : options_(options),
        scene_(sceneOf(source, options.triangles)),
        device_(openDevice("cpu", options.threads)),
        positions_(device_, scene_.positions),
        indices_(device_, scene_.triangles),
        triangles_{positions_.data(), indices_.data(), static_cast<uint32_t>(scene_.triangles.size())} {}

  uint32_t triangles() const { return triangles_.count; }

  /// Milliseconds of each builder, in the order of the options.
  std::vector<double> builders() {
    std::vector<Row> rows;
    for (const std::string& name : options_.builders) rows.push_back({name, {}});
    const std::size_t own = rows.size();
    rows.push_back({"Embree low", [this] { return embree("embree-low", device_.threads); }});
    if (!options_.mortonAlone)
      rows.push_back({"Embree medium", [this] { return embree("embree-medium", device_.threads); }});
    for (std::size_t i = 0; i < own; ++i)  // The rows do not move from here on.
      rows[i].milliseconds = [this, &row = rows[i]] { return build(row.name, device_, &row); };
    takeTurns(rows, options_.repeat, 1000 * options_.seconds);

    const auto lbvh = std::find_if(rows.begin(), rows.end(), [](const Row& row) { return row.name == "lbvh"; });
    const double unit = lbvh != rows.end() ? median(lbvh->ms) : 0, morton = median(rows[own].ms);
    fmt::print("\n{}: {} triangles, {} threads, medians of at most {} builds\n\n", scene_.name, triangles_.count,
               device_.threads, options_.repeat);
    fmt::print("| builder | ms | min | of `lbvh` | the paper's | of Embree's Morton build | ns per triangle |\n");
    fmt::print("|---|--:|--:|--:|--:|--:|--:|\n");
    std::vector<double> ms;
    for (const Row& row : rows) {
      const double middle = median(row.ms), paper = paperMultiple(row.name);
      fmt::print("| `{}` | {:.1f} | {:.1f} | {} | {} | {:.2f} | {:.0f} |\n", row.name, middle, minimum(row.ms),
                 unit > 0 ? fmt::format("{:.2f}", middle / unit) : "", paper > 0 ? fmt::format("{:.1f}", paper) : "",
                 middle / morton, 1e6 * middle / triangles_.count);
      if (options_.phases)
        for (const auto& [phase, times] : row.phases)
          fmt::print("| … {} | {:.2f} | {:.2f} | | | | |\n", phase, median(times), minimum(times));
      if (&row < &rows[own]) ms.push_back(middle);
    }
    return ms;
  }

  /// The sweep on one thread against Embree's medium build on one, and on two threads against one.
  void sweep() {
    const Device one = openDevice("cpu", 1), two = openDevice("cpu", 2);
    std::vector<Row> rows{{"sah, one thread", [&] { return build("sah", one, nullptr); }},
                          {"sah, two threads", [&] { return build("sah", two, nullptr); }},
                          {"Embree medium, one thread", [this] { return embree("embree-medium", 1); }}};
    takeTurns(rows, 2 * options_.repeat + 1, 1000 * options_.seconds);
    const double alone = median(rows[0].ms), both = median(rows[1].ms), embreeAlone = median(rows[2].ms);
    fmt::print("\n{}: {} triangles, `sah`, medians of {} builds\n\n", scene_.name, triangles_.count,
               2 * options_.repeat + 1);
    for (const Row& row : rows) fmt::print("- {}: {:.1f} ms\n", row.name, median(row.ms));
    fmt::print("- one thread takes {:.2f} times as long as Embree's (goal: at most 2.5)\n", alone / embreeAlone);
    fmt::print("- two threads are {:.2f} times as fast as one (goal: 1.6)\n", alone / both);
  }

 private:
  double build(const std::string& name, const Device& device, Row* row) const {
    const BuilderEntry& builder = findBuilder(name);
    const Parameters parameters = withPreset(builder, {});
    Timeline timeline(device);
    const double ms = millisecondsOf([&] { buildBvh(device.recording(timeline), triangles_, builder, parameters); });
    if (row)
      for (const PhaseTime& phase : timeline.phases()) row->add(phase);
    return ms;
  }
  double embree(const char* name, int threads) const {
    Device device = device_;
    device.threads = threads;
    const TreeSource source = findTreeSource(name);
    const auto baseline = source.tracer().make(device, triangles_, {}, source.ownTree());
    const double ms = millisecondsOf([&] { baseline->build(device, {}, triangles_); });
    std::this_thread::sleep_for(std::chrono::milliseconds(20));  // Its threads still spin for a while.
    return ms;
  }

  const Options& options_;
  Scene scene_;
  Device device_;
  Buffer<vec3> positions_;
  Buffer<uvec3> indices_;
  TrianglesView triangles_;
};

void run(const Options& options) {
  std::vector<std::pair<uint32_t, std::vector<double>>> found;
  for (const std::string& source : options.scenes) {
    SceneBench bench(options, source);
    found.emplace_back(bench.triangles(), bench.builders());
    const auto& names = options.builders;
    if (found.size() == 1 && std::find(names.begin(), names.end(), "sah") != names.end()) bench.sweep();
  }
  if (found.size() < 2) return;
  const auto& [few, fewMs] = found.front();
  const auto& [many, manyMs] = found.back();
  fmt::print("\nTime per triangle at {} over that at {} (goal: at most 1.5; `sah` and `aac`: n log n)\n\n", many, few);
  for (std::size_t i = 0; i < fewMs.size(); ++i)
    fmt::print("- `{}`: {:.2f}\n", options.builders[i], manyMs[i] / many / (fewMs[i] / few));
}

}  // namespace

int main(int argc, char** argv) {
  copse::cli::Program program("Build times against lbvh's, the paper's and Embree's", "bench_build");
  Options options;
  program.option("scene", options.scenes, "scenes, meshes or names of generators; atrium and hairball by default");
  program.option("--builder", options.builders, "builders; all by default");
  program.option("--triangles", options.triangles, "for a generator");
  program.option("--threads", options.threads);
  program.option("--repeat", options.repeat).range(1, 1000);
  program.option("--seconds", options.seconds, "a builder that has taken this long is not repeated further");
  program.flag("--morton-alone", options.mortonAlone, "of Embree's builds only the Morton one");
  program.flag("--phases", options.phases, "times of the phases of each build");
  if (const auto status = program.parse(argc, argv)) return *status;
  try {
    if (options.builders.empty())
      for (const BuilderEntry& builder : builders()) options.builders.push_back(builder.name);
    run(options);
  } catch (const std::exception& error) {
    fmt::print(stderr, "error: {}\n", error.what());
    return 2;
  }
  return 0;
}
