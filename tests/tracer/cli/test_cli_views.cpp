// Every description in scenes/ whose mesh is available renders through the program, in every view, with light.
#include <algorithm>
#include <filesystem>
#include <set>

#include "tests/support/cases.h"
#include "tests/support/catch.h"
#include "tests/support/devices.h"
#include "tests/support/files.h"
#include "tests/support/program.h"
#include "tests/support/real_meshes.h"
#include "tracer/generators/generators.h"
#include "tracer/image/image_io.h"
#include "tracer/scene/scene.h"

using namespace copse;
using namespace copse::test;
namespace fs = std::filesystem;

namespace {

bool isGenerated(const std::string& name) {
  return std::ranges::any_of(generators(), [&](const GeneratorEntry& entry) { return name == entry.name; });
}

/// Skipped if no folder of COPSE_SCENES has the description's mesh.
void rendersWithLight(const std::string& name) {
  Folder folder;
  const std::string file = COPSE_SOURCE_DIR "/scenes/" + name + ".toml";
  const Ran ran = runCopse(folder / "", {"render", file, "--view", "all", "--size", "32x24", "--spp", "1", "-o",
                                         "x.exr", "--device", deviceOption(), "--quiet"});
  INFO(name << ": " << ran.err);
  if (ran.err.find(": no file '") != std::string::npos) {
    CHECK(ran.status == 2);
    CHECK_FALSE(isGenerated(name));
    return skipTest("no mesh of " + name);
  }
  REQUIRE(ran.status == 0);
  CHECK(folder.fileCount() == 3);
  for (const auto& image : fs::directory_iterator(folder / "")) {
    INFO(image.path().filename());
    double sum = 0;
    int lit = 0;
    for (const vec3& pixel : readExr(image.path()).pixels) {
      const float light = pixel.x + pixel.y + pixel.z;
      REQUIRE((std::isfinite(light) && light >= 0));
      sum += light;
      lit += light > 0;
    }
    CHECK(sum > 0);
    CHECK(lit > 32 * 24 / 20);  // One sample per pixel leaves many dark, but not nearly all.
  }
}

bool isLarge(const std::string& name) {
  const std::set<std::string> large{"hairball",        "happy-buddha",     "laine-hairball", "office",
                                    "plant",           "powerplant-tiled", "san-miguel",     "san-miguel-2",
                                    "san-miguel-full", "soda-hall",        "statue",         "unc-power-plant"};
  return large.count(name) > 0;
}

std::vector<std::string> descriptions(bool large) {
  std::vector<std::string> names;
  std::error_code ignored;  // While tests of a folder that is made later are listed.
  for (const fs::directory_entry& entry : fs::directory_iterator(COPSE_SOURCE_DIR "/scenes", ignored))
    if (entry.path().extension() == ".toml" && isLarge(entry.path().stem()) == large)
      names.push_back(entry.path().stem());
  std::ranges::sort(names);
  return names;
}

const Cases views("every view of a scene description renders with light", "[medium]", descriptions(false),
                  rendersWithLight);
const Cases viewsOfLarge("every view of a description of millions of triangles renders with light", "[slow]",
                         descriptions(true), rendersWithLight);

}  // namespace
