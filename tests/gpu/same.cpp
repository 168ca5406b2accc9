// The CPU against a device: every builder's tree and every traversal of it, in every format, bit for bit, and the
// picture of the same scene up to rounding. One line per builder and a JSON file; exits with 1 if anything differs, and
// says whether it went through all builders. With `--device cpu` one thread is compared with all, so that the program
// itself can be tested without a GPU. A program, not a test: tests/gpu/run starts it, by itself and under
// compute-sanitizer.
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <sstream>

#include "builder/base/error.h"
#include "builder/base/whole_file.h"
#include "builder/build.h"
#include "builder/math/random.h"
#include "builder/parallel/memory_traffic.h"
#include "builder/parallel/timeline.h"
#include "tracer/accel/binary.h"
#include "tracer/accel/persistent.h"
#include "tracer/accel/tracers.h"
#include "tracer/accel/wide8.h"
#include "tracer/cli/command_line.h"
#include "tracer/generators/generators.h"
#include "tracer/integrators/parameters.h"
#include "tracer/integrators/path/path_tracer.h"

using namespace copse;

namespace {

/// A builder, and parameters beyond its presets.
struct Row {
  const BuilderEntry* builder;
  std::string settings;  ///< "KEY=VALUE KEY=VALUE …"
  OptimiserNames optimisers = {};
  std::string name() const {
    std::string name = builder->name;
    for (const std::string& optimiser : optimisers) name += "+" + optimiser;
    return settings.empty() ? name : name + (" " + settings);
  }
  Parameters parameters() const {
    Parameters chosen(tracerParameters());
    std::istringstream each(settings);
    for (std::string setting; each >> setting;) chosen.set(setting);
    return withPreset(*builder, chosen);
  }
};

/// All of `copse list builders`, k-means trees of wide nodes and of k-means++, optimisers over trees numbered
/// differently from those of lbvh, and other settings of how warps and batches share rays.
std::vector<Row> allRows() {
  std::vector<Row> rows;
  for (const BuilderEntry& builder : builders()) rows.push_back({&builder, ""});
  for (const char* setting : {"kmeans.arity=4", "kmeans.arity=8", "kmeans.seeding=plusplus"})
    rows.push_back({&findBuilder("kmeans"), setting});
  rows.push_back({&findBuilder("sah"), "", {"treelets-exact"}});
  rows.push_back({&findBuilder("hlbvh"), "", {"treelets-agglomerative"}});
  for (const char* sharing :
       {"trace.leave=0 trace.fetch=20 trace.blocks=1", "trace.leave=31 trace.fetch=32 path.queue=4096"})
    rows.push_back({&findBuilder("lbvh"), sharing});
  return rows;
}

/// "NAME", "NAME+OPTIMISER" or either and " KEY=VALUE KEY=VALUE …".
Row rowOf(const std::string& text) {
  const auto space = text.find(' ');
  const std::string name = text.substr(0, space);
  const auto plus = name.find('+');
  return {&findBuilder(name.substr(0, plus)), space == std::string::npos ? "" : text.substr(space + 1),
          plus == std::string::npos ? OptimiserNames{} : OptimiserNames{findOptimiser(name.substr(plus + 1)).name}};
}

struct Answers {
  std::string way;
  std::vector<Hit> hits;
  std::vector<uint32_t> occluded;
  std::vector<RaySteps> steps = {};  ///< For closest hits, where they are counted.
};

struct Result {
  std::vector<BvhNode> nodes;
  std::vector<uint32_t> order;
  double cost = 0;
  int launches = 0;  ///< In the build, as is the next.
  MemoryTraffic traffic{};
  bool refits = false;  ///< Fitting again over the same triangles leaves every bit of the tree.
  std::vector<Answers> answers;
  Image image;
};

/// Between random points of the scene's box, a quarter of them along an axis; some leave the box.
std::vector<Ray> raysIn(const Scene& scene, uint32_t count) {
  Box box;
  for (const vec3& position : scene.positions) box.grow(position);
  std::vector<Ray> rays(count);
  for (uint32_t i = 0; i < count; ++i) {
    const uint64_t key = randomKey(7, i, 0);
    const auto within = [&](uint32_t end) {
      vec3 point = box.lo;
      for (uint32_t axis = 0; axis < 3; ++axis)
        point[axis] += unitFloat(highWord(randomBits(key, end, axis))) * (box.hi[axis] - box.lo[axis]);
      return point;
    };
    const vec3 from = within(0);
    vec3 direction = within(1) - from;
    if (i % 4 == 0) {
      const int axis = static_cast<int>(i / 4 % 3);
      const float along = direction[axis];
      direction = vec3(0);
      direction[axis] = along;
    }
    rays[i] = {from, 0, direction, i % 3 == 0 ? 1.0f : 1e30f};
  }
  return rays;
}

/// Traces rays through `bvh` in a format: as the renderer does, which on CUDA is by persistent warps; one ray per
/// thread with counters; and with `warps` by persistent warps on a CPU too.
template <class Format>
void trace(const Device& device, const char* format, const Bvh& bvh, const TrianglesView& triangles,
           const Parameters& parameters, const std::vector<Ray>& rays, bool warps, std::vector<Answers>& all) {
  const auto n = static_cast<uint32_t>(rays.size());
  const Buffer<Ray> onDevice(device, rays);
  const auto answers = [&](const char* way, const auto& closest, const auto& any) -> Answers& {
    Buffer<Hit> hits(device, n);
    Buffer<uint32_t> occluded(device, n);
    closest(hits.data());
    any(occluded.data());
    return all.emplace_back(Answers{fmt::format("{} {}", format, way), hits.toHost(), occluded.toHost()});
  };
  const auto tracer = makeTracer(device, bvh, triangles, format, parameters);
  answers(
      "default", [&](Hit* to) { tracer->closest(device, "closest", n, onDevice.data(), to); },
      [&](uint32_t* to) { tracer->any(device, "any", n, onDevice.data(), to); });
  const StepTracer& counting = *tracer->stepTracer();
  const Buffer<RaySteps> steps(device, n), ofAny(device, n);
  Answers& counted = answers(
      "one ray per thread", [&](Hit* to) { counting.closest(device, "closest", n, onDevice.data(), to, steps.data()); },
      [&](uint32_t* to) { counting.any(device, "any", n, onDevice.data(), to, ofAny.data()); });
  counted.steps = steps.toHost();
  if (!warps || device.isCuda()) return;
  const PersistentTracer<Format> persistent(device, PersistentSettings(parameters));
  const typename Format::Tree tree = Format::build(device, bvh, triangles);
  answers(
      "persistent", [&](Hit* to) { persistent.closest(device, "closest", tree.view(), n, onDevice.data(), to); },
      [&](uint32_t* to) { persistent.any(device, "any", tree.view(), n, onDevice.data(), to); });
}

template <class T>
bool sameBits(const std::vector<T>& a, const std::vector<T>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(T)) == 0;
}

/// The tree, rays through it, and the picture that is traced through it, if `size` is not 0.
Result runOn(const Device& device, const Scene& scene, const Row& row, const std::vector<Ray>& rays, int size,
             bool warps) {
  const Parameters parameters = row.parameters();
  const auto uploaded = uploadScene(device, scene);
  const TrianglesView triangles = trianglesOf(*uploaded);
  Result result;
  Timeline timeline(device);
  const MemoryTraffic before = memoryTraffic();
  Bvh bvh = buildBvh(device.recording(timeline), triangles, *row.builder, parameters, {row.optimisers});
  const MemoryTraffic after = memoryTraffic();
  result.traffic = {after.waits - before.waits, after.allocations - before.allocations};
  for (const PhaseTime& phase : timeline.phases()) result.launches += phase.launches;
  result.nodes = bvh.nodes.toHost(bvh.nodeCount);
  result.order = bvh.order.toHost(bvh.referenceCount);
  result.cost = statistics(device, bvh, parameters).sahCost;
  validate(device, bvh, triangles, maxLeafSize);
  const OwnedPrimitives primitives = primitivesOf(device, triangles);
  fit(device, bvh, primitives.view().boxes);
  result.refits = sameBits(bvh.nodes.toHost(bvh.nodeCount), result.nodes);
  if (!rays.empty()) {
    trace<Binary>(device, "binary", bvh, triangles, parameters, rays, warps, result.answers);
    trace<Wide8>(device, "wide8", bvh, triangles, parameters, rays, warps, result.answers);
  }
  if (size == 0) return result;
  RenderSettings settings;
  settings.width = settings.height = size;
  settings.spp = 2;
  const auto tracer = makeTracer(device, bvh, triangles, "auto", parameters);
  const PathOptions options{.queue = pathQueueOf(parameters)};
  result.image = renderPath(device, *uploaded, *tracer, scene.cameras.at(0), settings, {}, options).image;
  return result;
}

/// The traversals of `found` whose hits differ from those of the first on the reference, or whose steps differ from
/// those of the same one there; "" if none does.
std::string otherRays(const Result& expected, const Result& found) {
  std::string ways;
  const auto add = [&](const std::string& way) { ways += (ways.empty() ? "" : ", ") + way; };
  for (const std::vector<Answers>* all : {&expected.answers, &found.answers})
    for (const Answers& answers : *all) {
      const Answers& right = expected.answers.front();
      if (!sameBits(answers.hits, right.hits) || answers.occluded != right.occluded) add(answers.way);
    }
  for (const Answers& answers : found.answers)
    for (const Answers& first : expected.answers)
      if (answers.way == first.way && !sameBits(answers.steps, first.steps)) add("steps of " + answers.way);
  return ways;
}

/// The share of pixels that differ by more than rounding does: it shows paths that rounding sends elsewhere.
double differing(const Image& a, const Image& b) {
  std::size_t pixels = 0;
  for (std::size_t i = 0; i < a.pixels.size(); ++i) {
    bool same = true;
    for (int c = 0; c < 3; ++c) {
      const float x = a.pixels[i][c], y = b.pixels[i][c];
      same = same && std::abs(x - y) <= 1e-3f * std::max({std::abs(x), std::abs(y), 1e-3f});
    }
    pixels += !same;
  }
  return a.pixels.empty() ? 0 : static_cast<double>(pixels) / static_cast<double>(a.pixels.size());
}

double mean(const Image& image) {
  double sum = 0;
  for (const vec3& pixel : image.pixels) sum += pixel.x + pixel.y + pixel.z;
  return image.pixels.empty() ? 0 : sum / (3.0 * static_cast<double>(image.pixels.size()));
}

struct Options {
  std::string device = "cuda", stats;
  std::vector<std::string> generators{"atrium", "hairball"}, builders;
  uint32_t triangles = 50000, rays = 20000;
  int size = 96;
};

/// One row on one scene; true if all is the same.
bool compare(const Options& options, const Device& reference, const Device& device, const std::string& generator,
             const Scene& scene, const Row& row, nlohmann::json& rows) {
  const std::vector<Ray> rays = raysIn(scene, options.rays);
  const Result expected = runOn(reference, scene, row, rays, options.size, false);
  const Result found = runOn(device, scene, row, rays, options.size, true);
  const bool tree = sameBits(expected.nodes, found.nodes) && expected.order == found.order && found.refits;
  const std::string ways = otherRays(expected, found);
  std::size_t hits = 0;
  if (!expected.answers.empty())
    for (const Hit& hit : expected.answers.front().hits) hits += hit.triangle != Hit::none;
  const double pixels = differing(expected.image, found.image);
  const double light = std::abs(mean(found.image) - mean(expected.image)) / std::max(mean(expected.image), 1e-9);
  // Two samples per pixel: a few paths may diverge, but not the picture's light. Written so that NaN does not match.
  const bool image = options.size == 0 || (pixels <= 0.02 && light <= 0.01);
  fmt::print(
      "{:8} {:24} tree {:8} cost {:.4f} and {:.4f}; rays {}, {} hits; {:.3f} % of pixels differ, light by {:.2e}{}; "
      "{} launches, {} waits, {} allocations\n",
      generator, row.name(), tree ? "the same" : "DIFFERS", expected.cost, found.cost,
      ways.empty() ? "the same" : "DIFFER: " + ways, hits, 100 * pixels, light, image ? "" : " TOO MUCH",
      found.launches, found.traffic.waits, found.traffic.allocations);
  std::fflush(stdout);
  rows.push_back({{"scene", generator},
                  {"builder", row.name()},
                  {"same_tree", tree},
                  {"sah_cost", {expected.cost, found.cost}},
                  {"same_rays", ways.empty()},
                  {"hits", hits},
                  {"differing_pixels", pixels},
                  {"light", light},
                  {"same_image", image},
                  {"launches", found.launches},
                  {"waits", found.traffic.waits},
                  {"allocations", found.traffic.allocations}});
  return tree && ways.empty() && image;
}

/// The number of rows whose results differ.
int run(const Options& options) {
  const Device reference = openDevice("cpu", options.device == "cpu" ? 1 : 0), device = openDevice(options.device);
  std::vector<Row> chosen;
  for (const std::string& name : options.builders) chosen.push_back(rowOf(name));
  if (chosen.empty()) chosen = allRows();
  const bool all = std::all_of(builders().begin(), builders().end(), [&](const BuilderEntry& builder) {
    return std::any_of(chosen.begin(), chosen.end(), [&](const Row& row) { return row.builder == &builder; });
  });
  nlohmann::json rows = nlohmann::json::array();
  int failed = 0;
  const auto write = [&](bool complete) {  // After each row, so that a time limit loses no result.
    if (options.stats.empty()) return;
    const nlohmann::json json{{"device", device.name},
                              {"complete", complete},
                              {"every_builder", complete && all},
                              {"differ", failed},
                              {"rows", rows}};
    writeWholeFile(options.stats, json.dump(1) + "\n");
  };
  for (const std::string& generator : options.generators) {
    const Scene scene = findGenerator(generator).generate(options.triangles, 1);
    fmt::print("{}, {} triangles; {} against {}\n", generator, scene.triangles.size(), device.name, reference.name);
    for (const Row& row : chosen) {
      failed += !compare(options, reference, device, generator, scene, row, rows);
      write(false);
    }
  }
  write(true);
  fmt::print("{} of {} rows differ; {} builders, {}\n", failed, rows.size(), builders().size(),
             all ? "every one compared" : "NOT all compared");
  return failed;
}

}  // namespace

int main(int argc, char** argv) {
  copse::cli::Program program("Trees, rays and pictures of a device against those of the CPU", "gpu_same");
  Options options;
  program.option("--device", options.device).showDefault();
  program.option("--builder", options.builders, "NAME or \"NAME KEY=VALUE …\"; all by default");
  program.option("--generator", options.generators).showDefault();
  program.option("--triangles", options.triangles).showDefault();
  program.option("--rays", options.rays, "number of random rays; 0 for none").showDefault();
  program.option("--size", options.size, "pixels per side; 0 for no picture").showDefault();
  program.option("--stats", options.stats, "results as JSON");
  if (const auto status = program.parse(argc, argv)) return *status;
  try {
    return run(options) ? 1 : 0;
  } catch (const DeviceError& error) {
    fmt::print(stderr, "error: {}\n", error.what());
    return 3;
  } catch (const std::exception& error) {
    fmt::print(stderr, "error: {}\n", error.what());
    return 2;
  }
}
