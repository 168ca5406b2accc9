// The integrators that do not render light, and further channels of an image: files, records, refusals.
#include <cmath>
#include <nlohmann/json.hpp>

#include "tests/support/catch.h"
#include "tests/support/devices.h"
#include "tests/support/files.h"
#include "tests/support/program.h"
#include "tests/support/small_scene.h"
#include "tracer/image/image_io.h"
#include "tracer/integrators/clusters/clusters.h"

using namespace copse;
using namespace copse::test;
using Json = nlohmann::json;

namespace {

Ran render(const Folder& folder, const std::vector<std::string>& more) {
  std::vector<std::string> arguments{"render", "small.toml", "--size",   "24x16",
                                     "--spp",  "2",          "--device", deviceOption()};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return runCopse(folder / "", arguments);
}

Json recordOf(const std::string& exr) {
  std::map<std::string, std::string> attributes;
  readExr(exr, &attributes);
  return Json::parse(attributes.at("copse"));
}

bool hasChannel(const std::string& exr, const std::string& name) {
  try {
    readExrChannel(exr, name);
    return true;
  } catch (const std::exception&) {
    return false;
  }
}

void checkRefused(const Folder& folder, const std::vector<std::string>& more, const std::string& why) {
  const Ran ran = render(folder, more);
  INFO(ran.err);
  CHECK(ran.status == 2);
  CHECK_THAT(ran.err, Contains(why));
}

}  // namespace

TEST_CASE("each integrator has its own default file, channels and record", "[medium]") {
  Folder folder;
  putSmallScene(folder);
  const std::vector<std::string> all{"N.X",      "N.Y", "N.Z",   "albedo.R",  "albedo.G",
                                     "albedo.B", "Z",   "nodes", "triangles", "cluster"};
  const std::map<std::string, std::vector<std::string>> own{{"normals", {"N.X", "N.Y", "N.Z"}},
                                                            {"albedo", {"albedo.R", "albedo.G", "albedo.B"}},
                                                            {"depth", {"Z"}},
                                                            {"heatmap", {"nodes", "triangles"}},
                                                            {"clusters", {"cluster"}}};
  for (const auto& [integrator, channels] : own) {
    INFO(integrator);
    const Ran ran = render(folder, {"--integrator", integrator});
    INFO(ran.err);
    REQUIRE(ran.status == 0);
    CHECK_THAT(ran.out, Contains("time to image"));
    const std::string exr = folder / ("out/small-" + integrator + ".exr");
    for (const std::string& channel : all) {
      INFO(channel);
      CHECK(hasChannel(exr, channel) == (std::ranges::find(channels, channel) != channels.end()));
    }
    CHECK(std::filesystem::exists(folder / ("out/small-" + integrator + ".png")) == hasOpenImageIO());
    const Json record = recordOf(exr);
    CHECK(record["image"]["integrator"] == integrator);
    CHECK(record["image"]["samples_done"] == 2.0);
    CHECK(record["rays"] == Json{{"primary", 24 * 16 * 2}, {"bounce", 0}, {"shadow", 0}});
    CHECK(record["time_ms"]["total"].get<double>() ==
          Approx(record["time_ms"]["build"].get<double>() + record["time_ms"]["render"].get<double>()));
    const Image image = readExr(exr);
    double sum = 0;
    for (const vec3& pixel : image.pixels) sum += std::abs(pixel.x) + std::abs(pixel.y) + std::abs(pixel.z);
    CHECK(sum > 0);
  }
  CHECK_FALSE(std::filesystem::exists(folder / "out/small.exr"));
}

TEST_CASE("the flag --aov adds channels to the same light, and to the pictures of surfaces") {
  Folder folder;
  putSmallScene(folder);
  REQUIRE(render(folder, {"-o", "plain.exr", "--quiet"}).status == 0);
  const Ran ran = render(folder, {"-o", "aov.exr", "--aov", "--quiet"});
  REQUIRE(ran.status == 0);
  CHECK(ran.err.empty());
  const Image plain = readExr(folder / "plain.exr"), aov = readExr(folder / "aov.exr");
  CHECK(std::memcmp(plain.pixels.data(), aov.pixels.data(), plain.pixels.size() * sizeof(vec3)) == 0);
  CHECK(recordOf(folder / "aov.exr")["time_ms"]["render_phases"].contains("surfaces"));
  CHECK_FALSE(recordOf(folder / "plain.exr")["time_ms"]["render_phases"].contains("surfaces"));

  REQUIRE(render(folder, {"-o", "n.exr", "--integrator", "normals", "--aov"}).status == 0);
  REQUIRE(render(folder, {"-o", "z.exr", "--integrator", "depth"}).status == 0);
  for (const std::string channel : {"N.X", "N.Y", "N.Z", "albedo.R", "albedo.G", "albedo.B", "Z"})
    CHECK(readExrChannel(folder / "aov.exr", channel) == readExrChannel(folder / "n.exr", channel));
  CHECK(readExrChannel(folder / "aov.exr", "Z") == readExrChannel(folder / "z.exr", "Z"));
  const std::vector<float> x = readExrChannel(folder / "aov.exr", "N.X");
  const Image normals = readExr(folder / "n.exr");
  bool negative = false, positive = false;
  for (std::size_t i = 0; i < x.size(); ++i) {
    CHECK(normals.pixels[i].x == x[i]);
    negative |= x[i] < 0;
    positive |= x[i] > 0;
  }
  CHECK((negative && positive));

  const Ran compared = runCopse(folder / "", {"compare", "plain.exr", "aov.exr", "--max-rmse", "0"});
  CHECK(compared.status == 0);
}

TEST_CASE("depth is 0 in the picture and infinite in Z where nothing is seen, so that pictures can be compared") {
  Folder folder;
  putSmallScene(folder);
  putBytes(folder / "away.toml",
           "[[mesh]]\nfile = \"small.obj\"\n[[view]]\nname = \"v\"\neye = [0, 1, 9]\nat = [0, 1, 0]\nup = [0, 1, 0]\n"
           "vfov = 60\n");
  REQUIRE(runCopse(folder / "", {"render", "away.toml", "-o", "z.exr", "--size", "24x16", "--device", deviceOption(),
                                 "--integrator", "depth"})
              .status == 0);
  const Image image = readExr(folder / "z.exr");
  const std::vector<float> z = readExrChannel(folder / "z.exr", "Z");
  CHECK((std::isinf(z[0]) && image.pixels[0] == vec3(0)));
  const std::size_t middle = 8 * 24 + 12;
  CHECK((z[middle] > 8 && z[middle] < 10.5f && image.pixels[middle] == vec3(z[middle])));
  CHECK(runCopse(folder / "", {"compare", "z.exr", "z.exr", "--max-rmse", "0"}).status == 0);
}

TEST_CASE("a heat map prints its scale, keeps a requested one, and holds the counts of its record") {
  Folder folder;
  putSmallScene(folder);
  const Ran ran = render(folder, {"--integrator", "heatmap", "-o", "a.exr"});
  REQUIRE(ran.status == 0);
  CHECK_THAT(ran.out, Contains("colours  black 0"));
  const Json record = recordOf(folder / "a.exr");
  const std::vector<float> nodes = readExrChannel(folder / "a.exr", "nodes");
  const std::vector<float> triangles = readExrChannel(folder / "a.exr", "triangles");
  double sum = 0, max = 0;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    sum += nodes[i];
    max = std::max(max, 3.0 * nodes[i] + 2.0 * triangles[i]);
  }
  CHECK(record["traversal"]["primary"]["nodes"].get<double>() == Approx(sum / nodes.size()));
  CHECK(record["image"]["figures"]["max_cost"].get<double>() == Approx(max));
  CHECK(record["image"]["figures"]["scale"].get<double>() == Approx(max));
  CHECK(record["image"]["figures"]["mean_cost"] > 0.0);
  CHECK(record["mrays_per_s"]["primary"].is_null());  // A counting traversal is no measure of speed.

  REQUIRE(render(folder, {"--integrator", "heatmap", "-o", "b.exr", "--heat-max", "1000"}).status == 0);
  CHECK(recordOf(folder / "b.exr")["image"]["figures"]["scale"] == 1000.0);
  CHECK(readExr(folder / "b.exr").at(12, 8).x < readExr(folder / "a.exr").at(12, 8).x);
  CHECK(readExrChannel(folder / "b.exr", "nodes") == nodes);
}

TEST_CASE("clusters are those of the requested pass and parameters") {
  Folder folder;
  REQUIRE(runCopse(folder / "", {"generate", "hairball", "--triangles", "3000", "-o", "ball.obj"}).status == 0);
  const auto clusters = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments{"render", "ball.obj", "-o",       "c.exr",        "--size",       "48x36",
                                       "--spp",  "1",        "--device", deviceOption(), "--integrator", "clusters"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Ran ran = runCopse(folder / "", arguments);
    INFO(ran.err);
    REQUIRE(ran.status == 0);
    CHECK_THAT(ran.out, Contains("clusters "));
    return recordOf(folder / "c.exr")["image"]["figures"];
  };
  const Json figures = clusters({});
  CHECK(figures == Json{{"cluster_level", 1.0}, {"clusters", 8.0}});
  float largest = 0;
  for (const float c : readExrChannel(folder / "c.exr", "cluster")) largest = std::max(largest, c);
  CHECK((largest >= 4 && largest < 8));
  CHECK(clusters({"--set", "kmeans.k=3"})["clusters"] == 3.0);
  CHECK(clusters({"--builder", "kmeans-q1", "--cluster-level", "2"})["cluster_level"] == 2.0);
  CHECK(clusters({"--cluster-level", "100"})["cluster_level"] < 10.0);
}

TEST_CASE("options that do not go together give 2 and are named") {
  Folder folder;
  putSmallScene(folder);
  for (const std::string integrator : {"reference", "heatmap", "clusters"})
    checkRefused(folder, {"--integrator", integrator, "--aov"}, "--aov does not go with --integrator " + integrator);
  checkRefused(folder, {"--integrator", "clusters", "--builder", "lbvh"}, "lbvh makes no clusters");
  checkRefused(folder, {"--integrator", "clusters", "--cluster-level", "0"},
               "--cluster-level: expected a number from 1 to 100, got 0");
  checkRefused(folder, {"--cluster-level", "2"}, "--cluster-level does not go with --integrator path");
  checkRefused(folder, {"--heat-max", "2"}, "--heat-max does not go with --integrator path");
  checkRefused(folder, {"--integrator", "heatmap", "--heat-max", "0"},
               "--heat-max: expected a number above 0 and below 1e9, got 0");
  checkRefused(folder, {"--integrator", "heatmap", "--heat-max", "nan"},
               "--heat-max: expected a number above 0 and below 1e9, got nan");
  checkRefused(folder, {"--integrator", "depth", "--exposure", "1"}, "--exposure does not go with --integrator depth");
  checkRefused(folder, {"--integrator", "depth", "--exposure", "nan"},
               "--exposure: expected stops from -100 to 100, got nan");
  CHECK_FALSE(std::filesystem::exists(folder / "out"));
}

TEST_CASE("each view has its own picture, and views whose file names collide are named", "[medium]") {
  Folder folder;
  putSmallScene(folder);
  REQUIRE(render(folder, {"--integrator", "albedo", "--view", "all", "--quiet"}).status == 0);
  CHECK(std::filesystem::exists(folder / "out/small-albedo-front.exr"));
  CHECK(std::filesystem::exists(folder / "out/small-albedo-side.exr"));
  REQUIRE(render(folder, {"--integrator", "albedo", "--view", "side", "-o", "x.exr", "--quiet"}).status == 0);
  CHECK(bytesOf(folder / "x.exr").size() > 100);
  std::string text = smallToml;
  text.replace(text.find("front"), 5, "a/b");
  text.replace(text.find("side"), 4, "a_b");
  putBytes(folder / "small.toml", text);
  checkRefused(folder, {"--view", "all"}, "views 'a/b' and 'a_b' would both be written to out/small-a_b.exr");
  CHECK(render(folder, {"--view", "a/b", "--quiet"}).status == 0);
}

TEST_CASE("triangles without area are no lights") {
  Folder folder;
  putSmallScene(folder);
  putBytes(folder / "small.obj", std::string(smallObj) + "v 0 0 0\nv 0.5 0.5 0.5\nv 0.75 0.75 0.75\nf 17 18 19\n");
  const Ran ran = runCopse(folder / "", {"info", "small.toml"});
  INFO(ran.out << ran.err);
  REQUIRE(ran.status == 0);
  REQUIRE(render(folder, {"-o", "a.exr", "--quiet"}).status == 0);
  CHECK(recordOf(folder / "a.exr")["scene"]["triangles"] == 15);
  CHECK(recordOf(folder / "a.exr")["scene"]["emitters"] == 2);
}
