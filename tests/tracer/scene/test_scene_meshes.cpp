// The real meshes, where COPSE_SCENES names them: as many triangles as their sources say.
#include "tests/support/catch.h"
#include "tests/support/real_meshes.h"
#include "tests/support/scene_files.h"

using namespace copse;
using namespace copse::test;

TEST_CASE("the classic meshes have as many triangles as their sources say", "[medium]") {
  struct Expected {
    const char* file;
    std::size_t triangles, materials, emitting;
  };
  const Expected all[] = {{"sponza/sponza.obj", 66'450, 20, 0},
                          {"sibenik/sibenik.obj", 75'284, 17, 0},
                          {"crytek-sponza/sponza.obj", 262'267, 25, 0},
                          {"powerplant-partial/powerplant_sec456.obj", 333'206, 1, 0},
                          {"cornell-box/CornellBox-Empty-RG.obj", 12, 6, 2},
                          {"cornell-box/CornellBox-Original.obj", 36, 8, 2},
                          {"cornell-box/CornellBox-Mirror.obj", 36, 8, 2},
                          {"cornell-box/CornellBox-Sphere.obj", 2188, 8, 2}};
  int checked = 0;
  for (const Expected& expected : all) {
    const std::string file = realMesh(expected.file);
    if (file.empty()) continue;
    ++checked;
    INFO(file);
    const Scene scene = loadScene(file);
    CHECK(scene.triangles.size() == expected.triangles);
    CHECK(scene.materials.size() == expected.materials);
    std::size_t emitting = 0;
    for (std::size_t i = 0; i < scene.triangles.size(); ++i) emitting += scene.emits(i);
    CHECK(emitting == expected.emitting);
    CHECK_FALSE(hasNote(scene, "dropped"));
  }
  if (checked == 0) skipTest("none of the meshes is there");
}

TEST_CASE("San Miguel has the triangles of its instances", "[slow]") {
  if (realMesh("san-miguel/sanmiguel_meshes.obj").empty()) return skipTest("no San Miguel");
  const SceneFolder folder;
  const std::string sanMiguel =
      "[[mesh]]\nfile = 'san-miguel/sanmiguel_meshes.obj'\nmaterials = 'san-miguel/sanmiguel.mtl'\n"
      "instances = 'san-miguel/sanmiguel_instances.txt'\n";
  const Scene part = loadScene(folder.write("part.toml", sanMiguel + "instance_lines = 67_534\n"));
  CHECK(part.triangles.size() == 7'882'092);
  CHECK(loadScene(folder.write("all.toml", sanMiguel)).triangles.size() == 9'437'900);
}

TEST_CASE("the tiled power plant has the triangles of its instances", "[slow]") {
  if (realMesh("powerplant-partial/powerplant_sec456.obj").empty()) return skipTest("no power plant");
  const SceneFolder folder;
  CHECK(loadScene(folder.write("plant.toml",
                               "[[mesh]]\nfile = 'powerplant-partial/powerplant_sec456.obj'\ninstances = "
                               "'powerplant-partial/powerplant_tiling_instances.txt'\n"))
            .triangles.size() == 12'661'828);
}
