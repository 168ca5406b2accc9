// Every small file of tests/data, cut and changed at thousands of places: it loads whole or it is an InputError.
#include <functional>
#include <random>

#include "tests/support/catch.h"
#include "tests/support/scene_files.h"
#include "tests/support/whole_scene.h"

using namespace copse;
using namespace copse::test;

namespace copse::test {
std::string binaryPyramid(bool big);
}

namespace {

std::string mutate(const std::string& text, std::mt19937& random) {
  std::string changed = text;
  const auto below = [&](std::size_t n) { return random() % std::max<std::size_t>(n, 1); };
  const int changes = 1 + static_cast<int>(below(3));
  for (int i = 0; i < changes && !changed.empty(); ++i) {
    const std::size_t at = below(changed.size());
    static const std::string pieces[] = {"-",     "9",  "0", "/",  " ", "\n", "\t", "nan",
                                         "1e999", "\\", "[", "\"", ".", "#",  "f ", "v "};
    switch (below(6)) {
      case 0:
        changed[at] = static_cast<char>(below(256));
        break;
      case 1:
        changed[at] = static_cast<char>('0' + below(10));
        break;
      case 2:
        changed.erase(at, 1 + below(8));
        break;
      case 3:
        changed.insert(at, pieces[below(std::size(pieces))]);
        break;
      case 4:
        changed.insert(at, changed.substr(below(changed.size()), below(40)));
        break;
      case 5:
        changed[at] ^= static_cast<char>(1 << below(8));
        break;
    }
  }
  return changed;
}

/// Loads `scene` with `name` in the folder changed in every way.
void torment(const std::string& name, const std::string& scene, int mutants, const std::string& given = "") {
  const SceneFolder folder;
  for (const std::string other :
       {"room.obj", "room.mtl", "extra.mtl", "room_instances.txt", "room.toml", "room_instances.toml", "pyramid.ply"})
    folder.write(other, bytesOf(sceneData(other)));
  const std::string text = given.empty() ? bytesOf(sceneData(name)) : given;
  std::mt19937 random(20'13);
  std::size_t loaded = 0, refused = 0;
  const auto tryOne = [&](const std::string& variant) {
    folder.write(name, variant);
    try {
      const bool whole = isWhole(loadScene(folder.file(scene)));
      if (!whole) FAIL("a scene that is not whole from " << name << ":\n" << variant);
      ++loaded;
    } catch (const InputError& error) {
      if (std::string(error.what()).find(':') == std::string::npos) FAIL("no place in: " << error.what());
      ++refused;
    }
  };
  for (std::size_t size = 0; size < text.size(); ++size) tryOne(text.substr(0, size));
  for (int i = 0; i < mutants; ++i) tryOne(mutate(text, random));
  INFO(name << ": " << loaded << " loaded, " << refused << " refused");
  CHECK(loaded > 0);
  CHECK((refused > 0) == !name.ends_with(".mtl"));  // No line of a library is an error.
}

}  // namespace

TEST_CASE("a changed OBJ or MTL loads or is refused") {
  torment("room.obj", "room.obj", 3000);
  torment("room.mtl", "room.obj", 2000);
  torment(
      "room.mtl", "room.obj", 1000,
      "newmtl tiles\nKd 1e 0.5D0 .2f\nmap_Kd -s 2 2 8 -clamp on \"MAPS\\tiles one.png\" -o 1 # c\nTr 0.5\nmap_Ke a\n"
      "NEWMTL lamp\nKe 10\nmap_d -imfchan m a.png\nillum 7\nnewmtl\nPm 1\n");
}

TEST_CASE("a changed PLY loads or is refused") {
  torment("pyramid.ply", "pyramid.ply", 2000);
  torment("binary.ply", "binary.ply", 2000, binaryPyramid(false));
  torment("binary.ply", "binary.ply", 2000, binaryPyramid(true));
  const std::string faces = "4 0 1 2 3 8 0 0 1 0 1 1 0 1 1\n3 0 1 2 6 0 0 1 0 1 1 -1\n";
  const std::string vertices = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n";
  const std::string vertex = "element vertex 4\nproperty float x\nproperty float y\nproperty float z\n";
  const std::string face =
      "element face 2\nproperty list uchar int vertex_indices\nproperty list uchar float texcoord\n"
      "property int texnumber\n";
  const std::string head = "ply\nformat ascii 1.0\ncomment TextureFile a.png\ncomment TextureFile b.png\n";
  torment("a.ply", "a.ply", 1500, head + vertex + face + "end_header\n" + vertices + faces);
  torment("a.ply", "a.ply", 1500, head + face + vertex + "end_header\n" + faces + vertices);
}

TEST_CASE("a changed scene TOML or instance file loads or is refused") {
  torment("room.toml", "room.toml", 3000);
  torment("room_instances.toml", "room_instances.toml", 2000);
  torment("room_instances.txt", "room_instances.toml", 2000);
}
