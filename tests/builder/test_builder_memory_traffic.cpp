// What a build asks of the host: launches, waits and allocations, which are what takes time on a GPU where scenes are
// small. The bounds are the counts themselves, so that nobody adds a wait unseen; docs/gpu.md says what each is for.

#include "builder/parallel/memory_traffic.h"
#include "builder/parallel/timeline.h"
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
      {"lbvh", 8, 1, 11},       {"lbvh-apetrei", 8, 1, 12}, {"hlbvh", 84, 3, 25},     {"trbvh", 21, 1, 18},
      {"atrbvh", 17, 1, 17},    {"kmeans-q1", 50, 6, 23},   {"kmeans-q2", 60, 5, 25}, {"kmeans-q3", 66, 4, 25},
      {"kmeans-q4", 66, 3, 23}, {"kmeans-q5", 88, 3, 25},   {"hploc", 10, 1, 15},     {"ploc", 71, 21, 17},
  };
  const test::TestMesh mesh = test::makeInput("random", 20000);
  for (const Device& device : test::devices())
    for (const Most& most : rows) {
      const BuilderEntry& builder = findBuilder(most.builder);
      const test::DeviceMesh onDevice(device, mesh);
      Timeline timeline(device);
      const MemoryTraffic before = memoryTraffic();
      const Bvh bvh = buildBvh(device.recording(timeline), onDevice.view(), builder, withPreset(builder, {}));
      const MemoryTraffic after = memoryTraffic();
      int launches = 0;
      for (const PhaseTime& phase : timeline.phases()) launches += phase.launches;
      CAPTURE(most.builder, device.name);
      CHECK(launches <= most.launches);
      CHECK(after.waits - before.waits <= most.waits);
      // On CUDA sorts and large scans have memory of their own.
      CHECK(after.allocations - before.allocations <= most.allocations + (device.isCuda() ? 12 : 0));
    }
}
