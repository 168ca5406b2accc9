// tracer/integrators/path: the image depends on scene, view and settings alone; counts, phases, and input that is odd
// or wrong.
#include <cmath>
#include <set>

#include "builder/base/error.h"
#include "builder/parallel/memory_traffic.h"
#include "builder/parallel/timeline.h"
#include "tests/support/catch.h"
#include "tests/support/devices.h"
#include "tests/support/path_scenes.h"
#include "tests/support/textures.h"
#include "tracer/integrators/pinhole.h"
#include "tracer/integrators/pixel_order.h"

using namespace copse;
using namespace copse::test;

namespace {

/// A hall with all that the path tracer knows: textures, a quad, emitting triangles on both sides of which something
/// lies, a sky through a missing wall, and a ball.
Scene everything() {
  SceneMaker maker;
  const uint32_t white = maker.material({0.7f, 0.7f, 0.7f});
  maker.box({-2, 0, -2}, {2, 3, 2}, white, 5);
  const uint32_t textured = maker.material({0.2f, 0.2f, 0.9f});
  maker.scene.materials[textured].texture = 0;
  maker.scene.textures.push_back(textureOf({2, 2, {{0.9f, 0.1f, 0.1f}, {0.1f, 0.9f, 0.1f}, vec3(0.2f), vec3(0.8f)}}));
  maker.parallelogram({-1.5f, 0.01f, -1.5f}, {0, 0, 3}, {3, 0, 0}, textured);
  maker.sphere({0.6f, 0.8f, 0}, 0.7f, 2, maker.material({0.3f, 0.6f, 0.9f}));
  maker.triangle({-1.5f, 1, -1}, {-1.2f, 1.8f, -1}, {-0.9f, 1, -0.8f}, maker.material(vec3(0.1f), {3, 2, 1}));
  maker.scene.quads.push_back({{-0.5f, 2.9f, -0.5f}, {1, 0, 0}, {0, 0, 1}, {6, 6, 5}});
  Image sky{8, 4, std::vector<vec3>(32, vec3(0.3f, 0.4f, 0.5f))};
  sky.at(2, 1) = {20, 18, 15};
  maker.scene.sky = SkyLight{vec3(0), "sky", sky};
  return maker.scene;
}

const Camera hallView = lookAt({0.3f, 1.4f, 4.5f}, {0, 1.2f, 0}, 45);

std::vector<std::string> phaseNames(Timeline& timeline) {
  std::vector<std::string> names;
  for (const PhaseTime& phase : timeline.phases()) names.push_back(phase.name);
  return names;
}

}  // namespace

TEST_CASE("The image is the same bit for bit for any number of threads and any size of the queues") {
  const Scene scene = everything();
  const RenderSettings wanted = settings(37, 23, 5, 6, 42);
  const Image first = Traced(openDevice("cpu", 1), scene).render(hallView, wanted).image;
  REQUIRE(meanOf(first).value > 0.01);
  for (const int threads : {1, 2, 5}) {
    const Traced traced(openDevice("cpu", threads), scene);
    for (const uint32_t queue : {0u, 1u, 64u, 700u, 37u * 23u, 2000u, 100000u}) {
      INFO(threads << " threads, queue of " << queue);
      if (queue == 1 && threads > 1) continue;
      const PathResult result = traced.render(hallView, wanted, {queue, true});
      CHECK(identical(result.image, first));
      CHECK(result.samplesDone == 5);
    }
  }
}

TEST_CASE("Every device renders the same image up to rounding") {
  const Scene scene = everything();
  const Image cpu = Traced(openDevice("cpu"), scene).render(hallView, settings(64, 48, 8, 5)).image;
  for (const Device& device : devices()) {
    const Image other = Traced(device, scene).render(hallView, settings(64, 48, 8, 5)).image;
    CHECK(allFinite(other));
    for (int k = 0; k < 3; ++k) CHECK(meanOf(other, k).value == Approx(meanOf(cpu, k).value).epsilon(0.01));
  }
}

TEST_CASE("A bounce costs one wait of the host and no allocation") {
  for (const Device& device : devices()) {
    const Traced traced(device, everything());
    const auto trafficOf = [&](int maxDepth) {
      const MemoryTraffic before = memoryTraffic();
      traced.render(hallView, settings(40, 30, 2, maxDepth));
      const MemoryTraffic after = memoryTraffic();
      return MemoryTraffic{after.waits - before.waits, after.allocations - before.allocations};
    };
    const MemoryTraffic one = trafficOf(1), six = trafficOf(6);
    CHECK(one.waits == 2);  // The second is for the image.
    CHECK(six.waits == one.waits + 5);
    CHECK(six.allocations == one.allocations);
  }
}

TEST_CASE("Another seed gives another image, the same seed the same") {
  const Traced traced(chosenDevice(), everything());
  const Image a = traced.render(hallView, settings(20, 10, 2, 4, 1)).image;
  CHECK(identical(a, traced.render(hallView, settings(20, 10, 2, 4, 1)).image));
  CHECK_FALSE(identical(a, traced.render(hallView, settings(20, 10, 2, 4, 2)).image));
}

TEST_CASE("A render that is stopped leaves the samples done, each pixel divided by its own number") {
  const Traced traced(chosenDevice(), everything());
  const uint32_t pixels = 24 * 16;
  const Image one = traced.render(hallView, settings(24, 16, 1, 4)).image;
  const Image two = traced.render(hallView, settings(24, 16, 2, 4)).image;
  std::atomic<bool> stop{false};
  double reported = 0;
  Watch watch;
  watch.stop = &stop;
  watch.progress = [&](double done) {
    CHECK(done > reported);
    reported = done;
    stop = true;
  };
  const PathResult result = traced.render(hallView, settings(24, 16, 8, 4), {pixels + pixels / 2, true}, watch);
  CHECK(result.samplesDone == 1.5);
  CHECK(reported == Approx(1.5 / 8));
  CHECK(result.rays.primary == pixels + pixels / 2);
  const Device device = chosenDevice();
  const PixelOrder order(device, 24, 16);
  std::vector<uint32_t> pixelAt(pixels);
  copyToHost(device, pixelAt.data(), order.pixelAt(), pixels * sizeof(uint32_t));
  for (uint32_t place = 0; place < pixels; ++place) {
    const uint32_t i = pixelAt[place];
    INFO("pixel " << i);
    REQUIRE(result.image.pixels[i] == (place < pixels / 2 ? two : one).pixels[i]);
  }
  const PathResult none = traced.render(hallView, settings(24, 16, 8, 4), {}, watch);
  CHECK(none.samplesDone == 0);
  CHECK(none.rays.primary == 0);
  CHECK(meanOf(none.image).value == 0);
}

TEST_CASE("Progress rises to 1") {
  const Traced traced(chosenDevice(), everything());
  std::vector<double> reports;
  Watch watch;
  watch.progress = [&](double done) { reports.push_back(done); };
  traced.render(hallView, settings(16, 16, 4, 2), {100, true}, watch);
  REQUIRE(reports.size() == 11);
  CHECK(std::is_sorted(reports.begin(), reports.end()));
  CHECK(reports.back() == 1);
}

TEST_CASE("A hundred thousand samples per pixel add up without loss") {
  SceneMaker maker;
  maker.sky({0.1f, 0.7f, 3.3f});
  for (const Device& device : devices()) {
    const Image image = Traced(device, maker.scene).render(hallView, settings(2, 1, 100000, 1)).image;
    for (int k = 0; k < 3; ++k) CHECK(image.at(1, 0)[k] == Approx(maker.scene.sky->radiance[k]).epsilon(1e-6));
  }
}

TEST_CASE("The path tracer works with any tracer of rays") {
  for (const Device& device : devices()) {
    const Traced traced(device, everything());
    const auto all = bruteForce(traced.scene());
    const RenderSettings wanted = settings(32, 24, 4, 4);
    const Image tree = traced.render(hallView, wanted).image;
    const Image brute = renderPath(device, traced.scene(), *all, hallView, wanted).image;
    int differ = 0;
    for (std::size_t i = 0; i < tree.pixels.size(); ++i)
      differ += largest(glm::abs(tree.pixels[i] - brute.pixels[i])) > 1e-3f * (1 + largest(tree.pixels[i]));
    CHECK(differ <= 8);
  }
}

TEST_CASE("Rays are counted as they are traced, and phases carry the fixed names") {
  for (const Device& plain : devices()) {
    // A floor that fills the view under a constant sky: every hit has its light samples and one bounce, which leaves.
    SceneMaker maker;
    maker.parallelogram({-100, 0, -100}, {0, 0, 200}, {200, 0, 0}, maker.material(vec3(0.5f)));
    maker.sky(vec3(1));
    const Traced traced(plain, maker.scene);
    Timeline timeline(plain);
    RenderSettings wanted = settings(40, 30, 3, 4);
    wanted.lightSamples = 3;
    const PathResult result =
        renderPath(plain.recording(timeline), traced.scene(), traced.tracer(), lookAt({0, 5, 0}, {0.1f, 0, 0}), wanted);
    CHECK(result.rays.primary == 40 * 30 * 3);
    CHECK(result.rays.shadow == 40 * 30 * 3 * 3);
    CHECK(result.rays.bounce == 40 * 30 * 3);
    CHECK(phaseNames(timeline) ==
          std::vector<std::string>{"generate", "trace primary", "shade", "trace shadow", "accumulate", "trace bounce"});

    // The light faces away from the floor: no sample needs a ray.
    SceneMaker away;
    away.parallelogram({-100, 0, -100}, {0, 0, 200}, {200, 0, 0}, away.material(vec3(0.5f)));
    away.scene.quads.push_back({{-1, 3, -1}, {0, 0, 2}, {2, 0, 0}, vec3(5)});
    const PathResult dark = Traced(plain, away.scene).render(lookAt({0, 5, 0}, {0.1f, 0, 0}), wanted);
    CHECK(dark.rays.shadow == 0);
    CHECK(meanOf(dark.image).value == 0);
  }
}

TEST_CASE("Scenes of no triangle and of one triangle render, and without light the image is black") {
  for (const Device& device : devices()) {
    SceneMaker nothing;
    CHECK(meanOf(Traced(device, nothing.scene).render(hallView, settings(8, 8, 2, 4)).image).value == 0);
    nothing.sky(vec3(0.25f));
    CHECK(meanOf(Traced(device, nothing.scene).render(hallView, settings(8, 8, 2, 4)).image).value == 0.25);
    nothing.scene.quads.push_back({{-1, 3, -1}, {1, 0, 0}, {0, 0, 1}, vec3(5)});
    CHECK(meanOf(Traced(device, nothing.scene).render(hallView, settings(8, 8, 2, 4)).image).value == 0.25);

    SceneMaker one;
    one.triangle({-1, 0, 0}, {1, 0, 0}, {0, 2, 0}, one.material(vec3(1)));
    const PathResult dark = Traced(device, one.scene).render(hallView, settings(32, 32, 2, 4));
    CHECK(meanOf(dark.image).value == 0);
    CHECK(dark.rays.shadow == 0);
    one.sky(vec3(1));
    const Image lit = Traced(device, one.scene).render(hallView, settings(32, 32, 2, 4)).image;
    CHECK(meanOf(lit).value == Approx(1).epsilon(1e-5));
  }
}

TEST_CASE("Lights without power are never chosen, and lights that are not numbers are no lights") {
  SceneMaker maker;
  maker.parallelogram({-5, 0, -5}, {0, 0, 10}, {10, 0, 0}, maker.material(vec3(0.5f)));
  maker.triangle({0, 1, 0}, {0, 1, 0}, {0, 1, 0}, maker.material(vec3(0), vec3(9)));
  maker.triangle({0, 1, 0}, {1, 1, 0}, {2, 1, 0}, maker.material(vec3(0), vec3(NAN, INFINITY, -1)));
  maker.scene.quads.push_back({{-1, 3, -1}, {1, 0, 0}, {0, 0, 1}, vec3(0)});
  maker.scene.quads.push_back({{-1, 3, -1}, {1, 0, 0}, {2, 0, 0}, vec3(7)});
  maker.scene.quads.push_back({{-1, 3, -1}, {1, 0, 0}, {0, 0, 1}, vec3(-4, NAN, -INFINITY)});
  maker.sky(vec3(0));
  for (const Device& device : devices()) {
    const PathResult result = Traced(device, maker.scene).render(hallView, settings(16, 16, 4, 4));
    CHECK(meanOf(result.image).value == 0);
    CHECK(result.rays.shadow == 0);
    SceneMaker lit = maker;
    lit.sky(vec3(1, NAN, -1));
    const Image image = Traced(device, lit.scene).render(hallView, settings(16, 16, 4, 4)).image;
    CHECK(allFinite(image));
    CHECK(meanOf(image, 0).value > 0.2);
    CHECK(meanOf(image, 1).value == 0);
  }
}

TEST_CASE("A view from inside a wall, from a face, an edge or a corner gives finite pixels") {
  SceneMaker maker;
  maker.scene = everything();
  maker.box({-0.5f, 1, 1}, {0.5f, 2, 2}, maker.material(vec3(0.8f), vec3(0.5f)));
  for (const Device& device : devices()) {
    const Traced traced(device, maker.scene);
    for (const vec3 eye : {vec3(0, 1.5f, 1.5f), vec3(0, 1.5f, 1), vec3(-0.5f, 2, 1.5f), vec3(0.5f, 1, 1), vec3(0, 0, 0),
                           vec3(-2, 3, -2), vec3(0, -7, 0)}) {
      for (const vec3 at : {eye + vec3(0, 0, 1), eye + vec3(1, 0, 0), eye + vec3(0, 1, 0), eye - vec3(1, 2, 3)}) {
        const Image image = traced.render(lookAt(eye, at, 90), settings(12, 12, 2, 5)).image;
        CHECK(allFinite(image));
      }
    }
  }
}

TEST_CASE("Degenerate triangles and texture coordinates that are not numbers give finite pixels") {
  SceneMaker maker;
  maker.scene = everything();
  maker.triangle({0, 1, 0}, {0, 1, 0}, {0, 1, 0}, 0);
  maker.triangle({0, 1, 0}, {1, 1, 0}, {2, 1, 0}, 0);
  maker.triangle({0, 1, 0}, {1e-20f, 1, 0}, {0, 1, 1e-20f}, 0);
  maker.scene.uvs[1] = {NAN, INFINITY};
  maker.scene.uvs[2] = {1e30f, -1e30f};
  const Image image = Traced(chosenDevice(), maker.scene).render(hallView, settings(48, 48, 4, 5)).image;
  CHECK(allFinite(image));
}

TEST_CASE("Invalid settings and views are refused with a reason") {
  const Traced traced(chosenDevice(), everything());
  const auto refused = [&](const RenderSettings& wanted, const Camera& camera, const char* reason) {
    INFO(reason);
    CHECK_THROWS_WITH(traced.render(camera, wanted), Contains(reason));
    CHECK_THROWS_AS(traced.render(camera, wanted), InputError);
  };
  refused(settings(0, 8, 1, 1), hallView, "width");
  refused(settings(8, -1, 1, 1), hallView, "height");
  refused(settings(8, 8193, 1, 1), hallView, "height");
  refused(settings(8, 8, 0, 1), hallView, "spp");
  refused(settings(8, 8, 1, -1), hallView, "depth");
  RenderSettings noLight = settings(8, 8, 1, 1);
  noLight.lightSamples = 0;
  refused(noLight, hallView, "light samples");
  refused(settings(8, 8, 1, 1), lookAt({1, 1, 1}, {1, 1, 1}), "same point");
  refused(settings(8, 8, 1, 1), lookAt({1, 1, 1}, {0, 1, 1}, 180), "vfov");
  refused(settings(8, 8, 1, 1), lookAt({1, NAN, 1}, {0, 1, 1}), "finite");

  Scene broken = everything();
  broken.triangles[3].y = 1u << 30;
  CHECK_THROWS_AS(uploadScene(chosenDevice(), broken), InputError);
  broken = everything();
  broken.materialOf[3] = 99;
  CHECK_THROWS_AS(uploadScene(chosenDevice(), broken), InputError);
  broken = everything();
  broken.uvTriangles[3].z = 99;
  CHECK_THROWS_AS(uploadScene(chosenDevice(), broken), InputError);
}

TEST_CASE("The camera's angle is the whole vertical one, row 0 is the top, and x runs to the right") {
  Camera camera = lookAt({1, 2, 3}, {1, 2, -7}, 60);
  const Pinhole pinhole = makePinhole(camera, 200, 100);
  const auto direction = [&](float x, float y) { return pinhole.direction(x, y); };
  CHECK(glm::length(direction(100, 50) - vec3(0, 0, -1)) < 1e-6f);
  CHECK(direction(100, 0).y == Approx(0.5f));
  CHECK(direction(100, 100).y == Approx(-0.5f));
  const vec3 right = direction(200, 50);
  CHECK(right.x / -right.z == Approx(2 * std::tan(M_PI / 6)));
  camera.up = {0, 0, -1};  // Along the view: another axis replaces it.
  const vec3 centre = makePinhole(camera, 200, 100).direction(100, 50);
  CHECK(glm::length(centre - vec3(0, 0, -1)) < 1e-6f);
}
