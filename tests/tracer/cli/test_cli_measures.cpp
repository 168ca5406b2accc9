// What is measured on demand: traversal steps and the end-point overlap, in the summary and in the record.
#include <filesystem>
#include <nlohmann/json.hpp>

#include "tests/support/catch.h"
#include "tests/support/devices.h"
#include "tests/support/program.h"
#include "tests/support/small_scene.h"
#include "tracer/image/image_io.h"

using namespace copse;
using namespace copse::test;
using nlohmann::json;

namespace {

/// `copse COMMAND small.toml`, on the CPU and small, with `more`.
Ran run(const Folder& folder, const std::string& command, std::vector<std::string> more) {
  std::vector<std::string> arguments{command, "small.toml", "--device", deviceOption(), "--builder", "lbvh"};
  if (command == "render") more.insert(more.end(), {"-o", "x.exr", "--size", "32x24", "--spp", "2"});
  arguments.insert(arguments.end(), more.begin(), more.end());
  return runCopse(folder / "", arguments);
}

json recordOf(const Folder& folder) { return json::parse(bytesOf(folder / "x.json")); }

}  // namespace

TEST_CASE("render counts traversal steps and measures the overlap on demand, without changing the image") {
  Folder folder;
  putSmallScene(folder);
  REQUIRE(run(folder, "render", {"--stats", "x.json"}).status == 0);
  const json plain = recordOf(folder);
  const Image image = readExr(folder / "x.exr");
  CHECK((!plain.contains("traversal") || plain["traversal"].is_null()));
  CHECK(plain["bvh"]["end_point_overlap"].is_null());

  json last;
  for (const char* threads : {"1", "2"}) {
    const Ran ran =
        run(folder, "render", {"--stats", "x.json", "--count-traversal", "--end-point-overlap", "--threads", threads});
    INFO(ran.err);
    REQUIRE(ran.status == 0);
    CHECK(ran.out.find("visits per ray") != std::string::npos);
    CHECK(ran.out.find("at end points") != std::string::npos);
    CHECK(readExr(folder / "x.exr").pixels == image.pixels);
    const json record = recordOf(folder);
    CHECK(record["rays"] == plain["rays"]);  // The second render's are not among them.
    CHECK(record["bvh"]["end_point_overlap"] > 0);
    for (const char* kind : {"primary", "bounce", "shadow"}) {
      const json& counts = record["traversal"][kind];
      // 14 triangles: at most 13 nodes, and every ray that the camera sends meets the root.
      CHECK(counts["nodes"] >= 1);
      CHECK(counts["nodes"] <= 13);
      CHECK(counts["triangles"] > 0);
      CHECK(counts["triangles"] <= 14);
    }
    CHECK(record["traversal"]["counted_by"].is_string());
    if (!last.is_null()) {
      CHECK(record["traversal"] == last["traversal"]);
      CHECK(record["bvh"] == last["bvh"]);
    }
    last = record;
  }
  const Ran built = run(folder, "build", {"--stats", "x.json", "--end-point-overlap"});
  REQUIRE(built.status == 0);
  CHECK(recordOf(folder)["bvh"]["end_point_overlap"] == last["bvh"]["end_point_overlap"]);
}

TEST_CASE("measurements that are impossible are refused before anything is read") {
  Folder folder;
  putSmallScene(folder);
  for (const char* option : {"--count-traversal", "--end-point-overlap"})
    for (const char* integrator : {"reference", "normals"}) {
      const Ran ran = run(folder, "render", {option, "--integrator", integrator});
      CHECK(ran.status == 2);
      CHECK(ran.err.find(std::string(option) + " does not go with --integrator " + integrator) != std::string::npos);
      CHECK_FALSE(std::filesystem::exists(folder / "x.exr"));
    }
}
