// copse generate: a scene made from a seed, as OBJ and MTL for other programs.
#include <fmt/format.h>

#include <memory>
#include <optional>

#include "builder/base/error.h"
#include "builder/base/text.h"
#include "tracer/cli/commands.h"
#include "tracer/cli/options.h"
#include "tracer/cli/print.h"
#include "tracer/cli/progress.h"
#include "tracer/generators/generators.h"

namespace copse::cli {

namespace {

struct Options {
  std::string name, output;
  long long triangles = -1, seed = 1;
};

int run(const Options& options, bool counted) {
  const GeneratorEntry& generator = findGenerator(options.name);
  if (counted && (options.triangles < 1 || options.triangles > 1'000'000'000))
    throw InputError(fmt::format("--triangles: expected an integer from 1 to 1000000000, got {}", options.triangles));
  if (options.seed < 0) throw InputError(fmt::format("--seed: expected an integer of 0 or more, got {}", options.seed));
  checkOutput("-o", options.output, ".obj");
  endOnSignal();
  Progress progress("generating " + options.name, false);
  const uint32_t triangles = counted ? static_cast<uint32_t>(options.triangles) : generator.defaultTriangles;
  const Scene scene = generator.generate(triangles, static_cast<uint64_t>(options.seed));
  writeObj(scene, options.output);
  print("{}: {} triangles, {} materials\n", options.output, grouped(scene.triangles.size()), scene.materials.size());
  return done;
}

}  // namespace

Command addGenerate(CommandLine& program) {
  CommandLine command = program.addCommand("generate", "Generate a scene from a seed, as an OBJ file");
  auto options = std::make_shared<Options>();
  command.option("NAME", options->name, "Generator's name, see `copse list generators`").required();
  const Option triangles =
      command.option("--triangles", options->triangles, "Approximate number; the generator's own by default")
          .allowUnderscores();
  command.option("--seed", options->seed, "Random seed; the same seed gives the same triangles")
      .showDefault()
      .allowUnderscores();
  command.option("-o,--output", options->output, "FILE.obj; FILE.mtl is written beside it").required();
  return [=] { return run(*options, triangles.given()); };
}

}  // namespace copse::cli
