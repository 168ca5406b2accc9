// The builders that start from sorted Morton codes beside lbvh: what each of them must keep of the order and the tree.
#include "tests/support/builder_checks.h"
#include "tests/support/catch.h"
#include "tests/support/devices.h"

using namespace copse;

TEST_CASE("one pass from the leaves up makes the radix tree, node for node") {
  for (const Device& device : test::devices())
    for (const std::string& name : test::inputNames())
      for (const uint32_t size : test::inputSizes()) {
        INFO(name << ", " << size << " triangles, " << device.name);
        const test::TestMesh mesh = test::makeInput(name, size);
        const OpenTree down = test::rawTreeOf(device, mesh, "lbvh"), up = test::rawTreeOf(device, mesh, "lbvh-apetrei");
        const bool sameNodes = test::bitsOf(up) == test::bitsOf(down);
        REQUIRE(sameNodes);
        const bool sameParents = up.parents.toHost(up.nodeCount) == down.parents.toHost(down.nodeCount);
        REQUIRE(sameParents);
      }
}

TEST_CASE("walks from the leaves that meet in any order make one tree") {
  // Short codes leave many equal ones, which the places alone tell apart.
  Parameters shortCodes;
  shortCodes.set("morton.bits=2");
  for (const Parameters& parameters : {Parameters{}, shortCodes}) {
    const test::TestMesh mesh = test::makeInput("random", 50000);
    const Device one = openDevice("cpu", 1);
    const auto expected = test::bitsOf(test::rawTreeOf(one, mesh, "lbvh", parameters));
    for (int round = 0; round < 10; ++round) {
      const bool same =
          test::bitsOf(test::rawTreeOf(test::withThreads(one, 8), mesh, "lbvh-apetrei", parameters)) == expected;
      REQUIRE(same);
    }
  }
}
