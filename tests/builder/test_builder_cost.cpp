// The cost of trees of the paper's own meshes, where COPSE_SCENES names them. docs/cost.md has the same figures beside
// the paper's.

#include "tests/support/builder_checks.h"
#include "tests/support/catch.h"
#include "tests/support/devices.h"
#include "tests/support/real_meshes.h"
#include "tracer/scene/scene.h"

using namespace copse;

TEST_CASE("trees of the classic meshes cost what they should", "[medium]") {
  // By leaf.rule = count, lbvh of Sponza and Crytek Sponza and sah of Sponza were computed apart from this project too:
  // 261, 281 and 198. The rest holds what was measured once, so that a change shows.
  struct Expected {
    const char *file, *builder, *rule;
    double cost;
  };
  const Expected all[] = {
      {"sponza/sponza.obj", "lbvh", "count", 260.5},        {"sponza/sponza.obj", "lbvh", "sah", 245.7},
      {"sponza/sponza.obj", "sah", "count", 198.4},         {"sponza/sponza.obj", "sah", "sah", 184.4},
      {"sibenik/sibenik.obj", "lbvh", "count", 175.6},      {"sibenik/sibenik.obj", "lbvh", "sah", 161.8},
      {"sibenik/sibenik.obj", "sah", "count", 140.8},       {"sibenik/sibenik.obj", "sah", "sah", 129.0},
      {"crytek-sponza/sponza.obj", "lbvh", "count", 280.8}, {"crytek-sponza/sponza.obj", "lbvh", "sah", 270.0},
      {"crytek-sponza/sponza.obj", "sah", "count", 217.1},  {"crytek-sponza/sponza.obj", "sah", "sah", 198.3}};
  const Device device = test::chosenDevice();
  std::string loaded;
  test::TestMesh mesh;
  int checked = 0;
  for (const Expected& expected : all) {
    const std::string file = test::realMeshForCosts(expected.file);
    if (file.empty()) continue;
    ++checked;
    if (file != loaded) {
      const Scene scene = loadScene(file);
      mesh = {file, scene.positions, scene.triangles};
      loaded = file;
    }
    INFO(expected.builder << " of " << expected.file << ", leaf.rule " << expected.rule);
    Parameters parameters;
    parameters.set("leaf.rule", std::string(expected.rule));
    const Bvh bvh = test::treeOf(device, mesh, expected.builder, parameters);
    test::requireValid(device, bvh, mesh, 8);
    CHECK(statistics(device, bvh, parameters).sahCost == Approx(expected.cost).epsilon(0.002));
  }
  if (checked == 0) test::skipTest("none of the meshes is there");
}
