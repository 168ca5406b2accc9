// Scenes as files: writing OBJ and reading it back, and the descriptions in scenes/.
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <optional>

#include "builder/base/error.h"
#include "tests/support/catch.h"
#include "tests/support/files.h"
#include "tests/support/real_meshes.h"
#include "tracer/generators/generators.h"

using namespace copse;
using namespace copse::test;
namespace fs = std::filesystem;

namespace {

/// The same triangles in the same order, to the last bit, with the same colours.
void checkSame(const Scene& a, const Scene& b) {
  REQUIRE(a.triangles.size() == b.triangles.size());
  std::size_t moved = 0, recoloured = 0;
  for (std::size_t i = 0; i < a.triangles.size(); ++i) {
    for (int k = 0; k < 3; ++k) moved += a.positions[a.triangles[i][k]] != b.positions[b.triangles[i][k]];
    const Material &ma = a.materials[a.materialOf[i]], &mb = b.materials[b.materialOf[i]];
    recoloured += ma.kd != mb.kd || ma.ke != mb.ke;
  }
  CHECK(moved == 0);
  CHECK(recoloured == 0);
}

/// A variable of the environment, put back at the end.
class Environment {
 public:
  Environment(const char* name, const char* value) : name_(name) {
    if (const char* old = std::getenv(name)) old_ = old;
    value ? ::setenv(name, value, 1) : ::unsetenv(name);
  }
  ~Environment() { old_ ? ::setenv(name_, old_->c_str(), 1) : ::unsetenv(name_); }

 private:
  const char* name_;
  std::optional<std::string> old_;
};

std::vector<fs::path> descriptions() {
  std::vector<fs::path> files;
  for (const fs::directory_entry& entry : fs::directory_iterator(COPSE_SOURCE_DIR "/scenes"))
    if (entry.path().extension() == ".toml") files.push_back(entry.path());
  std::ranges::sort(files);
  return files;
}

}  // namespace

TEST_CASE("a generated scene written as OBJ reads back as the same triangles in the same order") {
  Folder folder;
  for (const auto& [name, triangles] : {std::pair{"atrium", 12'000u}, {"cornell", 200u}, {"hairball", 2'880u}}) {
    const Scene scene = findGenerator(name).generate(triangles, 3);
    writeObj(scene, folder / "scene.obj");
    checkSame(scene, loadScene(folder / "scene.obj"));
  }
  CHECK(std::distance(fs::directory_iterator(folder / ""), {}) == 2);
}

TEST_CASE("texture coordinates, texture files and awkward material names survive writing as OBJ") {
  Folder folder;
  fs::create_directory(folder / "maps");
  Scene scene;
  scene.name = "two";
  scene.positions = {{0, 0, 0}, {1.0f / 3, -0.0f, 1e-30f}, {0, 1e6f, 0}, {1, 1, 16777217.0f}};
  scene.triangles = {{0, 1, 2}, {2, 1, 3}, {0, 2, 3}};
  scene.materialOf = {0, 1, 2};
  scene.uvs = {{0, 0}, {0.1f, 0.7f}, {-3, 2}};
  scene.uvTriangles = {{0, 1, 2}, {2, 1, 0}, {1, 1, 1}};
  scene.materials = {{.name = "red clay", .kd = {0.1f, 0.2f, 0.3f}},
                     {.name = "red_clay", .kd = {0.4f, 0.5f, 0.6f}, .ke = {7, 8, 9}},
                     {.name = "", .kd = {0.7f, 0.8f, 0.9f}, .texture = 0}};
  scene.textures = {{.file = folder / "maps/bricks.png", .texels = {}}};
  std::ofstream(folder / "maps/bricks.png") << "unread";
  writeObj(scene, folder / "two.obj");
  const Scene back = loadScene(folder / "two.obj");
  checkSame(scene, back);
  REQUIRE(back.uvTriangles.size() == 3);
  for (std::size_t i = 0; i < 3; ++i)
    for (int k = 0; k < 3; ++k) CHECK(back.uvs[back.uvTriangles[i][k]] == scene.uvs[scene.uvTriangles[i][k]]);
  REQUIRE(back.materials[back.materialOf[2]].texture == 0);
  CHECK(fs::equivalent(back.textures[0].file, folder / "maps/bricks.png"));
}

TEST_CASE("OBJ files are written whole or not at all, and never under another ending") {
  Folder folder;
  const Scene scene = findGenerator("cornell").generate(38, 1);
  CHECK_THROWS_WITH(writeObj(scene, folder / "none/scene.obj"), Contains("none/scene.obj"));
  CHECK_THROWS_AS(writeObj(scene, folder / "scene.mtl"), InputError);
  fs::create_directory(folder / "taken.obj");
  CHECK_THROWS_AS(writeObj(scene, folder / "taken.obj"), InputError);
  fs::create_directory(folder / "half.mtl");
  CHECK_THROWS_AS(writeObj(scene, folder / "half.obj"), InputError);
  CHECK(std::distance(fs::directory_iterator(folder / ""), {}) == 2);
}

TEST_CASE("every description in scenes/ is sound up to the meshes that it names", "[medium]") {
  const Environment none("COPSE_SCENES", nullptr);
  std::size_t generated = 0;
  for (const fs::path& file : descriptions()) {
    INFO(file.filename());
    if (file.stem() == "plant") {  // Twelve million triangles; its generator is seen to at smaller sizes.
      ++generated;
      continue;
    }
    // Lights, views and keys are checked before a mesh is looked for.
    try {
      const Scene scene = loadScene(file.string());
      ++generated;
      CHECK(scene.name == file.stem());
      CHECK(scene.cameras.size() == 3);
      CHECK(scene.notes.empty());
    } catch (const InputError& error) {
      CHECK_THAT(error.what(), Contains(": no file '"));
    }
  }
  CHECK(generated == generators().size());
  CHECK(descriptions().size() >= 24);
}

TEST_CASE("the classic meshes load with three views inside them and lights that face them", "[medium]") {
  if (!std::getenv("COPSE_SCENES")) return skipTest("COPSE_SCENES names no folder with the classic meshes");
  int checked = 0;
  for (const fs::path& file : descriptions()) {
    const std::string name = file.stem().string();
    // Millions of triangles, and the same lights and views as their smaller fellows or read in seconds each.
    if (std::ranges::any_of(generators(), [&](const GeneratorEntry& entry) { return name == entry.name; })) continue;
    if (name == "san-miguel" || name == "san-miguel-full" || name == "powerplant-tiled") continue;
    INFO(name);
    Scene scene;
    try {
      scene = loadScene(file.string());
    } catch (const InputError& error) {
      CHECK_THAT(error.what(), Contains(": no file '"));
      std::cout << "left out: " << name << ": its mesh is not there\n";
      continue;
    }
    ++checked;
    const Box box = scene.bounds();
    CHECK(scene.cameras.size() == 3);
    CHECK(scene.emitterCount() > 0);
    const float size = glm::length(box.hi - box.lo);
    for (const Camera& camera : scene.cameras) CHECK(glm::length(camera.eye - 0.5f * box.centre2()) < 1.2f * size);
    for (const QuadLight& quad : scene.quads) {
      const vec3 middle = quad.corner + 0.5f * (quad.edgeU + quad.edgeV);
      // Down into the scene, or along it where the light stands inside.
      const vec3 normal = glm::normalize(glm::cross(quad.edgeU, quad.edgeV));
      CHECK((normal.y < -0.3f || glm::dot(normal, 0.5f * box.centre2() - middle) > 0 || name == "crytek-sponza"));
    }
  }
  if (checked == 0) skipTest("none of the classic meshes is there");
}
