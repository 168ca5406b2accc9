// Scenes in coordinates of maps, z-up meshes and turned skies from outside: what the commands print and record.
#include <nlohmann/json.hpp>

#include "tests/support/catch.h"
#include "tests/support/devices.h"
#include "tests/support/files.h"
#include "tests/support/program.h"
#include "tests/support/small_scene.h"
#include "tracer/image/image_io.h"

using namespace copse;
using namespace copse::test;

namespace {

using Json = nlohmann::json;

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

const std::string mapObj = "v 499994 200 4649770\nv 500006.125 200.5 4649770\nv 500006 202 4649782\nf 1 2 3\n";

Ran rendered(const Folder& folder, const std::string& scene, const std::string& image,
             const std::vector<std::string>& more) {
  std::vector<std::string> arguments{"render", scene,      "-o",           image,     "--size",  "16x8",  "--spp",
                                     "4",      "--device", deviceOption(), "--quiet", "--stats", "x.json"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return runCopse(folder / "", arguments);
}

}  // namespace

TEST_CASE("info and records say bounds, views and lights in the coordinates of the files") {
  const Folder folder;
  putBytes(folder / "a.obj", mapObj);
  putBytes(folder / "s.toml",
           "[[mesh]]\nfile = 'a.obj'\n[[view]]\neye = [500003.1, 203.0625, 4649784.7]\nat = [500000, 200.5, 4649776]\n"
           "[[light]]\nkind = 'quad'\ncorner = [499999.5, 210, 4649775.5]\nedge_u = [1, 0, 0]\nedge_v = [0, 0, 1]\n"
           "radiance = [1, 1, 1]\n");
  const Ran ran = runCopse(folder / "", {"info", "s.toml"});
  INFO(ran.out);
  CHECK(ran.status == 0);
  CHECK(contains(ran.out, "bounds    499994 200 4649770 to 500006.125 202 4649782, size 12.125 2 12\n"));
  CHECK(contains(ran.out, "eye 500003.1 203.0625 4649784.7  at 500000 200.5 4649776  up 0 1 0"));
  CHECK(contains(ran.out, "corner 499999.5 210 4649775.5  edges 1 0 0, 0 0 1"));
  REQUIRE(rendered(folder, "s.toml", "a.exr", {}).status == 0);
  const Json camera = Json::parse(bytesOf(folder / "x.json"))["image"]["camera"];
  CHECK(camera["eye"][0].get<double>() == Approx(500003.1).epsilon(1e-11));
  CHECK(camera["at"][2] == 4649776);
  const Ran turned = runCopse(folder / "", {"info", "a.obj", "--up", "z"});
  CHECK(contains(turned.out, "bounds    499994 4649770 -202 to 500006.125 4649782 -200, size 12.125 12 2\n"));
}

TEST_CASE("Options --up and --sky-rotation are checked, followed and recorded") {
  const Folder folder;
  putSmallScene(folder);
  REQUIRE(rendered(folder, "small.toml", "sky.exr", {}).status == 0);
  CHECK_FALSE(Json::parse(bytesOf(folder / "x.json"))["scene"].contains("up"));
  putBytes(folder / "a.obj", "v 0 0 0\nv 1 0 0\nv 0 3 0\nf 1 2 3\n");
  const std::string sky = "[[mesh]]\nfile = 'a.obj'\n[[light]]\nkind = 'sky'\nimage = 'sky.exr'\n";
  putBytes(folder / "s.toml", sky);
  putBytes(folder / "t.toml", sky + "rotation = 75\n");
  REQUIRE(rendered(folder, "s.toml", "plain.exr", {}).status == 0);
  REQUIRE(rendered(folder, "s.toml", "a.exr", {"--sky-rotation", "75", "--up", "z"}).status == 0);
  const Json scene = Json::parse(bytesOf(folder / "x.json"))["scene"];
  CHECK(scene["up"] == "z");
  CHECK(scene["sky_rotation"] == 75);
  REQUIRE(rendered(folder, "t.toml", "b.exr", {"--up", "z"}).status == 0);
  REQUIRE(rendered(folder, "t.toml", "c.exr", {"--sky-rotation", "0"}).status == 0);
  const auto image = [&](const char* name) { return readExr(folder / name).pixels; };
  CHECK(image("a.exr") == image("b.exr"));
  CHECK(image("c.exr") == image("plain.exr"));
  CHECK(image("a.exr") != image("plain.exr"));
  const auto refused = [&](const std::vector<std::string>& arguments) {
    const Ran ran = runCopse(folder / "", arguments);
    CHECK(ran.status == 2);
    return ran.err;
  };
  for (const std::string command : {"render", "info", "build"})
    CHECK(contains(refused({command, "s.toml", "--up", "x"}), "error: --up: unknown axis 'x' (expected y or z)"));
  CHECK(contains(refused({"render", "s.toml", "--sky-rotation", "inf"}), "--sky-rotation: expected a finite number"));
  CHECK(contains(refused({"bench", "no.toml", "--up", "Z"}), "error: --up: unknown axis 'Z'"));
}

TEST_CASE("a bench of z-up meshes is recorded as such, and resumed with nothing else") {
  const Folder folder;
  putBytes(folder / "a.obj", "v 0 0 0\nv 1 0 0\nv 0 3 0\nf 1 2 3\n");
  putBytes(folder / "b.toml", "scenes = [\"a.obj\"]\nrepetitions = 1\nspp = []\n[[builder]]\nname = \"lbvh\"\n");
  const auto bench = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments{"bench", "b.toml", "-o", "out", "--device", deviceOption()};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return runCopse(folder / "", arguments);
  };
  const Ran first = bench({"--up", "z"});
  INFO(first.err);
  REQUIRE(first.status == 0);
  CHECK(Json::parse(bytesOf(folder / "out/results.json"))[0]["scene"]["up"] == "z");
  const Ran other = bench({"--resume"});
  CHECK(other.status == 2);
  CHECK(contains(other.err, "a scene's description or mesh has changed"));
  CHECK(bench({"--resume", "--up", "z"}).status == 0);
}
