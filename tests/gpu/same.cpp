// The CPU against a device: every builder's tree, bit for bit, and its picture of the same scene. One line a builder
// and a JSON file; ends with 1 where something differs. With `--device cpu` it compares one thread with all, so that
// the program itself is tried where there is no GPU. A program, not a test: tests/gpu/run starts it, and the sanitizers
// do.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include <cmath>
#include <cstring>
#include <fstream>

#include "builder/build.h"
#include "builder/parallel/error.h"
#include "builder/parallel/timeline.h"
#include "builder/parallel/traffic.h"
#include "tracer/path/path_tracer.h"
#include "tracer/scene/generators.h"
#include "tracer/traversal/traversal_bvh.h"

using namespace copse;

namespace {

struct Result {
  std::vector<BvhNode> nodes;
  std::vector<uint32_t> order;
  double cost = 0;
  int launches = 0;  ///< Of the build, as the next two.
  Traffic traffic{};
  Image image;
};

/// The tree, and the picture that is traced through it, if `size` is not 0.
Result runOn(const Device& device, const Scene& scene, const BuilderEntry& builder, int size) {
  const Parameters parameters = withPreset(builder, {});
  const auto uploaded = uploadScene(device, scene);
  const TrianglesView triangles = trianglesOf(*uploaded);
  Result result;
  Timeline timeline(device);
  const Traffic before = trafficSoFar();
  const Bvh bvh = buildBvh(device.recording(timeline), triangles, builder, parameters);
  const Traffic after = trafficSoFar();
  result.traffic = {after.waits - before.waits, after.allocations - before.allocations};
  for (const PhaseTime& phase : timeline.phases()) result.launches += phase.launches;
  result.nodes = bvh.nodes.toHost(bvh.nodeCount);
  result.order = bvh.order.toHost(bvh.primitiveCount);
  result.cost = statistics(device, bvh, parameters).sahCost;
  validate(device, bvh, triangles, maxLeafSize);
  if (size == 0) return result;
  const TraversalBvh traversal = traversalBvh(device, bvh, triangles);
  RenderSettings settings;
  settings.width = settings.height = size;
  settings.spp = 2;
  result.image = renderPath(device, *uploaded, BvhRayTracer(traversal.view()), scene.views.at(0), settings).image;
  return result;
}

bool sameTree(const Result& a, const Result& b) {
  return a.nodes.size() == b.nodes.size() && a.order == b.order &&
         std::memcmp(a.nodes.data(), b.nodes.data(), a.nodes.size() * sizeof(BvhNode)) == 0;
}

/// The share of pixels that differ by more than rounding does: a path that a rounding sends another way shows there.
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
  std::string device = "cuda", generator = "atrium", stats;
  std::vector<std::string> builders;
  uint32_t triangles = 50000;
  int size = 96;
};

/// The number of builders whose results differ.
int run(const Options& options) {
  const Device reference = openDevice("cpu", options.device == "cpu" ? 1 : 0), device = openDevice(options.device);
  const Scene scene = findGenerator(options.generator).generate(options.triangles, 1);
  fmt::print("{} triangles; {} beside {}\n", scene.triangles.size(), device.name, reference.name);
  nlohmann::json rows = nlohmann::json::array();
  int failed = 0;
  for (const std::string& name : options.builders) {
    const BuilderEntry& builder = findBuilder(name);
    const Result expected = runOn(reference, scene, builder, options.size);
    const Result found = runOn(device, scene, builder, options.size);
    const bool tree = sameTree(expected, found);
    const double pixels = differing(expected.image, found.image);
    const double light = std::abs(mean(found.image) - mean(expected.image)) / std::max(mean(expected.image), 1e-9);
    // Two samples a pixel: a few paths may part, the picture's light may not.
    const bool image = pixels <= 0.02 && light <= 0.01;
    failed += !tree || !image;
    fmt::print(
        "{:14} tree {:9} cost {:.4f} and {:.4f}; {:.3f} % of pixels differ, light by {:.2e}{}; {} launches, {} waits, "
        "{} allocations\n",
        name, tree ? "the same" : "DIFFERS", expected.cost, found.cost, 100 * pixels, light, image ? "" : " TOO MUCH",
        found.launches, found.traffic.waits, found.traffic.allocations);
    rows.push_back({{"builder", name},
                    {"same_tree", tree},
                    {"sah_cost", {expected.cost, found.cost}},
                    {"differing_pixels", pixels},
                    {"light", light},
                    {"same_image", image},
                    {"launches", found.launches},
                    {"waits", found.traffic.waits},
                    {"allocations", found.traffic.allocations}});
  }
  if (!options.stats.empty()) {
    std::ofstream file(options.stats);
    file << nlohmann::json{{"device", device.name}, {"triangles", scene.triangles.size()}, {"builders", rows}}.dump(2)
         << "\n";
    if (!file.flush()) throw InputError(fmt::format("{}: cannot be written", options.stats));
  }
  return failed;
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Trees and pictures of a device beside those of the CPU");
  Options options;
  app.add_option("--device", options.device);
  app.add_option("--builder", options.builders, "builders; all where none is named");
  app.add_option("--generator", options.generator);
  app.add_option("--triangles", options.triangles);
  app.add_option("--size", options.size, "pixels a side; 0 for trees alone");
  app.add_option("--stats", options.stats, "results as JSON");
  CLI11_PARSE(app, argc, argv);
  try {
    if (options.builders.empty())
      for (const BuilderEntry& builder : builders())
        if (builder.build) options.builders.push_back(builder.name);
    return run(options) ? 1 : 0;
  } catch (const DeviceError& error) {
    fmt::print(stderr, "error: {}\n", error.what());
    return 3;
  } catch (const std::exception& error) {
    fmt::print(stderr, "error: {}\n", error.what());
    return 2;
  }
}
