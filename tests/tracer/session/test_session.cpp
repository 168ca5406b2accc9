// A run in its three steps, by every integrator of the registry; and the record that it leaves.
#include <algorithm>
#include <atomic>
#include <cmath>

#include "builder/base/error.h"
#include "tests/support/catch.h"
#include "tests/support/devices.h"
#include "tests/support/path_scenes.h"
#include "tracer/integrators/phases.h"
#include "tracer/integrators/registry.h"
#include "tracer/integrators/surfaces/channels.h"
#include "tracer/session/render.h"

using namespace copse;
using namespace copse::test;

namespace {

/// A ball over a floor under a lamp and a sky.
Scene ball() {
  SceneMaker maker;
  maker.parallelogram({-3, 0, -3}, {0, 0, 6}, {6, 0, 0}, maker.material({0.6f, 0.5f, 0.4f}));
  maker.sphere({0, 1, 0}, 1, 2, maker.material({0.3f, 0.6f, 0.9f}));
  maker.scene.quads.push_back({{-0.5f, 3, -0.5f}, {1, 0, 0}, {0, 0, 1}, {6, 6, 5}});
  maker.sky({0.3f, 0.4f, 0.5f});
  maker.scene.name = "ball";
  return maker.scene;
}

const Camera ballView = lookAt({1, 2, 5}, {0, 0.8f, 0}, 50);

/// A scene, a tree and an integrator of them; it must not move.
struct Ready {
  Device device;
  LoadedScene loaded;
  BuiltTree tree;
  ReadyIntegrator integrator;

  Ready(const Device& on, const IntegratorEntry& entry, const IntegratorOptions& options = {})
      : device(entry.onCpuOnly ? openDevice("cpu") : on), loaded(load(device, ball, loadFor(entry))) {
    // A builder whose trees every integrator can use.
    if (entry.tree != TreeUse::none) tree = buildTree(device, loaded.triangles(), findTreeSource("kmeans-q1"), {});
    integrator = makeReady(entry, device, loaded, tree, options);
  }
  Ready(const Ready&) = delete;

  Rendered render(const RenderSettings& settings, const Watch& watch = {}) const {
    return copse::render(integrator, device, loaded, tree, ballView, settings, watch);
  }
};

bool isFinite(const Image& image) {
  return std::all_of(image.pixels.begin(), image.pixels.end(),
                     [](const vec3& p) { return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z); });
}

std::vector<std::string> namesOf(const std::vector<Channel>& channels) {
  std::vector<std::string> names;
  for (const Channel& channel : channels) names.push_back(channel.name);
  return names;
}

std::vector<std::string> namesOf(std::span<const char* const> names) { return {names.begin(), names.end()}; }

}  // namespace

TEST_CASE(
    "Every integrator renders a picture with the channels and phases that it declares, and says so in the record") {
  for (const Device& device : devices())
    for (const IntegratorEntry* entry : integrators()) {
      INFO(entry->name);
      const Ready ready(device, *entry);
      const Rendered rendered = ready.render(settings(24, 16, 3, 4));
      const Picture& picture = rendered.picture;
      CHECK((picture.image.width == 24 && picture.image.height == 16));
      CHECK(isFinite(picture.image));
      CHECK(meanOf(picture.image).value != 0);
      CHECK(namesOf(picture.channels) == namesOf(entry->channels));
      for (const Channel& channel : picture.channels) CHECK(channel.values.size() == 24 * 16);

      const RunRecord& record = rendered.record;
      REQUIRE(record.image);
      CHECK(record.image->integrator == entry->name);
      CHECK(record.image->samplesDone == 3);
      REQUIRE(record.rays);
      CHECK(record.rays->primary == 24 * 16 * 3);
      CHECK(record.renderMs > 0);
      CHECK(record.tree.has_value() == (entry->tree != TreeUse::none));
      for (const PhaseTime& phase : record.renderPhases) {
        INFO(phase.name);
        CHECK(std::any_of(entry->phases.begin(), entry->phases.end(), [&](const PhaseName& declared) {
          return phase.name == declared.text && phase.group == declared.group;
        }));
      }
    }
}

TEST_CASE("Every integrator that takes --aov adds normals, albedo and depth to the same image") {
  const Device device = chosenDevice();
  for (const IntegratorEntry* entry : integrators()) {
    if (!entry->takes.aov) continue;
    INFO(entry->name);
    const RenderSettings wanted = settings(24, 16, 3, 4);
    const Rendered plain = Ready(device, *entry).render(wanted), more = Ready(device, *entry, {true}).render(wanted);
    CHECK(identical(plain.picture.image, more.picture.image));
    CHECK(namesOf(more.picture.channels) == namesOf(surfaceChannels));
  }
}

TEST_CASE("Every integrator stops on request, with the image so far") {
  for (const Device& device : devices())
    for (const IntegratorEntry* entry : integrators()) {
      INFO(entry->name);
      const Ready ready(device, *entry);
      // More than a batch on any device; the reference tracer's are rows.
      const RenderSettings endless = settings(24, 16, entry->onCpuOnly ? 1 << 12 : 1 << 20, 2);
      std::atomic<bool> stop{true};
      CHECK(ready.render(endless, {{}, &stop}).record.image->samplesDone == 0);
      stop = false;
      double last = 0;
      const auto stopAtOnce = [&](double done) {
        last = done;
        stop = true;
      };
      const Rendered rendered = ready.render(endless, {stopAtOnce, &stop});
      CHECK((last > 0 && last < 1));
      CHECK((rendered.record.image->samplesDone > 0 && rendered.record.image->samplesDone < endless.spp));
      CHECK(isFinite(rendered.picture.image));
    }
}

TEST_CASE("Every option of an integrator's own says which values it takes") {
  for (const IntegratorEntry* entry : integrators())
    for (const IntegratorOption* option : entry->options) {
      INFO(option->name);
      CHECK(option->min < option->max);
      CHECK(option->accepts(option->min) == option->isInteger);
      CHECK(option->accepts((option->min + option->max) / 2));
      CHECK_FALSE(option->accepts(option->max + 1));
      CHECK_FALSE(option->accepts(NAN));
      const Ready ready(chosenDevice(), *entry, {false, {{option, option->isInteger ? option->max : 10}}});
      CHECK(isFinite(ready.render(settings(8, 8, 1, 1)).picture.image));
    }
}

TEST_CASE("What an integrator cannot use is refused, and so is a name that none has") {
  CHECK_THROWS_WITH(findIntegrator("paths"),
                    "unknown integrator 'paths' (available: path, reference, normals, albedo, "
                    "depth, heatmap, clusters)");
  CHECK_THROWS_AS(checkTree(findIntegrator("clusters"), findTreeSource("lbvh")), InputError);
  CHECK_NOTHROW(checkTree(findIntegrator("clusters"), findTreeSource("kmeans-r1")));
  CHECK_NOTHROW(checkTree(findIntegrator("heatmap"), findTreeSource("lbvh")));
}

TEST_CASE("Rates of rays are over the phases of their group, whatever these are called") {
  RunRecord record;
  CHECK(rayRates(record).all < 0);
  record.rays = RayCounts{1000, 3000, 500};
  record.renderPhases = {{"eye rays", 2, 1, &groups::primaryRays},
                         {"trace bounce", 3, 1, &groups::bounceRays},
                         {"trace shadow", 4, 1, nullptr},
                         {"shade", 9, 1, &groups::shade}};
  const RayRates rates = rayRates(record);
  CHECK(rates.primary == Approx(0.5));
  CHECK(rates.bounce == Approx(1));
  CHECK(rates.shadow < 0);
  CHECK(rates.all == Approx(0.8));
}

TEST_CASE("A scene is loaded for what is done with it") {
  const Device device = chosenDevice();
  const LoadedScene builds = load(device, ball, LoadFor::builds), renders = load(device, ball, LoadFor::renders),
                    reference = load(device, ball, LoadFor::reference);
  CHECK(builds.triangles().count == builds.scene.triangles.size());
  CHECK_FALSE(builds.onDevice);
  CHECK(renders.triangles().count == builds.triangles().count);
  CHECK(renders.onDevice);
  CHECK(reference.triangles().count == 0);
  const RunRecord record = recordOf(device, builds);
  CHECK((record.sceneName == "ball" && record.triangles == builds.scene.triangles.size() && record.emitters == 2));
}
