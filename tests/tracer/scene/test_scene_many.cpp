// What a scene has many of takes time by its number, not by its square: textures, materials, names of libraries.
#include <algorithm>
#include <ctime>

#include "tests/support/catch.h"
#include "tests/support/files.h"
#include "tracer/scene/io/assemble.h"

using namespace copse;
using namespace copse::test;

namespace {

constexpr int few = 2000, many = 16 * few;

/// Processor time, so that other programs do not count, of `work` for each number. Squares would be 256 times as long.
template <class Work>
void checkGrowth(Work work) {
  double seconds[2];
  for (const bool large : {false, true}) {
    const std::clock_t begin = std::clock();
    work(large ? many : few);
    seconds[large] = static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
  }
  INFO(few << ": " << seconds[0] << " s, " << many << ": " << seconds[1] << " s");
  CHECK(seconds[1] < 40 * std::max(seconds[0], 0.02));
}

const std::string corners = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";

}  // namespace

TEST_CASE("A library of many textures is read in time by their number") {
  const Folder folder;
  checkGrowth([&](int count) {
    std::string library, mesh = "mtllib a.mtl\n" + corners;
    for (int i = 0; i < count; ++i) {
      const std::string number = std::to_string(i);
      library += "newmtl m" + number + "\nmap_Kd t" + number + ".exr\n";
      mesh += "usemtl m" + number + "\nf 1 2 3\n";
    }
    putBytes(folder / "a.mtl", library);
    putBytes(folder / "a.obj", mesh);
    CHECK(loadScene(folder / "a.obj").textures.size() == static_cast<std::size_t>(count));
  });
}

TEST_CASE("A library that is named before every object is read once") {
  const Folder folder;
  checkGrowth([&](int count) {
    std::string library, mesh = corners;
    for (int i = 0; i < count; ++i) {
      library += "newmtl m" + std::to_string(i) + "\nKd 0.5 0.5 0.5\n";
      mesh += "mtllib a.mtl\nusemtl m" + std::to_string(i) + "\nf 1 2 3\n";
    }
    putBytes(folder / "a.mtl", library);
    putBytes(folder / "a.obj", mesh);
    CHECK(loadScene(folder / "a.obj").materials.size() == static_cast<std::size_t>(count));
  });
}

TEST_CASE("Many materials are left out in time by their number") {
  checkGrowth([&](int count) {
    Scene scene;
    std::vector<std::string> names;
    scene.positions.resize(3);
    for (int i = 0; i < count; ++i) {
      names.push_back("material " + std::to_string(i));
      scene.materials.push_back({.name = names.back()});
      scene.triangles.push_back({0, 1, 2});
      scene.materialOf.push_back(static_cast<uint32_t>(i));
    }
    leaveOutMaterials(scene, names, "here");
    CHECK(scene.triangles.empty());
  });
}
