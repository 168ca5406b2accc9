// tracer/accel: Embree, the baseline, finds what our own trees find, in the same path tracer and through the program;
// and the messages where it is missing or cannot run.

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>

#include "builder/base/error.h"
#include "builder/parallel/timeline.h"
#include "tests/support/builder_checks.h"
#include "tests/support/catch.h"
#include "tests/support/embree.h"
#include "tests/support/path_scenes.h"
#include "tests/support/program.h"
#include "tests/support/real_meshes.h"
#include "tests/support/small_scene.h"
#include "tests/support/trees.h"
#include "tracer/generators/generators.h"
#include "tracer/session/build.h"

using namespace copse;
using namespace copse::test;
using nlohmann::json;

namespace {

const char* const names[] = {"embree-low", "embree-medium", "embree-high"};

std::unique_ptr<TreeTracer> built(const Device& device, const std::string& name, const TrianglesView& triangles) {
  const TreeSource source = findTreeSource(name);
  auto tracer = source.tracer().make(device, triangles, {}, source.ownTree());
  tracer->build(device, {}, triangles);
  return tracer;
}

std::vector<Hit> closest(const Device& device, const RayTracer& tracer, const std::vector<Ray>& rays) {
  std::vector<Hit> hits(rays.size());
  tracer.closest(device, "trace", static_cast<uint32_t>(rays.size()), rays.data(), hits.data());
  return hits;
}

std::vector<uint32_t> any(const Device& device, const RayTracer& tracer, const std::vector<Ray>& rays) {
  std::vector<uint32_t> occluded(rays.size());
  tracer.any(device, "trace", static_cast<uint32_t>(rays.size()), rays.data(), occluded.data());
  return occluded;
}

/// The share of pixels that differ by more than rounding.
double partThatDiffers(const Image& a, const Image& b) {
  std::size_t differ = 0;
  for (std::size_t i = 0; i < a.pixels.size(); ++i)
    differ += glm::length(a.pixels[i] - b.pixels[i]) > 1e-4f * (1 + glm::length(a.pixels[i]));
  return static_cast<double>(differ) / static_cast<double>(a.pixels.size());
}

std::size_t threadsOfThisProcess() {
  std::size_t count = 0;
  for (const auto& task : std::filesystem::directory_iterator("/proc/self/task")) count += !task.path().empty();
  return count;
}

}  // namespace

TEST_CASE("a baseline's name is known in every build, and a build that lacks it says so") {
  for (const char* name : names) {
    if (hasEmbree())
      CHECK(findTreeSource(name).isOwnTree());
    else
      CHECK_THROWS_WITH(findTreeSource(name), Contains(name) && Contains("no Embree"));
  }
  if (!hasEmbree()) CHECK_THROWS_WITH(findTracer("embree"), Contains("no Embree"));
  CHECK_FALSE(findTreeSource("lbvh").isOwnTree());
  CHECK_THROWS_WITH(findTreeSource("embree"), Contains("unknown builder") && Contains("lbvh"));
  for (const BuilderEntry& entry : builders()) CHECK(&findTreeSource(entry.name).builder() == &entry);
}

TEST_CASE("Embree's hits are ours up to rounding") {
  if (!hasEmbree()) return skipTest("no Embree");
  const Device device = openDevice("cpu");
  const TestMesh mesh = makeInput("random", 3000);
  const DeviceMesh onDevice(device, mesh);
  const Bvh bvh = treeOf(device, mesh, "lbvh");
  const auto ours = makeTracer(device, bvh, onDevice.view());
  const std::vector<Ray> rays = raysAround(mesh, 4000, 7);
  const std::vector<Hit> expected = closest(device, *ours, rays);
  const std::vector<uint32_t> stopped = any(device, *ours, rays);
  for (const char* name : names) {
    INFO(name);
    const auto embree = built(device, name, onDevice.view());
    CHECK(embree->bytes() > mesh.count() * sizeof(vec3));
    CHECK(embree->foreignPeakBytes() >= embree->bytes());
    const std::vector<Hit> hits = closest(device, *embree, rays);
    const std::vector<uint32_t> occluded = any(device, *embree, rays);
    std::size_t same = 0, stoppedAlike = 0, hit = 0;
    for (std::size_t i = 0; i < rays.size(); ++i) {
      const Hit &a = hits[i], &b = expected[i];
      hit += b.triangle != Hit::none;
      same += a.triangle == b.triangle && std::abs(a.t - b.t) <= 1e-3f * b.t &&
              std::abs(a.u - b.u) + std::abs(a.v - b.v) < 1e-2f;
      stoppedAlike += occluded[i] == stopped[i];
    }
    CHECK(hit > rays.size() / 2);
    // One ray in seven is aimed at an edge, and half of those at a vertex.
    CHECK(same > rays.size() * 9 / 10);
    CHECK(stoppedAlike > rays.size() * 9 / 10);
  }
}

TEST_CASE("Embree finds nothing in nothing, nor with rays and triangles that are not finite") {
  if (!hasEmbree()) return skipTest("no Embree");
  const Device device = openDevice("cpu");
  const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
  std::vector<Ray> odd{{vec3(nan), 0, vec3(0, 0, 1), FLT_MAX},
                       {vec3(0), 0, vec3(nan), FLT_MAX},
                       {vec3(0), 0, vec3(0), FLT_MAX},
                       {vec3(inf), 0, vec3(1), FLT_MAX},
                       {vec3(0, 0, -1e3f), 0, vec3(0, 0, 1), -1.f},
                       {vec3(0, 0, -1e3f), 2, vec3(0, 0, 1), 1}};
  for (const char* name : names)
    for (const char* kind : {"random", "zero-area", "identical", "coplanar"})
      for (const uint32_t count : {0u, 1u, 500u}) {
        CAPTURE(name, kind, count);
        TestMesh mesh = makeInput(kind, count);
        if (count == 500) mesh.positions[mesh.indices[17][1]] = vec3(nan);
        const DeviceMesh onDevice(device, mesh);
        const auto embree = built(device, name, onDevice.view());
        for (const Hit& hit : closest(device, *embree, odd)) REQUIRE(hit.triangle == Hit::none);
        for (const uint32_t occluded : any(device, *embree, odd)) REQUIRE(occluded == 0);
        std::vector<Ray> rays = raysAround(makeInput(kind, count), 300, 3);
        const std::vector<Hit> hits = closest(device, *embree, rays);
        for (std::size_t i = 0; i < hits.size(); ++i) {
          REQUIRE((hits[i].triangle == Hit::none || hits[i].triangle < count));
          REQUIRE((hits[i].triangle != Hit::none || (hits[i].t == rays[i].tMax && hits[i].u == 0 && hits[i].v == 0)));
          REQUIRE(std::isfinite(hits[i].t + hits[i].u + hits[i].v));
          REQUIRE((count != 500 || hits[i].triangle != 17));
        }
      }
}

TEST_CASE("an image by Embree is ours, and the same on any number of threads") {
  if (!hasEmbree()) return skipTest("no Embree");
  const Device device = openDevice("cpu", 2);
  for (const auto& [generator, triangles] : {std::pair{"cornell", 38u}, std::pair{"atrium", 8000u}}) {
    const Scene scene = findGenerator(generator).generate(triangles, 1);
    const auto uploaded = uploadScene(device, scene);
    const Camera camera = findCamera(scene, "");
    const RenderSettings size = settings(80, 60, 8, 5);
    const Image ours = Traced(device, scene).render(camera, size).image;
    for (const char* name : names) {
      CAPTURE(generator, name);
      const auto embree = built(device, name, trianglesOf(*uploaded));
      const Image image = renderPath(device, *uploaded, *embree, camera, size).image;
      REQUIRE(allFinite(image));
      CHECK(partThatDiffers(image, ours) < 0.05);
      CHECK(meanOf(image).value == Approx(meanOf(ours).value).epsilon(0.005));
      const Device alone = withThreads(device, 1);
      const auto sequential = built(alone, name, trianglesOf(*uploaded));
      CHECK(identical(renderPath(alone, *uploaded, *sequential, camera, size).image, image));
    }
  }
}

TEST_CASE("Embree starts no thread where one was requested") {
  if (!hasEmbree()) return skipTest("no Embree");
  const Device device = openDevice("cpu", 1);
  const TestMesh mesh = makeInput("random", many(100000));
  const DeviceMesh onDevice(device, mesh);
  const std::size_t before = threadsOfThisProcess();
  // TBB below Embree starts threads for others as soon as a device and its limit are gone: hence one, and kept.
  const auto embree = built(device, "embree-medium", onDevice.view());
  CHECK(threadsOfThisProcess() <= before);
}

TEST_CASE("a baseline's record has times and memory, but no parameters and no statistics of our trees") {
  if (!hasEmbree()) return skipTest("no Embree");
  const Device device = openDevice("cpu");
  const TestMesh mesh = makeInput("random", 2000);
  const DeviceMesh onDevice(device, mesh);
  const BuiltTree tree = buildTree(device, onDevice.view(), findTreeSource("embree-medium"), {});
  CHECK(tree.ms > 0);
  REQUIRE(tree.phases.size() == 1);
  CHECK(tree.phases[0].name == "embree");
  RunRecord record;
  describe(device, tree, record);
  const json told = json::parse(toJson(record));
  CHECK(told["builder"]["name"] == "embree-medium");
  CHECK(told["builder"]["parameters"].empty());
  CHECK(told["tracer"] == json{{"name", "embree"}});
  CHECK(told["bvh"]["sah_cost"].is_null());
  CHECK(told["bvh"]["nodes"].is_null());
  CHECK(told["bvh"]["bytes"] > 0);
  Device cuda = device;
  cuda.kind = DeviceKind::cuda;
  CHECK_THROWS_WITH(buildTree(cuda, onDevice.view(), findTreeSource("embree-medium"), {}), Contains("CPU only"));
}

TEST_CASE("the program renders, builds and lists baselines, or says what is missing") {
  Folder folder;
  putSmallScene(folder);
  const auto run = [&](std::vector<std::string> arguments) { return runCopse(folder / "", arguments); };
  const Ran list = run({"list", "builders"});
  CHECK((list.out.find("embree-medium") != std::string::npos) == hasEmbree());
  CHECK((list.out.find("[baseline]") != std::string::npos) == hasEmbree());

  const std::vector<std::string> render{"render", "small.toml", "-o", "x.exr", "--size", "16x12", "--spp", "1"};
  const auto with = [&](std::vector<std::string> more) {
    std::vector<std::string> all = render;
    all.insert(all.end(), more.begin(), more.end());
    return run(all);
  };
  if (!hasEmbree()) {
    const Ran ran = with({"--builder", "embree-low"});
    CHECK(ran.status == 2);
    CHECK(ran.err.find("this build has no Embree") != std::string::npos);
    CHECK_FALSE(std::filesystem::exists(folder / "x.exr"));
    return;
  }
  const Ran refused = with({"--builder", "embree-low", "--device", "cuda"});
  CHECK(refused.status == 2);
  CHECK(refused.err.find("--builder embree-low runs on the CPU only") != std::string::npos);
  for (const auto& [builder, tracer, why] :
       {std::tuple{"embree-low", "wide8", "cannot trace embree-low, which is a tree of embree's own"},
        std::tuple{"lbvh", "embree", "builds its own tree and cannot trace that of lbvh"}}) {
    const Ran ran = with({"--builder", builder, "--tracer", tracer});
    CHECK(ran.status == 2);
    CHECK(ran.err.find(why) != std::string::npos);
  }
  CHECK(with({"--builder", "embree-low", "--tracer", "embree", "--stats", "x.json"}).status == 0);
  CHECK(json::parse(bytesOf(folder / "x.json"))["tracer"]["name"] == "embree");
  std::filesystem::remove(folder / "x.exr");
  for (const char* option : {"--count-traversal", "--end-point-overlap"}) {
    const Ran ran = with({"--builder", "embree-low", option});
    CHECK(ran.status == 2);
    CHECK(ran.err.find("cannot be inspected") != std::string::npos);
  }
  CHECK_FALSE(std::filesystem::exists(folder / "x.exr"));
  for (const char* name : names) {
    const Ran ran = with({"--builder", name, "--stats", "x.json"});
    INFO(ran.err);
    REQUIRE(ran.status == 0);
    CHECK(json::parse(bytesOf(folder / "x.json"))["device"]["kind"] == "cpu");
    const Ran build = run({"build", "small.toml", "--builder", name, "--repeat", "3", "--stats", "b.json"});
    REQUIRE(build.status == 0);
    CHECK(json::parse(bytesOf(folder / "b.json"))["time_ms"]["build_repeats"] == 3);
  }
}
