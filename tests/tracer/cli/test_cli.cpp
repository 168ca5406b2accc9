// The program from outside: what it prints, writes and returns when all is well.
#include <nlohmann/json.hpp>
#include <sstream>

#include "builder/registry.h"
#include "tests/support/catch.h"
#include "tests/support/devices.h"
#include "tests/support/files.h"
#include "tests/support/program.h"
#include "tests/support/real_meshes.h"
#include "tests/support/small_scene.h"
#include "tracer/image/image_io.h"
#include "tracer/integrators/registry.h"

using namespace copse;
using namespace copse::test;
using Json = nlohmann::json;

namespace {

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

Json recordOf(const std::string& exr) {
  std::map<std::string, std::string> attributes;
  readExr(exr, &attributes);
  return Json::parse(attributes.at("copse"));
}

/// What `--tracer auto` is on the device that tests run on.
std::string autoTracer() { return chosenDevice().isCuda() ? "binary" : "wide8"; }

}  // namespace

TEST_CASE("render writes out/NAME.exr and a preview, and prints the time to image on standard output", "[medium]") {
  Folder folder;
  putSmallScene(folder);
  const Ran ran =
      runCopse(folder / "", {"render", "small.toml", "--size", "24x16", "--spp", "2", "--device", deviceOption()});
  INFO(ran.err);
  REQUIRE(ran.status == 0);
  CHECK(contains(ran.out, "time to image"));
  CHECK(contains(ran.out, "SAH cost"));
  CHECK_FALSE(contains(ran.err, "error"));
  const Image image = readExr(folder / "out/small.exr");
  CHECK(image.width == 24);
  CHECK(image.height == 16);
  CHECK(std::filesystem::exists(folder / "out/small.png") == hasOpenImageIO());
}

TEST_CASE("the record has every field of schema 1, and the image carries the same one") {
  Folder folder;
  putSmallScene(folder);
  const Ran ran =
      runCopse(folder / "", {"render",    "small.toml", "-o",    "a.exr",      "--size",       "24x16",     "--spp",
                             "2",         "--seed",     "7",     "--device",   deviceOption(), "--threads", "2",
                             "--builder", "lbvh",       "--set", "leaf.max=4", "--stats",      "a.json",    "--quiet"});
  INFO(ran.err);
  REQUIRE(ran.status == 0);
  CHECK(ran.out.empty());
  CHECK(ran.err.empty());
  const Json record = Json::parse(bytesOf(folder / "a.json"));
  CHECK(recordOf(folder / "a.exr") == record);

  CHECK(record["schema"] == 1);
  CHECK(record["copse"]["version"].get<std::string>() == "0.1.0");
  CHECK(!record["copse"]["commit"].get<std::string>().empty());
  const std::string time = record["time"];
  CHECK((time.size() == 20 && time[10] == 'T' && time.back() == 'Z'));
  Json scene = record["scene"];
  CHECK(scene["hash"].get<std::string>().size() == 16);
  scene.erase("hash");
  CHECK(scene ==
        Json{{"name", "small"}, {"triangles", 14}, {"emitters", 2}, {"file", "small.toml"}, {"generated", false}});
  CHECK(record["device"]["kind"] == (chosenDevice().isCuda() ? "cuda" : "cpu"));
  CHECK(record["device"]["threads"] == 2);
  CHECK(record["device"]["name"].is_string());
  CHECK(record["builder"]["name"] == "lbvh");
  CHECK(record["builder"]["parameters"]["leaf.max"] == 4);
  CHECK(record["builder"]["parameters"]["sah.traversal"] == 3.0);
  const Json& bvh = record["bvh"];
  CHECK(bvh["sah_cost"] > 0.0);
  CHECK(bvh.contains("wide_cost") == (autoTracer() == "wide8"));
  CHECK(bvh["nodes"] == 2 * bvh["leaves"].get<int>() - 1);
  CHECK(bvh["depth"] > 0);
  CHECK(bvh["max_leaf_triangles"] <= 4);
  CHECK(bvh["bytes"] > 14 * 36);
  const Json& image = record["image"];
  CHECK(image["file"] == "a.exr");
  CHECK(image["view"] == "front");
  CHECK((image["width"] == 24 && image["height"] == 16 && image["spp"] == 2));
  CHECK(image["samples_done"] == 2.0);
  const Json& ms = record["time_ms"];
  CHECK(ms["load"] > 0.0);
  CHECK(!ms["build_phases"].empty());
  CHECK(ms["render_phases"].contains("trace primary"));
  CHECK(ms["total"].get<double>() == Approx(ms["build"].get<double>() + ms["render"].get<double>()));
  double phases = 0;
  for (const auto& [name, phase] : ms["render_phases"].items()) phases += phase.get<double>();
  CHECK(phases <= ms["render"].get<double>() * 1.001);
  CHECK(record["rays"]["primary"] == 24 * 16 * 2);
  CHECK(record["rays"]["shadow"] > 0);
  for (const char* kind : {"primary", "bounce", "shadow", "all"}) CHECK(record["mrays_per_s"][kind] > 0.0);
  CHECK(record["mrays_per_s"]["primary"].get<double>() ==
        Approx(24 * 16 * 2 / ms["render_phases"]["trace primary"].get<double>() * 1e-3));
  CHECK(record["machine"]["processors"] > 0);
  CHECK(record["machine"]["memory_bytes"] > 1e6);
  CHECK(contains(record["machine"]["system"], "Linux"));
  CHECK(record["machine"]["driver"].is_string() == chosenDevice().isCuda());  // Null on the CPU, which has none.
  for (const char* key : {"name", "version", "flags"}) CHECK(!record["compiler"][key].get<std::string>().empty());
  CHECK(record["memory"]["tree_bytes"] == bvh["bytes"]);
  // At least fourteen triangles and 27 nodes, while the whole process holds its libraries.
  CHECK(record["memory"]["build_peak_bytes"] > bvh["bytes"]);
  CHECK(record["memory"]["process_peak_bytes"] > 1e6);
}

TEST_CASE("How warps and batches share rays changes no pixel, and the record has it") {
  Folder folder;
  putSmallScene(folder);
  const auto render = [&](const std::string& output, const std::vector<std::string>& settings) {
    std::vector<std::string> arguments{"render", "small.toml", "-o",       output,         "--size", "24x16",
                                       "--spp",  "2",          "--device", deviceOption(), "--quiet"};
    for (const std::string& setting : settings) arguments.insert(arguments.end(), {"--set", setting});
    return runCopse(folder / "", arguments);
  };
  REQUIRE(render("a.exr", {}).status == 0);
  REQUIRE(render("b.exr", {"trace.leave=31", "trace.fetch=32", "trace.blocks=1", "path.queue=100"}).status == 0);
  CHECK(readExr(folder / "a.exr").pixels == readExr(folder / "b.exr").pixels);
  CHECK(recordOf(folder / "a.exr")["tracer"] == Json{{"name", autoTracer()}});
  CHECK(recordOf(folder / "b.exr")["tracer"]["parameters"] ==
        Json{{"trace.leave", 31}, {"trace.fetch", 32}, {"trace.blocks", 1}, {"path.queue", 100}});
  const Ran wrong = render("c.exr", {"trace.leave=32"});
  CHECK(wrong.status == 2);
  CHECK(contains(wrong.err, "trace.leave: expected an integer from 0 to 31, got 32"));
}

TEST_CASE("The tracer changes no pixel, the record names it, and an unsuitable tracer is refused") {
  Folder folder;
  putSmallScene(folder);
  const auto run = [&](std::vector<std::string> arguments, const std::vector<std::string>& more) {
    arguments.insert(arguments.end(), {"--device", deviceOption()});
    arguments.insert(arguments.end(), more.begin(), more.end());
    return runCopse(folder / "", arguments);
  };
  const std::vector<std::string> render{"render", "small.toml", "-o", "a.exr", "--size", "24x16", "--spp", "2"};
  const std::vector<std::string> build{"build", "small.toml", "--stats", "b.json"};
  std::vector<std::vector<vec3>> pixels;
  for (const char* name : {"auto", "binary", "wide8"}) {
    const std::string expected = name == std::string("auto") ? autoTracer() : name;
    REQUIRE(run(render, {"--tracer", name}).status == 0);
    CHECK(recordOf(folder / "a.exr")["tracer"]["name"] == expected);
    pixels.push_back(readExr(folder / "a.exr").pixels);
    CHECK(pixels.back() == pixels.front());
    REQUIRE(run(build, {"--tracer", name}).status == 0);
    CHECK(Json::parse(bytesOf(folder / "b.json"))["tracer"]["name"] == expected);
  }
  for (const auto& command : {render, build}) {
    const Ran unknown = run(command, {"--tracer", "bvh16"});
    CHECK(unknown.status == 2);
    CHECK(contains(unknown.err, "--tracer bvh16: unknown tracer 'bvh16' (available: auto, binary, wide8"));
  }
}

TEST_CASE("The option --view takes a name or all, and each view has its own file") {
  Folder folder;
  putSmallScene(folder);
  const std::vector<std::string> small{"render", "small.toml", "--size",       "8x6",    "--spp",
                                       "1",      "--device",   deviceOption(), "--quiet"};
  auto with = [&](std::vector<std::string> more) {
    more.insert(more.begin(), small.begin(), small.end());
    return runCopse(folder / "", more);
  };
  REQUIRE(with({"--view", "side"}).status == 0);
  CHECK(recordOf(folder / "out/small-side.exr")["image"]["view"] == "side");
  REQUIRE(with({"--view", "all", "-o", "x.exr", "--stats", "x.json"}).status == 0);
  for (const char* view : {"front", "side"}) {
    CHECK(recordOf(folder / (std::string("x-") + view + ".exr"))["image"]["view"] == view);
    CHECK(std::filesystem::exists(folder / (std::string("x-") + view + ".json")));
  }
  CHECK_FALSE(std::filesystem::exists(folder / "x.exr"));
  REQUIRE(with({"--view", "all"}).status == 0);
  CHECK(std::filesystem::exists(folder / "out/small-front.exr"));
  const Ran unknown = with({"--view", "roof"});
  CHECK(unknown.status == 2);
  CHECK(contains(unknown.err, "front, side"));
}

TEST_CASE("the image depends on the seed and not on the threads or the builder") {
  Folder folder;
  putSmallScene(folder);
  auto image = [&](const std::string& name, const std::vector<std::string>& more) {
    std::vector<std::string> arguments{"render",   "small.toml",   "--size",  "32x24", "--spp", "4",
                                       "--device", deviceOption(), "--quiet", "-o",    name};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Ran ran = runCopse(folder / "", arguments);
    INFO(ran.err);
    REQUIRE(ran.status == 0);
    return readExr(folder / name).pixels;
  };
  const auto one = image("1.exr", {"--threads", "1"});
  const auto lbvh = image("lbvh.exr", {"--builder", "lbvh"}), sah = image("sah.exr", {"--builder", "sah"});
  CHECK(lbvh == one);
  CHECK(sah == one);
  const auto tree = [&](const std::string& name) { return recordOf(folder / name)["builder"]["name"]; };
  CHECK((tree("lbvh.exr") == "lbvh" && tree("sah.exr") == "sah"));
  CHECK(one == image("2.exr", {"--threads", "3"}));
  CHECK(one != image("3.exr", {"--seed", "2"}));
}

TEST_CASE("the reference integrator renders through the same command") {
  Folder folder;
  putSmallScene(folder);
  const Ran ran = runCopse(folder / "", {"render", "small.toml", "-o", "r.exr", "--size", "16x12", "--spp", "2",
                                         "--integrator", "reference", "--stats", "r.json"});
  INFO(ran.err);
  REQUIRE(ran.status == 0);
  const Json record = Json::parse(bytesOf(folder / "r.json"));
  CHECK(record["image"]["integrator"] == "reference");
  CHECK(record["rays"]["primary"] == 16 * 12 * 2);
  CHECK_FALSE(contains(ran.err, "ignored"));
  const Ran other = runCopse(folder / "", {"render", "small.toml", "-o", "r.exr", "--size", "4x4", "--spp", "1",
                                           "--integrator", "reference", "--builder", "lbvh", "--tracer", "wide8"});
  CHECK(contains(other.err, "note: ignored --builder, --tracer: --integrator reference has a tree of its own"));
}

TEST_CASE("build prints phases, cost and checks, and writes a record without an image") {
  Folder folder;
  putSmallScene(folder);
  const Ran ran = runCopse(folder / "", {"build", "small.toml", "--builder", "sah", "--repeat", "3", "--device",
                                         deviceOption(), "--stats", "b.json"});
  INFO(ran.err);
  REQUIRE(ran.status == 0);
  CHECK(contains(ran.out, "SAH cost"));
  CHECK(contains(ran.out, "checks   passed"));
  CHECK(contains(ran.out, "medians of 3 builds"));
  const Json record = Json::parse(bytesOf(folder / "b.json"));
  CHECK(record["builder"]["name"] == "sah");
  CHECK_FALSE(record.contains("image"));
  CHECK(record["time_ms"]["total"] == record["time_ms"]["build"]);
}

TEST_CASE("build and render run optimisers over the builder's tree, and the record has those requested") {
  Folder folder;
  putSmallScene(folder);
  const auto record = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments{"build", "small.toml", "--device", deviceOption(), "--stats", "x.json"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Ran ran = runCopse(folder / "", arguments);
    INFO(ran.err);
    REQUIRE(ran.status == 0);
    return std::pair(ran, Json::parse(bytesOf(folder / "x.json")));
  };
  const auto [plain, trbvh] = record({"--builder", "trbvh"});
  CHECK_FALSE(trbvh["builder"].contains("optimise"));
  const auto [ran, optimised] = record({"--builder", "lbvh", "--optimise", "treelets-exact"});
  CHECK(optimised["builder"]["name"] == "lbvh");
  CHECK(optimised["builder"]["optimise"] == Json::array({"treelets-exact"}));
  CHECK(optimised["bvh"] == trbvh["bvh"]);
  CHECK(contains(ran.out, "lbvh + treelets-exact: SAH cost"));
  const auto [both, two] = record({"--builder", "sah", "--optimise", "treelets-exact,treelets-agglomerative"});
  CHECK(two["builder"]["optimise"] == Json::array({"treelets-exact", "treelets-agglomerative"}));

  const auto refused = [&](const std::vector<std::string>& more) {
    std::vector<std::string> arguments{"render", "small.toml", "--device", deviceOption(), "--size", "16x12"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Ran ran = runCopse(folder / "", arguments);
    CHECK(ran.status == 2);
    return ran.err;
  };
  CHECK(contains(refused({"--optimise", "treelets"}),
                 "unknown optimiser 'treelets' (available: treelets-exact, treelets-agglomerative)"));
  CHECK(contains(refused({"--builder", "kmeans", "--set", "kmeans.arity=4", "--optimise", "treelets-exact"}),
                 "optimiser treelets-exact: expected a binary tree, got up to 4 children per node"));
}

TEST_CASE("info shows what is in a scene, and how an image was made") {
  Folder folder;
  putSmallScene(folder);
  const Ran scene = runCopse(folder / "", {"info", "small.toml"});
  INFO(scene.err);
  REQUIRE(scene.status == 0);
  for (const char* part : {"triangles 14", "bounds", "lamp", "ke 10 10 10", "lights 2", "front", "side"})
    CHECK(contains(scene.out, part));
  REQUIRE(
      runCopse(folder / "", {"render", "small.toml", "-o", "a.exr", "--size", "8x8", "--spp", "1", "--quiet"}).status ==
      0);
  const Ran image = runCopse(folder / "", {"info", "a.exr"});
  CHECK(image.status == 0);
  CHECK(Json::parse(image.out) == recordOf(folder / "a.exr"));
}

TEST_CASE("list names the builders, optimisers, tracers, integrators, parameters, generators and devices") {
  Folder folder;
  auto list = [&](const char* what) { return runCopse(folder / "", {"list", what}); };
  CHECK(contains(list("builders").out, "lbvh"));
  CHECK(contains(list("builders").out, "sah"));
  CHECK(contains(list("optimisers").out, "treelets-agglomerative"));
  for (const char* name : {"auto", "binary", "wide8"}) CHECK(contains(list("tracers").out, name));
  CHECK(contains(list("parameters").out, "leaf.max"));
  for (const char* name : {"atrium", "hairball", "statue", "conference", "office", "plant", "cornell"})
    CHECK(contains(list("generators").out, name));
  CHECK(contains(list("devices").out, "cpu"));
  for (const IntegratorEntry* entry : integrators()) {
    CHECK(contains(list("integrators").out, std::string(entry->name) + " "));
    CHECK(contains(list("integrators").out, entry->meaning));
    for (const IntegratorOption* option : entry->options)
      CHECK(contains(list("integrators").out, std::string("--") + option->name));
  }
  const Json devices = Json::parse(runCopse(folder / "", {"list", "devices", "--json"}).out);
  CHECK((devices[0]["kind"] == "cpu" && devices[0]["threads"] >= 1));
  CHECK(runCopse(folder / "", {"list", "builders", "--json"}).status == 2);
  CHECK(list("colours").status == 2);
}

TEST_CASE("README.md has the row of each builder that has a page as list prints it, and the pages are there") {
  const std::string root = std::string(COPSE_SOURCE_DIR) + "/";
  if (!std::filesystem::exists(root + "README.md")) return skipTest("no README.md");
  Folder folder;
  const Ran table = runCopse(folder / "", {"list", "builders", "--markdown"});
  REQUIRE(table.status == 0);
  const std::string readme = bytesOf(root + "README.md");
  std::istringstream rows(table.out);
  for (std::string row; std::getline(rows, row);) {
    INFO(row);
    const bool isBuilder = row.starts_with("| `"), hasPage = contains(row, "](docs/");
    CHECK((contains(readme, "\n" + row + "\n") || (isBuilder && !hasPage)));
  }
  for (const Method& method : methods::all()) {
    INFO(method.name);
    CHECK((!method.page || std::filesystem::exists(root + method.page)));
  }
  CHECK(runCopse(folder / "", {"list", "parameters", "--markdown"}).status == 2);
}

TEST_CASE("generate writes an OBJ that loads again") {
  Folder folder;
  const Ran ran = runCopse(folder / "", {"generate", "cornell", "-o", "box.obj"});
  INFO(ran.err);
  REQUIRE(ran.status == 0);
  CHECK(std::filesystem::exists(folder / "box.mtl"));
  const Ran info = runCopse(folder / "", {"info", "box.obj"});
  CHECK(info.status == 0);
  CHECK(contains(info.out, "triangles"));
}

TEST_CASE("numbers may have underscores between digits, as in scene files") {
  Folder folder;
  REQUIRE(
      runCopse(folder / "", {"generate", "atrium", "--triangles", "6_000", "--seed", "1_0", "-o", "a.obj"}).status ==
      0);
  REQUIRE(runCopse(folder / "", {"generate", "atrium", "--triangles", "6000", "--seed", "10", "-o", "b.obj"}).status ==
          0);
  const auto faces = [&](const char* file) {  // What comes before them names the MTL.
    const std::string text = bytesOf(folder / file);
    return text.substr(text.find("\nv "));
  };
  CHECK(faces("a.obj") == faces("b.obj"));
  for (const char* wrong : {"6__000", "_6000", "6000_", "6_k"}) {
    const Ran ran = runCopse(folder / "", {"generate", "atrium", "--triangles", wrong, "-o", "c.obj"});
    CHECK(ran.status == 2);
    CHECK(contains(ran.err, "--triangles"));
  }
  putSmallScene(folder);
  CHECK(runCopse(folder / "", {"render", "small.toml", "-o", "x.exr", "--size", "4x4", "--spp", "1_0", "--quiet"})
            .status == 0);
  CHECK(recordOf(folder / "x.exr")["image"]["spp"] == 10);
}

TEST_CASE("The options --version and --help go to standard output with status 0") {
  Folder folder;
  const Ran version = runCopse(folder / "", {"--version"});
  CHECK(version.status == 0);
  CHECK(contains(version.out, "copse 0.1.0"));
  for (const std::vector<std::string>& arguments :
       {std::vector<std::string>{"--help"}, {"render", "--help"}, {"build", "--help"}, {"compare", "--help"}}) {
    const Ran help = runCopse(folder / "", arguments);
    CHECK(help.status == 0);
    CHECK(contains(help.out, "Usage"));
  }
}
