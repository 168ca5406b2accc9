// How long each builder takes for awkward triangles, as a multiple of its time for equally many random ones: a Markdown
// table. None should take ten times as long. A program, not a test.
#include <fmt/format.h>

#include <algorithm>

#include "builder/base/error.h"
#include "builder/base/statistics.h"
#include "builder/build.h"
#include "tests/support/inputs.h"
#include "tests/support/timing.h"
#include "tracer/cli/command_line.h"

using namespace copse;
using namespace copse::test;

namespace {

double milliseconds(const Device& device, const DeviceMesh& mesh, const BuilderEntry& builder) {
  return millisecondsOf([&] {
    buildBvh(device, mesh.view(), builder, withPreset(builder, {}));
    synchronise(device);
  });
}

/// Builders take turns with the inputs, so that other load on the machine affects all of them.
void run(const Device& device, uint32_t triangles, int repeat, const std::vector<std::string>& names) {
  std::vector<std::string> inputs{"random"};
  for (const std::string& name : inputNames())
    if (name != "random") inputs.push_back(name);
  std::vector<DeviceMesh> meshes;
  for (const std::string& name : inputs) meshes.emplace_back(device, makeInput(name, triangles));

  fmt::print("{} triangles, {} threads, medians of {}; the first column in milliseconds, the others over it\n\n|",
             triangles, device.threads, repeat);
  for (const std::string& name : inputs) fmt::print(" | {}", name);
  fmt::print(" | max |\n|---|");
  for (std::size_t i = 0; i <= inputs.size(); ++i) fmt::print("--:|");
  fmt::print("\n");
  for (const std::string& name : names) {
    const BuilderEntry& builder = findBuilder(name);
    std::vector<std::vector<double>> times(inputs.size());
    for (int round = -1; round < repeat; ++round)
      for (std::size_t i = 0; i < inputs.size(); ++i) {
        const double ms = milliseconds(device, meshes[i], builder);
        if (round >= 0) times[i].push_back(ms);
      }
    const double random = median(times[0]);
    fmt::print("| `{}` | {:.1f}", name, random);
    double max = 0;
    for (std::size_t i = 1; i < inputs.size(); ++i) {
      const double ratio = median(times[i]) / random;
      fmt::print(" | {:.2f}", ratio);
      max = std::max(max, ratio);
    }
    fmt::print(" | {:.2f} |\n", max);
  }
}

}  // namespace

int main(int argc, char** argv) {
  copse::cli::Program program("Build times for awkward triangles, over those for random ones", "bench_inputs");
  uint32_t triangles = 100000;
  int threads = 0, repeat = 3;
  std::string where = "cpu";
  std::vector<std::string> names;
  program.option("--triangles", triangles).range(1, 100000000);
  program.option("--threads", threads);
  program.option("--repeat", repeat).range(1, 1000);
  program.option("--device", where);
  program.option("--builder", names, "builders; all by default");
  if (const auto status = program.parse(argc, argv)) return *status;
  try {
    if (names.empty())
      for (const BuilderEntry& builder : builders()) names.push_back(builder.name);
    run(openDevice(where, threads), triangles, repeat, names);
  } catch (const std::exception& error) {
    fmt::print(stderr, "error: {}\n", error.what());
    return 2;
  }
  return 0;
}
