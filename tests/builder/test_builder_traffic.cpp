// What a build asks of the host: launches, waits and allocations, which are what takes time on a GPU where scenes are
// small. The bounds are the counts themselves, so that nobody adds a wait unseen; docs/gpu.md says what each is for.

#include "builder/parallel/timeline.h"
#include "builder/parallel/traffic.h"
#include "tests/support/builder_checks.h"
#include "tests/support/catch.h"
#include "tests/support/devices.h"

using namespace copse;

namespace {

struct Most {
  const char* builder;
  int launches;
  uint64_t waits, allocations;
};

}  // namespace

TEST_CASE("No builder launches, waits or allocates more than it has to") {
  const std::vector<Most> rows = {
      {"lbvh", 7, 1, 11},       {"lbvh-apetrei", 7, 1, 12}, {"hlbvh", 81, 3, 24},     {"trbvh", 18, 1, 17},
      {"atrbvh", 14, 1, 16},    {"kmeans-q1", 49, 6, 23},   {"kmeans-q2", 57, 5, 24}, {"kmeans-q3", 63, 4, 24},
      {"kmeans-q4", 65, 3, 23}, {"kmeans-q5", 85, 3, 24},
  };
  const test::TestMesh mesh = test::makeInput("random", 20000);
  for (const Device& device : test::devices())
    for (const Most& most : rows) {
      const BuilderEntry& builder = findBuilder(most.builder);
      const test::DeviceMesh onDevice(device, mesh);
      Timeline timeline(device);
      const Traffic before = trafficSoFar();
      const Bvh bvh = buildBvh(device.recording(timeline), onDevice.view(), builder, withPreset(builder, {}));
      const Traffic after = trafficSoFar();
      int launches = 0;
      for (const PhaseTime& phase : timeline.phases()) launches += phase.launches;
      CAPTURE(most.builder, device.name);
      CHECK(launches <= most.launches);
      CHECK(after.waits - before.waits <= most.waits);
      // On CUDA sorts, large scans and layout have memory of their own.
      CHECK(after.allocations - before.allocations <= most.allocations + (device.isCuda() ? 12 : 0));
    }
}
