// Renders that are stopped, killed or run out of room: an image is whole or does not exist.
#include <signal.h>
#include <sys/wait.h>
#include <nlohmann/json.hpp>

#include <chrono>
#include <cstdlib>
#include <thread>

#include "builder/base/error.h"
#include "tests/support/catch.h"
#include "tests/support/files.h"
#include "tests/support/program.h"
#include "tests/support/small_scene.h"
#include "tracer/image/image_io.h"

using namespace copse;
using namespace copse::test;

namespace {

using Clock = std::chrono::steady_clock;

const std::vector<std::string> endless{"render", "small.toml", "-o",  "x.exr",   "--size", "64x64",  "--spp",
                                       "100000", "--device",   "cpu", "--stats", "x.json", "--quiet"};

void sleepMs(int ms) { std::this_thread::sleep_for(std::chrono::milliseconds(ms)); }

/// Waits until the run has used enough processor time to be rendering, however busy the machine is.
void untilRendering(Running& running) {
  for (int i = 0; i < 6000 && running.processorSeconds() < 1 && !running.hasEnded(); ++i) sleepMs(10);
}

double meanOf(const Image& image) {
  double sum = 0;
  for (const vec3& pixel : image.pixels) sum += pixel.y;
  return sum / static_cast<double>(image.pixels.size());
}

}  // namespace

TEST_CASE("an interrupted render leaves a whole image that says how many samples it has, and exits with 130",
          "[medium]") {
  Folder whole;
  putSmallScene(whole);
  REQUIRE(runCopse(whole / "", {"render", "small.toml", "-o", "x.exr", "--size", "64x64", "--spp", "32", "--device",
                                "cpu", "--quiet"})
              .status == 0);
  const double mean = meanOf(readExr(whole / "x.exr"));
  for (const int number : {SIGINT, SIGTERM}) {
    Folder folder;
    putSmallScene(folder);
    Running running(folder / "", endless);
    untilRendering(running);
    running.signal(number);
    const Ran ran = running.wait();
    INFO(ran.err);
    REQUIRE(ran.status == 130);
    CHECK(ran.err.find("interrupted: x.exr holds ") != std::string::npos);
    std::map<std::string, std::string> attributes;
    const Image image = readExr(folder / "x.exr", &attributes);
    CHECK(image.width == 64);
    const auto record = nlohmann::json::parse(attributes.at("copse"));
    CHECK(record["image"]["samples_done"] > 0.0);
    CHECK(record["image"]["samples_done"] < 100000.0);
    CHECK(nlohmann::json::parse(bytesOf(folder / "x.json")) == record);
    CHECK(meanOf(image) == Approx(mean).epsilon(0.1));  // Not darkened by samples that were not taken.
  }
}

TEST_CASE("a second signal ends the render at once, and leaves no part of a file", "[medium]") {
  Folder folder;
  putSmallScene(folder);
  const std::size_t before = folder.fileCount();
  std::vector<std::string> slow = endless;
  slow[5] = "4096x4096";
  Running running(folder / "", slow);
  untilRendering(running);
  const auto start = Clock::now();
  while (!running.hasEnded() && Clock::now() - start < std::chrono::seconds(20)) {
    running.signal(SIGINT);
    sleepMs(1);
  }
  CHECK(running.wait().status == 130);
  CHECK(folder.fileCount() == before);
}

TEST_CASE("a signal while a generated scene is written gives 130 and leaves no part of a file") {
  for (const int number : {SIGINT, SIGTERM}) {
    Folder folder;
    Running running(folder / "", {"generate", "hairball", "--triangles", "2000000", "-o", "x.obj"});
    const auto temporary = [&] {
      for (const auto& entry : std::filesystem::directory_iterator(folder / ""))
        if (entry.path().filename().string().rfind(".copse-", 0) == 0) {
          std::error_code gone;
          if (std::filesystem::file_size(entry.path(), gone) > 100000 && !gone) return true;
        }
      return false;
    };
    for (int i = 0; i < 20000 && !temporary() && !running.hasEnded(); ++i) sleepMs(2);
    REQUIRE(temporary());
    running.signal(number);
    CHECK(running.wait().status == 130);
    CHECK_FALSE(temporary());
    CHECK_FALSE(std::filesystem::exists(folder / "x.obj"));
  }
}

TEST_CASE("kill -9 at any moment leaves the old image or the new one, never a part", "[medium]") {
  Folder folder;
  putSmallScene(folder);
  const std::vector<std::string> arguments{"render", "small.toml", "-o",       "x.exr", "--size", "512x512",
                                           "--spp",  "1",          "--device", "cpu",   "--quiet"};
  int whole = 0;
  for (int ms = 10; ms <= 250; ms += 24) {
    Running running(folder / "", arguments);
    sleepMs(ms);
    running.signal(SIGKILL);
    running.wait();
    if (!std::filesystem::exists(folder / "x.exr")) continue;
    ++whole;
    REQUIRE_NOTHROW(readExr(folder / "x.exr"));
  }
  REQUIRE(runCopse(folder / "", arguments).status == 0);
  INFO(whole << " of the killed runs had an image before them or were done");
  CHECK(readExr(folder / "x.exr").width == 512);
}

TEST_CASE("a disk without room gives 2, says so, and leaves the folder as it was") {
  Folder folder;
  putSmallScene(folder);
  const std::size_t before = folder.fileCount();
  const Ran ran =
      runCopse(folder / "",
               {"render", "small.toml", "-o", "x.exr", "--size", "256x256", "--spp", "1", "--device", "cpu", "--quiet"},
               {{RLIMIT_FSIZE, 20000}});
  INFO(ran.err);
  CHECK(ran.status == 2);
  CHECK(ran.err.find("x.exr: ") != std::string::npos);
  CHECK(folder.fileCount() == before);

  putBytes(folder / "x.exr", "an older image");
  const Ran again =
      runCopse(folder / "",
               {"render", "small.toml", "-o", "x.exr", "--size", "256x256", "--spp", "1", "--device", "cpu", "--quiet"},
               {{RLIMIT_FSIZE, 20000}});
  CHECK(again.status == 2);
  CHECK(bytesOf(folder / "x.exr") == "an older image");
  CHECK(folder.fileCount() == before + 1);
}

TEST_CASE("a record that cannot be written is an error, and a device file can be one") {
  Folder folder;
  putSmallScene(folder);
  const std::vector<std::string> build{"build", "small.toml", "--device", "cpu", "--stats"};
  auto stats = [&](const std::string& file) {
    std::vector<std::string> arguments = build;
    arguments.push_back(file);
    return runCopse(folder / "", arguments);
  };
  CHECK(stats("/dev/null").status == 0);
  CHECK(stats("/dev/full").status == 2);
  CHECK(std::filesystem::is_character_file("/dev/full"));
}

TEST_CASE("messages that cannot be written cost neither the image nor the exit status, lost results give 2") {
  Folder folder;
  putSmallScene(folder);
  const auto shell = [&](const std::string& arguments, const std::string& streams) {
    const int status =
        std::system(("cd '" + (folder / "") + "' && '" COPSE_PROGRAM "' " + arguments + " " + streams).c_str());
    return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
  };
  const std::string noted = "render small.toml -o x.exr --size 8x8 --spp 1 --device cpu --threads 1024";
  for (const char* streams : {"2>/dev/full >/dev/null", "2>&- >/dev/null", "2>/dev/full >/dev/full", ">&- 2>&-"}) {
    INFO(streams);
    const bool lost = std::string(streams).find(">/dev/null") == std::string::npos;
    std::filesystem::remove(folder / "x.exr");
    CHECK(shell(noted, streams) == (lost ? 2 : 0));
    CHECK(readExr(folder / "x.exr").width == 8);
    CHECK(shell(noted + " --quiet", streams) == 0);
    CHECK(shell("render nofile.obj", streams) == 2);
    CHECK(shell("paint", streams) == 2);
    CHECK(shell("list parameters", streams) == (lost ? 2 : 0));
    CHECK(shell("compare x.exr x.exr", streams) == (lost ? 2 : 0));
  }
}
