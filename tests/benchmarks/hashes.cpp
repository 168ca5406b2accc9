// A hash of every builder's tree, of the hits of rays through it and of an image traced through it, on each scene: to
// show that a change changes no result, compare them before and after. One line per scene and builder, on standard
// output.
#include <fmt/format.h>

#include <algorithm>

#include "builder/base/error.h"
#include "builder/build.h"
#include "builder/math/random.h"
#include "tracer/accel/tracers.h"
#include "tracer/cli/command_line.h"
#include "tracer/integrators/path/path_tracer.h"

using namespace copse;

namespace {

/// FNV-1a.
class Hash {
 public:
  void add(const void* bytes, std::size_t count) {
    for (std::size_t i = 0; i < count; ++i) value_ = (value_ ^ static_cast<const uint8_t*>(bytes)[i]) * 0x100000001b3u;
  }
  template <class T>
  void add(const std::vector<T>& values) {
    add(values.data(), values.size() * sizeof(T));
  }
  uint64_t value() const { return value_; }

 private:
  uint64_t value_ = 0xcbf29ce484222325u;
};

/// Between random points of the scene's box.
std::vector<Ray> raysIn(const Scene& scene, uint32_t count) {
  const Box box = scene.bounds();
  std::vector<Ray> rays(count);
  for (uint32_t i = 0; i < count; ++i) {
    const auto within = [&](uint32_t end) {
      vec3 point = box.lo;
      for (uint32_t axis = 0; axis < 3; ++axis)
        point[axis] += unitFloat(highWord(randomBits(randomKey(7, i, 0), end, axis))) * (box.hi[axis] - box.lo[axis]);
      return point;
    };
    const vec3 from = within(0);
    rays[i] = {from, 0, within(1) - from, i % 3 == 0 ? 1.0f : 1e30f};
  }
  return rays;
}

struct Options {
  std::string device = "cpu", tracer = "auto";
  std::vector<std::string> scenes, builders;
  uint32_t rays = 20000;
  int size = 64;
};

void printHashes(const Device& device, const Scene& scene, const BuilderEntry& builder, const Options& options) {
  const Parameters parameters = withPreset(builder, {});
  const auto uploaded = uploadScene(device, scene);
  const Bvh bvh = buildBvh(device, trianglesOf(*uploaded), builder, parameters);
  Hash tree, hits, image;
  tree.add(bvh.nodes.toHost(bvh.nodeCount));
  tree.add(bvh.order.toHost(bvh.referenceCount));
  tree.add(bvh.joints.toHost());
  const auto made = makeTracer(device, bvh, trianglesOf(*uploaded), options.tracer);
  const RayTracer& tracer = *made;
  const Buffer<Ray> rays(device, raysIn(scene, options.rays));
  Buffer<Hit> closest(device, options.rays);
  Buffer<uint32_t> occluded(device, options.rays);
  tracer.closest(device, "closest", options.rays, rays.data(), closest.data());
  tracer.any(device, "any", options.rays, rays.data(), occluded.data());
  hits.add(closest.toHost());
  hits.add(occluded.toHost());
  RenderSettings settings;
  settings.width = settings.height = options.size;
  settings.spp = 4;
  image.add(renderPath(device, *uploaded, tracer, scene.cameras.at(0), settings).image.pixels);
  fmt::print("{:16} {:14} tree {:016x} cost {:.17g} hits {:016x} image {:016x}\n", scene.name, builder.name,
             tree.value(), statistics(device, bvh, parameters).sahCost, hits.value(), image.value());
  std::fflush(stdout);
}

void run(const Options& options) {
  const Device device = openDevice(options.device);
  for (const std::string& file : options.scenes) {
    Scene scene = loadScene(file);
    for (const BuilderEntry& builder : builders())
      if (options.builders.empty() || std::ranges::find(options.builders, builder.name) != options.builders.end())
        printHashes(device, scene, builder, options);
  }
}

}  // namespace

int main(int argc, char** argv) {
  cli::Program program("Hashes of trees, hits and images", "hashes");
  Options options;
  program.option("SCENE", options.scenes, "scene files").required();
  program.option("--device", options.device).showDefault();
  program.option("--tracer", options.tracer, "no hash depends on it").showDefault();
  program.option("--builder", options.builders, "all by default");
  program.option("--rays", options.rays, "number of random rays").showDefault();
  program.option("--size", options.size, "pixels per side").showDefault();
  if (const auto status = program.parse(argc, argv)) return *status;
  try {
    run(options);
    return 0;
  } catch (const std::exception& error) {
    fmt::print(stderr, "error: {}\n", error.what());
    return 2;
  }
}
