// tracer/accel/tracers: names, what auto resolves to, and which combinations are refused.
#include "tracer/accel/tracers.h"

#include "builder/base/error.h"
#include "builder/build.h"
#include "tests/support/catch.h"
#include "tests/support/devices.h"
#include "tests/support/embree.h"
#include "tests/support/trees.h"
#include "tracer/accel/binary.h"
#include "tracer/accel/wide8.h"

using namespace copse;
using namespace copse::test;

TEST_CASE("an unknown tracer is refused with the available names") {
  CHECK_THROWS_WITH(findTracer("bvh16"),
                    Contains("unknown tracer 'bvh16'") && Contains("(available: auto, binary, wide8"));
  CHECK_THROWS_AS(TracerChoice(""), InputError);
  CHECK(TracerChoice("auto").isAuto());
  CHECK(TracerChoice().name() == std::string("auto"));
  for (const TracerEntry& entry : tracers()) CHECK(TracerChoice(entry.name).name() == std::string(entry.name));
}

TEST_CASE("auto is wide8 on the CPU and binary on CUDA, whatever the tree") {
  const TestMesh mesh = makeInput("random", 200);
  for (const Device& device : devices()) {
    const DeviceMesh there(device, mesh);
    for (const char* setting : {"kmeans.arity=2", "kmeans.arity=4"}) {
      Parameters parameters;
      parameters.set(setting);
      const BuilderEntry& builder = findBuilder("kmeans");
      const Bvh tree = buildBvh(device, there.view(), builder, withPreset(builder, parameters));
      const auto tracer = makeTracer(device, tree, there.view());
      CHECK(tracer->name() == std::string(device.isCuda() ? "binary" : "wide8"));
      for (const char* name : {"binary", "wide8"})
        CHECK(makeTracer(device, tree, there.view(), name)->name() == std::string(name));
    }
  }
}

TEST_CASE("a tracer that builds its own trees takes no other's, and they take no other tracer") {
  if (!hasEmbree()) return;
  const Device cpu = openDevice("cpu");
  const TreeSource own = findTreeSource("embree-medium");
  CHECK(TracerChoice().resolve(cpu, own).name == std::string("embree"));
  CHECK(TracerChoice("embree").resolve(cpu, own).name == std::string("embree"));
  CHECK_THROWS_WITH(TracerChoice("wide8").check(own), Contains("embree-medium") && Contains("a tree of embree"));
  CHECK_THROWS_WITH(TracerChoice("embree").check(findTreeSource("lbvh")),
                    Contains("cannot trace that of lbvh") && Contains("embree-low, embree-medium or embree-high"));
  CHECK(TracerChoice().isOnCpuOnly(own));
  CHECK_FALSE(TracerChoice().isOnCpuOnly(findTreeSource("lbvh")));
}

TEST_CASE("a tracer keeps only nodes of its own format") {
  const Device cpu = openDevice("cpu");
  const TestMesh mesh = makeInput("random", 2000);
  const Bvh tree = medianTree(cpu, mesh, 4);
  const auto shared = mesh.count() * sizeof(TraversalTriangle) + sizeof(Box);
  const auto binary = Binary::build(cpu, tree, mesh.hostView());
  CHECK(makeTracer(cpu, tree, mesh.hostView(), "binary")->bytes() == shared + binary.nodes.size() * (64 + 4));
  const auto wide = Wide8::build(cpu, tree, mesh.hostView());
  CHECK(makeTracer(cpu, tree, mesh.hostView(), "wide8")->bytes() ==
        wide.blocks.size() * sizeof(TriangleBlock) + sizeof(Box) + wide.nodes.size() * (256 + 4));
  CHECK(4 * wide.blocks.size() < 2 * mesh.count());
  CHECK(3 * wide.nodes.size() < binary.nodes.size());
}
