// The program's memory, as the system counts it: it grows with the image's pixels by the size of a film and an image,
// and with nothing else.

#include <signal.h>
#include <unistd.h>

#include "builder/parallel/device.h"
#include "tests/support/catch.h"
#include "tests/support/files.h"
#include "tests/support/program.h"
#include "tests/support/small_scene.h"
#include "tracer/integrators/path/queues.h"

using namespace copse;
using namespace copse::test;

namespace {

constexpr double mib = 1 << 20;

std::vector<std::string> rendering(const std::string& size, const std::string& spp) {
  return {"render",      "small.toml", "-o",       "x.exr", "--size",    size, "--spp",  spp,
          "--max-depth", "0",          "--device", "cpu",   "--threads", "2",  "--quiet"};
}

double peakOf(const Folder& folder, const std::string& size, const std::string& spp) {
  const Ran ran = runCopse(folder / "", rendering(size, spp));
  INFO(ran.err);
  REQUIRE(ran.status == 0);
  return ran.peakBytes;
}

}  // namespace

TEST_CASE("four times the pixels take 24 bytes more per pixel, sixteen times the samples nothing", "[medium]") {
  Folder folder;
  putSmallScene(folder);
  const double small = peakOf(folder, "1024x1024", "1"), large = peakOf(folder, "2048x2048", "1");
  const double pixels = 3 * 1024 * 1024;
  INFO("peaks " << small / mib << " and " << large / mib << " MiB");
  CHECK(large - small > 12 * pixels);  // The film is there, so this measures what it should.
  CHECK(large - small < 24 * pixels + 40 * mib);
  const double few = peakOf(folder, "512x512", "1"), many = peakOf(folder, "512x512", "16");
  INFO("peaks " << few / mib << " and " << many / mib << " MiB");
  CHECK(std::abs(many - few) < 8 * mib);
}

TEST_CASE(
    "the largest image with the most samples starts within its film, the sums' corrections, its order and 200 MiB",
    "[medium]") {
  Folder folder;
  putSmallScene(folder);
  Running running(folder / "", rendering("8192x8192", "1000000"));
  // Until the film and its corrections are there, however slow the machine is, and a little longer.
  const double film = 12.0 * 8192 * 8192, order = 4.0 * 8192 * 8192;
  for (int i = 0; i < 600 && running.peakBytes() < 2 * film && !running.hasEnded(); ++i) ::usleep(100000);
  const double begun = running.processorSeconds();
  for (int i = 0; i < 600 && running.processorSeconds() < begun + 1 && !running.hasEnded(); ++i) ::usleep(100000);
  REQUIRE_FALSE(running.hasEnded());
  running.signal(SIGKILL);
  const double peak = running.wait().peakBytes;
  INFO("peak " << peak / mib << " MiB");
  CHECK(peak > 2 * film);
  CHECK(peak < 2 * film + order + 200 * mib);
}

TEST_CASE("paths in flight are bounded on every device, whatever the image, the samples and the light samples") {
  Device cuda;
  cuda.kind = DeviceKind::cuda;
  for (const Device& device : {openDevice("cpu", 1), openDevice("cpu", 1024), cuda})
    for (const int lightSamples : {1, 2, 64, 4096}) {
      const double limit = (device.isCuda() ? 2500 : 400) * mib;
      const uint64_t work = uint64_t{8192} * 8192 << 20;
      const uint32_t paths = queueCapacity(device, work, lightSamples, 0);
      CHECK(paths >= 256);
      CHECK(paths * (168.0 + 84.0 * lightSamples) < limit);
      CHECK(queueCapacity(device, 100, lightSamples, 0) <= 100);
      CHECK(queueCapacity(device, work, lightSamples, 1000) <= 1000);
      CHECK(queueCapacity(device, work, lightSamples, 1 << 24) * (168.0 + 84.0 * lightSamples) < 2 * limit);
    }
  const uint64_t batch = uint64_t{8} * 1024 * 768;
  CHECK(queueCapacity(cuda, batch, 2, 0) == batch);  // A batch.
}
