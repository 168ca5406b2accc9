// `copse render --resume` from outside: stopped, gone on with, and refused.
#include <signal.h>

#include <chrono>
#include <cstring>
#include <nlohmann/json.hpp>
#include <thread>

#include "tests/support/catch.h"
#include "tests/support/files.h"
#include "tests/support/program.h"
#include "tests/support/small_scene.h"
#include "tracer/image/image_io.h"

using namespace copse;
using namespace copse::test;

namespace {

Ran render(const Folder& folder, const std::string& file, const std::vector<std::string>& more) {
  std::vector<std::string> arguments{"render", "small.toml", "-o", file, "--size", "24x16", "--device", "cpu"};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return runCopse(folder / "", arguments);
}

bool samePixels(const std::string& a, const std::string& b) {
  const Image one = readExr(a), other = readExr(b);
  return one.pixels.size() == other.pixels.size() &&
         std::memcmp(one.pixels.data(), other.pixels.data(), one.pixels.size() * sizeof(vec3)) == 0;
}

nlohmann::json recordOf(const std::string& file) {
  std::map<std::string, std::string> attributes;
  readExr(file, &attributes);
  return nlohmann::json::parse(attributes.at("copse"));
}

}  // namespace

TEST_CASE("renders with --resume add up to one render, whatever threads and trees they used") {
  Folder folder;
  putSmallScene(folder);
  REQUIRE(render(folder, "one.exr", {"--spp", "11"}).status == 0);
  const Ran first = render(folder, "x.exr", {"--spp", "3", "--resume"});
  REQUIRE(first.status == 0);
  CHECK_THAT(first.err, Contains("note: x.exr is not there: view front starts with its first sample"));
  REQUIRE(render(folder, "x.exr", {"--spp", "4", "--resume", "--threads", "3"}).status == 0);
  const Ran last = render(folder, "x.exr",
                          {"--spp", "11", "--resume", "--builder", "lbvh", "--tracer", "binary", "--stats", "x.json"});
  REQUIRE(last.status == 0);
  CHECK_THAT(last.out, Contains("resumed  from 4 spp, by 2 runs in "));
  CHECK(samePixels(folder / "x.exr", folder / "one.exr"));
  const nlohmann::json record = nlohmann::json::parse(bytesOf(folder / "x.json"));
  CHECK(record["image"]["samples_done"] == 11.0);
  CHECK(record["rays"]["primary"] == 7 * 24 * 16);  // Of this run alone.
  CHECK(record["earlier"]["runs"] == 2);
  CHECK(record["earlier"]["samples_done"] == 4.0);
  CHECK(record["earlier"]["rays"]["primary"] == 4 * 24 * 16);
  CHECK(record["earlier"]["time_ms"]["render"] > 0.0);
  CHECK(record["time_ms"]["total"].get<double>() ==
        Approx(record["time_ms"]["build"].get<double>() + record["time_ms"]["render"].get<double>()));
}

TEST_CASE("an image of a power of two of samples can be gone on from, others without --resume cannot") {
  Folder folder;
  putSmallScene(folder);
  REQUIRE(render(folder, "one.exr", {"--spp", "7"}).status == 0);
  CHECK_FALSE(recordOf(folder / "one.exr").contains("earlier"));
  CHECK(readExrFacts(folder / "one.exr")[0].channels.size() == 3);  // Without sums.
  REQUIRE(render(folder, "x.exr", {"--spp", "4"}).status == 0);
  REQUIRE(render(folder, "x.exr", {"--spp", "7", "--resume"}).status == 0);
  CHECK(samePixels(folder / "x.exr", folder / "one.exr"));
  const std::string before = bytesOf(folder / "one.exr");
  const Ran refused = render(folder, "one.exr", {"--spp", "9", "--resume"});
  CHECK(refused.status == 2);
  CHECK_THAT(refused.err, Contains("error: one.exr: cannot be resumed: of 7 samples per pixel it has the means"));
  CHECK(bytesOf(folder / "one.exr") == before);
}

TEST_CASE("a render that was stopped goes on with --resume to the image of one render", "[medium]") {
  Folder folder;
  putSmallScene(folder);
  std::vector<std::string> arguments{"render",   "small.toml", "-o",    "x.exr",   "--size", "24x16",
                                     "--device", "cpu",        "--spp", "1000000", "--quiet"};
  Running running(folder / "", arguments);
  for (int i = 0; i < 6000 && running.processorSeconds() < 1 && !running.hasEnded(); ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  running.signal(SIGINT);
  const Ran stopped = running.wait();
  REQUIRE(stopped.status == 130);
  CHECK_THAT(stopped.err, Contains("; continue with --resume"));
  const double done = recordOf(folder / "x.exr")["image"]["samples_done"];
  const int spp = static_cast<int>(done) + 20;
  INFO(done << " of " << spp);
  REQUIRE(render(folder, "x.exr", {"--spp", std::to_string(spp), "--resume"}).status == 0);
  REQUIRE(render(folder, "one.exr", {"--spp", std::to_string(spp)}).status == 0);
  CHECK(samePixels(folder / "x.exr", folder / "one.exr"));
}

TEST_CASE("a file with the samples asked for is left alone, and one with more or of another render is an error") {
  Folder folder;
  putSmallScene(folder);
  REQUIRE(render(folder, "x.exr", {"--spp", "4"}).status == 0);
  const std::string before = bytesOf(folder / "x.exr");
  const Ran same = render(folder, "x.exr", {"--spp", "4", "--resume"});
  CHECK(same.status == 0);
  CHECK_THAT(same.err, Contains("note: x.exr has its 4 samples per pixel already"));
  const std::pair<std::vector<std::string>, std::string> refused[] = {
      {{"--spp", "3"}, "error: x.exr: has 4 samples per pixel, more than --spp 3"},
      {{"--seed", "5"}, "it was made with --seed 1 (now 5)"},
      {{"--view", "side"}, "it was made with view front's eye"},
      {{"--integrator", "depth"}, "error: --resume does not go with --integrator depth"}};
  for (const auto& [more, error] : refused) {
    std::vector<std::string> arguments = more;
    arguments.push_back("--resume");
    const Ran ran = render(folder, "x.exr", arguments);
    CHECK(ran.status == 2);
    CHECK_THAT(ran.err, Contains(error));
  }
  putBytes(folder / "small.mtl", "newmtl wall\nKd 0.1 0.1 0.1\nnewmtl lamp\nKd 0 0 0\nKe 10 10 10\n");
  const Ran other = render(folder, "x.exr", {"--spp", "8", "--resume"});
  CHECK(other.status == 2);
  CHECK_THAT(other.err, Contains("it was made with another scene, or another state of its files (scene small, hash "));
  CHECK(bytesOf(folder / "x.exr") == before);
}

TEST_CASE("with --view all each view goes on from its own file") {
  Folder folder;
  putSmallScene(folder);
  REQUIRE(render(folder, "one.exr", {"--view", "all", "--spp", "5"}).status == 0);
  REQUIRE(render(folder, "x.exr", {"--view", "all", "--spp", "3", "--resume"}).status == 0);
  std::filesystem::remove(folder / "x-side.exr");
  REQUIRE(render(folder, "x.exr", {"--view", "all", "--spp", "5", "--resume"}).status == 0);
  for (const std::string view : {"front", "side"})
    CHECK(samePixels(folder / ("x-" + view + ".exr"), folder / ("one-" + view + ".exr")));
}
