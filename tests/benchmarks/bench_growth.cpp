// How the time of builds grows with the triangles: a generator's scene in two sizes, in turn in one program, so that
// the ratios hold on a machine with other load too, and neither size finds its own triangles in the caches. Of the
// phases, "traversal layout" is the renderer's and not part of a builder's time. A program, not a test.
#include <fmt/format.h>

#include <thread>

#include "builder/base/error.h"
#include "builder/base/statistics.h"
#include "builder/build.h"
#include "builder/parallel/timeline.h"
#include "tests/support/timing.h"
#include "tracer/accel/binary.h"
#include "tracer/accel/tracers.h"
#include "tracer/cli/command_line.h"
#include "tracer/generators/generators.h"

using namespace copse;
using namespace copse::test;

namespace {

/// Times of one builder, or of one of its phases, by size.
struct Row {
  std::string name;
  std::vector<double> ms[2] = {};
};

class SizedScene {
 public:
  SizedScene(const Device& device, const GeneratorEntry& generator, uint32_t triangles)
      : scene_(generator.generate(triangles, 1)),
        positions_(device, scene_.positions),
        indices_(device, scene_.triangles) {}

  uint32_t count() const { return static_cast<uint32_t>(scene_.triangles.size()); }
  TrianglesView triangles() const { return {positions_.data(), indices_.data(), count()}; }

 private:
  Scene scene_;
  Buffer<vec3> positions_;
  Buffer<uvec3> indices_;
};

/// The builder's own row, then those of its phases.
void build(const Device& device, const TreeSource& source, const TrianglesView& triangles, int size,
           std::vector<Row>& rows) {
  if (source.isOwnTree()) {
    const auto baseline = source.tracer().make(device, triangles, {}, source.ownTree());
    rows[0].ms[size].push_back(millisecondsOf([&] { baseline->build(device, {}, triangles); }));
    std::this_thread::sleep_for(std::chrono::milliseconds(20));  // Its threads still spin for a while.
    return;
  }
  Timeline timeline(device);
  const Device recording = device.recording(timeline);
  Bvh bvh;
  rows[0].ms[size].push_back(millisecondsOf([&] {
    bvh = buildBvh(recording, triangles, source.builder(), withPreset(source.builder(), {}));
    synchronise(device);
  }));
  Binary::build(recording, bvh, triangles);
  for (const PhaseTime& phase : timeline.phases()) {
    auto row = std::find_if(rows.begin() + 1, rows.end(), [&](const Row& r) { return r.name == phase.name; });
    if (row == rows.end()) row = rows.insert(row, {phase.name});
    row->ms[size].push_back(phase.ms);
  }
}

void print(const Row& row, bool isPhase) {
  const auto& [few, many] = row.ms;
  fmt::print("| {} | {:.2f} | {:.2f} | {:.1f} | {:.1f} | {:.1f} | {:.1f} |\n",
             isPhase ? "… " + row.name : "`" + row.name + "`", median(few), minimum(few), median(many), minimum(many),
             median(many) / median(few), minimum(many) / minimum(few));
}

const GeneratorEntry& findGenerator(const std::string& name) {
  for (const GeneratorEntry& generator : generators())
    if (name == generator.name) return generator;
  throw InputError(fmt::format("unknown generator '{}'", name));
}

struct Options {
  std::string generator = "atrium", device = "cpu";
  std::vector<std::string> builders{"lbvh"};
  uint32_t few = 200000, many = 12000000;
  int threads = 0, repeat = 9;
};

void run(const Options& options) {
  const Device device = openDevice(options.device, options.threads);
  const GeneratorEntry& generator = findGenerator(options.generator);
  std::vector<std::vector<Row>> rows;
  for (const std::string& name : options.builders) rows.push_back({Row{findTreeSource(name).name()}});
  const SizedScene few(device, generator, options.few), many(device, generator, options.many);
  // The first round, which takes its memory from the system, is not counted.
  for (int round = -1; round < options.repeat; ++round) {
    if (round == 0)
      for (auto& ofBuilder : rows) ofBuilder.resize(1), ofBuilder[0].ms[0].clear(), ofBuilder[0].ms[1].clear();
    for (auto& ofBuilder : rows) {
      const TreeSource source = findTreeSource(ofBuilder[0].name);
      build(device, source, few.triangles(), 0, ofBuilder);
      build(device, source, many.triangles(), 1, ofBuilder);
    }
  }
  fmt::print("{}: {} and {} triangles, {} builds each in turn; {} times as many triangles\n\n", generator.name,
             few.count(), many.count(), options.repeat, static_cast<double>(many.count()) / few.count());
  fmt::print("| builder | ms | min | ms of the larger | min | ratio | of the min |\n");
  fmt::print("|---|--:|--:|--:|--:|--:|--:|\n");
  for (const auto& ofBuilder : rows)
    for (const Row& row : ofBuilder) print(row, &row != &ofBuilder[0]);
}

}  // namespace

int main(int argc, char** argv) {
  copse::cli::Program program("How the time of builds grows from a generator's small scene to its large one",
                              "bench_growth");
  Options options;
  program.option("generator", options.generator, "atrium by default");
  program.option("--builder", options.builders, "builders, or embree-low and so on; lbvh by default");
  program.option("--few", options.few, "triangles of the small scene");
  program.option("--many", options.many, "triangles of the large scene");
  program.option("--device", options.device);
  program.option("--threads", options.threads);
  program.option("--repeat", options.repeat).range(1, 1000);
  if (const auto status = program.parse(argc, argv)) return *status;
  try {
    run(options);
  } catch (const std::exception& error) {
    fmt::print(stderr, "error: {}\n", error.what());
    return 2;
  }
  return 0;
}
