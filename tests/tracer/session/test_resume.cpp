// Going on from an EXR: what the file must say, what must be the same, and sums to the last bit.
#include "tracer/session/resume.h"

#include <cstring>
#include <functional>

#include "builder/base/error.h"
#include "tests/support/catch.h"
#include "tests/support/files.h"
#include "tests/support/path_scenes.h"
#include "tracer/integrators/registry.h"
#include "tracer/session/render.h"
#include "tracer/session/scene_hash.h"

using namespace copse;
using namespace copse::test;

namespace {

Scene floorAndSky() {
  SceneMaker maker;
  maker.parallelogram({-3, 0, -3}, {0, 0, 6}, {6, 0, 0}, maker.material({0.6f, 0.5f, 0.4f}));
  maker.sphere({0, 1, 0}, 1, 1, maker.material({0.3f, 0.6f, 0.9f}));
  maker.sky({0.3f, 0.4f, 0.5f});
  maker.scene.name = "floor";
  return maker.scene;
}

const Camera view = lookAt({1.1f, 2, 5}, {0, 0.8f, 0}, 50);

/// A render of the scene, and its file.
struct Made {
  Folder folder;
  LoadedScene loaded;
  BuiltTree tree;
  Rendered rendered;
  RenderSettings settings = test::settings(9, 7, 5, 4, 11);

  explicit Made(int spp, bool keepsSums = true) {
    const Device device = openDevice("cpu");
    settings.spp = spp;
    loaded = load(device, floorAndSky, LoadFor::renders);
    tree = buildTree(device, loaded.triangles(), findTreeSource("lbvh"), {});
    const ReadyIntegrator ready = makeReady(findIntegrator("path"), device, loaded, tree);
    const FilmState none;
    rendered = render(ready, device, loaded, tree, view, settings, {}, &none);
    write(toJson(rendered.record), keepsSums);
  }
  void write(const std::string& record, bool keepsSums = true) const {
    writeExr(file(), rendered.picture.image, {{"copse", record}},
             keepsSums ? filmChannels(*rendered.picture.film) : std::vector<Channel>());
  }
  std::string file() const { return folder / "x.exr"; }
};

bool sameBytes(const std::vector<vec3>& a, const std::vector<vec3>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(vec3)) == 0;
}

std::string errorOf(const std::function<void()>& call) {
  try {
    call();
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

}  // namespace

TEST_CASE("An EXR gives back the sums of its film to the last bit, from channels or from means of a power of two") {
  for (const auto& [spp, keepsSums] : {std::pair{5, true}, {8, true}, {8, false}, {1, false}, {1030, true}}) {
    INFO(spp << " samples, sums kept: " << keepsSums);
    const Made made(spp, keepsSums);
    const EarlierRender earlier = readEarlierRender(made.file());
    CHECK(earlier.samples == static_cast<uint64_t>(spp) * 9 * 7);
    CHECK(earlier.hasSums == keepsSums);
    CHECK_NOTHROW(checkSameRender(earlier, "path", made.settings, &view, &made.loaded.hash));
    const FilmState film = readFilm(earlier);
    CHECK(film.samples == earlier.samples);
    CHECK(sameBytes(film.sums, made.rendered.picture.film->sums));
    CHECK(sameBytes(film.lost, made.rendered.picture.film->lost));
  }
}

TEST_CASE("Means that do not give back their sums are refused") {
  const Made five(5, false);
  CHECK_THAT(errorOf([&] { readFilm(readEarlierRender(five.file())); }),
             Contains("x.exr: cannot be resumed: of 5 samples per pixel it has the means"));
  Made eight(8, false);
  eight.rendered.picture.image.pixels[3].y = 1e-40f;
  eight.write(toJson(eight.rendered.record), false);
  CHECK_THAT(errorOf([&] { readFilm(readEarlierRender(eight.file())); }), Contains("too small"));
}

TEST_CASE("A render that is not the same is refused, and all that differs is said") {
  const Made made(5);
  const EarlierRender earlier = readEarlierRender(made.file());
  const auto refusal = [&](const std::function<void(RenderSettings&, Camera&, uint64_t&, std::string&)>& change) {
    RenderSettings settings = made.settings;
    Camera camera = view;
    uint64_t hash = made.loaded.hash;
    std::string integrator = "path";
    change(settings, camera, hash, integrator);
    return errorOf([&] { checkSameRender(earlier, integrator, settings, &camera, &hash); });
  };
  using S = RenderSettings&;
  using C = Camera&;
  using H = uint64_t&;
  using I = std::string&;
  CHECK(refusal([](S s, C, H, I) { s.spp = 50; }) == "");
  CHECK_THAT(refusal([](S s, C, H, I) { s.seed = 12; }),
             EndsWith("x.exr: cannot be resumed: it was made with --seed 11 (now 12)"));
  CHECK_THAT(refusal([](S s, C, H, I) { s.width = 10; }), EndsWith("with --size 9x7 (now 10x7)"));
  CHECK_THAT(refusal([](S s, C, H, I) { s.maxDepth = 3; }), EndsWith("with --max-depth 4 (now 3)"));
  CHECK_THAT(refusal([](S s, C, H, I) { s.lightSamples = 1; }), EndsWith("with --light-samples 2 (now 1)"));
  CHECK_THAT(refusal([](S, C, H, I i) { i = "depth"; }), EndsWith("with --integrator path (now depth)"));
  CHECK_THAT(refusal([](S, C c, H, I) { c.eye.x = 2; }), EndsWith("eye [1.1, 2, 5] (now [2, 2, 5])"));
  CHECK_THAT(refusal([](S, C c, H, I) { c.at.y = 0; }), Contains("at ["));
  CHECK_THAT(refusal([](S, C c, H, I) { c.up = {1, 0, 0}; }), Contains("up ["));
  CHECK_THAT(refusal([](S, C c, H, I) { c.vfov = 51; }), EndsWith("vfov 50 (now 51)"));
  CHECK_THAT(refusal([](S, C, H h, I) { h += 1; }), Contains("another scene, or another state of its files"));
  CHECK_THAT(refusal([](S s, C c, H, I) { s.seed = 12, c.vfov = 51; }),
             Contains("--seed 11 (now 12)") && Contains("vfov 50 (now 51)"));
  CHECK(errorOf([&] { checkSameTracer(earlier, "binary"); }) == "");
  EarlierRender byEmbree = earlier;
  byEmbree.tracer = "embree";
  for (const TracerEntry& tracer : tracers())
    if (tracer.name == byEmbree.tracer)
      CHECK_THAT(errorOf([&] { checkSameTracer(byEmbree, "binary"); }), EndsWith("with tracer embree (now binary)"));
}

TEST_CASE("A file of another program, and a record that lacks something or lies, is refused") {
  const Made made(5);
  const auto refusal = [&](const std::string& record) {
    made.write(record);
    return errorOf([&] { readFilm(readEarlierRender(made.file())); });
  };
  std::string record = toJson(made.rendered.record);
  REQUIRE(refusal(record) == "");
  const auto without = [&](const std::string& from, const std::string& to) {
    std::string changed = record;
    const std::size_t at = changed.find(from);
    REQUIRE(at != std::string::npos);
    return refusal(changed.replace(at, from.size(), to));
  };
  CHECK_THAT(refusal("no JSON"), EndsWith("cannot be resumed: its record is not JSON"));
  CHECK_THAT(without("\"hash\"", "\"hush\""), EndsWith("its record lacks /scene/hash, as those of older versions do"));
  CHECK_THAT(without("\"camera\"", "\"c\""), Contains("lacks /image/camera/"));
  CHECK_THAT(without("\"seed\": 11", "\"seed\": -1"), Contains("record's /image/seed: expected an integer"));
  CHECK_THAT(without("\"width\": 9", "\"width\": 8"), EndsWith("its record is not that of its image"));
  CHECK_THAT(without("\"samples_done\": 5.0", "\"samples_done\": 1e300"), EndsWith("is not that of its image"));
  CHECK_THAT(without("\"samples_done\": 5.0", "\"samples_done\": 2000"), Contains("no channel lost.R"));
  writeExr(made.file(), made.rendered.picture.image, {});
  CHECK_THAT(errorOf([&] { readEarlierRender(made.file()); }), EndsWith("so another program wrote it"));
  putBytes(made.file(), "no EXR");
  CHECK_THAT(errorOf([&] { readEarlierRender(made.file()); }), Contains("x.exr: "));
}

TEST_CASE("The figures of earlier runs are added up and kept apart") {
  Made made(5);
  RunRecord& record = made.rendered.record;
  const double renderMs = record.renderMs;
  record.earlier = EarlierRuns{2, 3, 10, 20, 30, {7, 8, 9}};
  made.write(toJson(record));
  const EarlierRuns runs = readEarlierRender(made.file()).runs;
  CHECK(runs.runs == 3);
  CHECK(runs.samplesDone == 5);
  CHECK(runs.renderMs == Approx(renderMs + 30));
  CHECK(runs.buildMs == Approx(record.buildMs + 20));
  CHECK(runs.loadMs == Approx(record.loadMs + 10));
  CHECK(runs.rays.primary == record.rays->primary + 7);
  CHECK(runs.rays.shadow == record.rays->shadow + 9);
}

TEST_CASE("A scene's hash tells apart all that its image depends on, and no names") {
  const uint64_t plain = sceneHash(floorAndSky());
  CHECK(plain == sceneHash(floorAndSky()));
  const auto changed = [&](const std::function<void(Scene&)>& change) {
    Scene scene = floorAndSky();
    change(scene);
    return sceneHash(scene) != plain;
  };
  CHECK_FALSE(changed([](Scene& s) { s.name = s.file = s.materials[0].name = "other"; }));
  CHECK(changed([](Scene& s) { s.positions[1].x += 1e-6f; }));
  CHECK(changed([](Scene& s) { std::swap(s.triangles[0], s.triangles[1]); }));
  CHECK(changed([](Scene& s) { s.materialOf[0] = 1; }));
  CHECK(changed([](Scene& s) { s.uvs[0].x = 0.5f; }));
  CHECK(changed([](Scene& s) { s.materials[0].kd.x = 0.1f; }));
  CHECK(changed([](Scene& s) { s.materials[0].ke.x = 0.1f; }));
  CHECK(changed([](Scene& s) { s.materials[0].texture = 0; }));
  CHECK(changed([](Scene& s) { s.sky->radiance.x = 1; }));
  CHECK(changed([](Scene& s) { s.sky.reset(); }));
  CHECK(changed([](Scene& s) { s.quads.push_back({{0, 3, 0}, {1, 0, 0}, {0, 0, 1}, {6, 6, 5}}); }));
  CHECK(changed([](Scene& s) { s.sky->image = {1, 1, {vec3(1)}}; }));
}
