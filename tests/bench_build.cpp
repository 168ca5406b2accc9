// How long builds take: every builder by phases, and Embree 3's Morton build and binned build of the same triangles,
// in turn in one program so that the ratios stand on a machine that has other work too. A program, not a test.
#include <fmt/format.h>

#include <CLI/CLI.hpp>

#include <algorithm>
#include <chrono>

#include "builder/build.h"
#include "builder/parallel/error.h"
#include "builder/parallel/timeline.h"
#include "tests/bench_peers_embree.h"
#include "tracer/scene/generators.h"

using namespace copse;

namespace {

struct Times {
  std::string name;
  std::vector<double> ms;
  std::vector<std::pair<std::string, std::vector<double>>> phases;

  static double median(std::vector<double> of) {
    if (of.empty()) return 0;
    std::sort(of.begin(), of.end());
    return of[of.size() / 2];
  }
  void add(const PhaseTime& phase) {
    const auto found = std::find_if(phases.begin(), phases.end(), [&](const auto& p) { return p.first == phase.name; });
    (found != phases.end() ? *found : phases.emplace_back(phase.name, std::vector<double>{}))
        .second.push_back(phase.ms);
  }
  void print(double unit) const {
    fmt::print("{:14} {:9.2f} ms  least {:9.2f}  {:6.2f} x Embree's Morton build\n", name, median(ms),
               *std::min_element(ms.begin(), ms.end()), median(ms) / unit);
    for (const auto& [phase, times] : phases) fmt::print("    {:20} {:9.2f}\n", phase, median(times));
  }
};

Scene sceneOf(const std::string& source, uint32_t triangles) {
  for (const GeneratorEntry& generator : generators())
    if (source == generator.name) return generator.generate(triangles ? triangles : generator.defaultTriangles, 1);
  return loadScene(source);
}

void run(const Scene& scene, const std::vector<std::string>& names, int threads, int repeat, bool mediumToo) {
  const Device device = openDevice("cpu", threads);
  const Buffer<vec3> positions(device, scene.positions);
  const Buffer<uvec3> indices(device, scene.triangles);
  const TrianglesView triangles{positions.data(), indices.data(), static_cast<uint32_t>(scene.triangles.size())};
  std::vector<Times> rows{{"embree low", {}, {}}, {"embree medium", {}, {}}};
  for (const std::string& name : names) rows.push_back({name, {}, {}});
  for (int round = 0; round < repeat; ++round) {
    rows[0].ms.push_back(peers::EmbreeTracer(scene, peers::Quality::low, device.threads).buildMs());
    if (mediumToo) rows[1].ms.push_back(peers::EmbreeTracer(scene, peers::Quality::medium, device.threads).buildMs());
    for (std::size_t i = 0; i < names.size(); ++i) {
      const BuilderEntry& builder = findBuilder(names[i]);
      Timeline timeline(device);
      const auto start = std::chrono::steady_clock::now();
      buildBvh(device.recording(timeline), triangles, builder, withPreset(builder, {}));
      rows[i + 2].ms.push_back(
          std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count());
      for (const PhaseTime& phase : timeline.phases()) rows[i + 2].add(phase);
    }
  }
  fmt::print("{}: {} triangles, {} threads, medians of {}\n", scene.name, triangles.count, device.threads, repeat);
  for (const Times& row : rows)
    if (!row.ms.empty()) row.print(Times::median(rows[0].ms));
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Build times beside Embree 3's");
  std::string source = "atrium";
  std::vector<std::string> names;
  uint32_t triangles = 0;
  int threads = 0, repeat = 9;
  bool mortonAlone = false;
  app.add_option("scene", source, "a scene, a mesh or a generator's name");
  app.add_option("--builder", names, "builders; all where none is named");
  app.add_option("--triangles", triangles, "for a generator");
  app.add_option("--threads", threads);
  app.add_option("--repeat", repeat)->check(CLI::Range(1, 1000));
  app.add_flag("--morton-alone", mortonAlone, "of Embree's builds, without the binned one");
  CLI11_PARSE(app, argc, argv);
  try {
    if (names.empty())
      for (const BuilderEntry& builder : builders()) names.push_back(builder.name);
    run(sceneOf(source, triangles), names, threads, repeat, !mortonAlone);
  } catch (const std::exception& error) {
    fmt::print(stderr, "error: {}\n", error.what());
    return 2;
  }
  return 0;
}
