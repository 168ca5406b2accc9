// Whether loading grows with the number of what a scene has many of, and not with its square: a Markdown table of
// processor times at two sizes. A program, not a test.
#include <fmt/format.h>

#include <ctime>
#include <functional>

#include "tests/support/files.h"
#include "tracer/cli/command_line.h"
#include "tracer/scene/io/assemble.h"

using namespace copse;
using namespace copse::test;

namespace {

const std::string corners = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";

/// A library of `count` textures, none of which is there, each used by a triangle.
void loadTextured(const Folder& folder, int count) {
  std::string library, mesh = "mtllib a.mtl\n" + corners;
  for (int i = 0; i < count; ++i) {
    library += fmt::format("newmtl m{0}\nmap_Kd t{0}.exr\n", i);
    mesh += fmt::format("usemtl m{}\nf 1 2 3\n", i);
  }
  putBytes(folder / "a.mtl", library);
  putBytes(folder / "a.obj", mesh);
  loadScene(folder / "a.obj");
}

/// The library is named again before every triangle.
void loadRepeated(const Folder& folder, int count) {
  std::string library, mesh = corners;
  for (int i = 0; i < count; ++i) {
    library += fmt::format("newmtl m{}\nKd 0.5 0.5 0.5\n", i);
    mesh += fmt::format("mtllib a.mtl\nusemtl m{}\nf 1 2 3\n", i);
  }
  putBytes(folder / "a.mtl", library);
  putBytes(folder / "a.obj", mesh);
  loadScene(folder / "a.obj");
}

void leaveOutAll(const Folder&, int count) {
  Scene scene;
  std::vector<std::string> names;
  scene.positions.resize(3);
  for (int i = 0; i < count; ++i) {
    names.push_back(fmt::format("material {}", i));
    scene.materials.push_back({.name = names.back()});
    scene.triangles.push_back({0, 1, 2});
    scene.materialOf.push_back(static_cast<uint32_t>(i));
  }
  leaveOutMaterials(scene, names, "here");
}

}  // namespace

int main(int argc, char** argv) {
  copse::cli::Program program("Times to load scenes of many textures, libraries and materials", "bench_loading");
  int few = 2000, times = 16;
  program.option("--count", few).range(1, 1000000);
  program.option("--times", times).range(2, 1000);
  if (const auto status = program.parse(argc, argv)) return *status;
  const std::pair<const char*, void (*)(const Folder&, int)> rows[] = {
      {"a library of textures", loadTextured},
      {"a library named before every triangle", loadRepeated},
      {"materials left out", leaveOutAll}};
  fmt::print("| | ms for {} | for {} times as many, over that |\n|---|--:|--:|\n", few, times);
  try {
    for (const auto& [name, load] : rows) {
      double ms[2];
      for (const bool isLarge : {false, true}) {
        const Folder folder;
        const std::clock_t begin = std::clock();
        load(folder, isLarge ? few * times : few);
        ms[isLarge] = 1000.0 * static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
      }
      fmt::print("| {} | {:.1f} | {:.1f} |\n", name, ms[0], ms[1] / ms[0]);
    }
  } catch (const std::exception& error) {
    fmt::print(stderr, "error: {}\n", error.what());
    return 2;
  }
  return 0;
}
