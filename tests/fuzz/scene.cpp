// A scene TOML beside the small room's files. A generator makes as many triangles as it is asked for, so files that ask
// for more than a few are left out.
#include <toml++/toml.h>

#include "tests/fuzz/meshes.h"

using namespace copse::fuzz;

namespace {

bool asksForMuch(std::string_view text) {
  try {
    const toml::table root = toml::parse(text);
    const toml::array* meshes = root["mesh"].as_array();
    if (!meshes) return false;
    bool much = meshes->size() > 200;
    for (const toml::node& mesh : *meshes)
      if (const toml::table* table = mesh.as_table(); table && table->contains("generator"))
        much |= !(*table)["triangles"].is_number() || (*table)["triangles"].value_or(0.0) > 20'000;
    return much;
  } catch (const toml::parse_error&) {
    return false;
  }
}

}  // namespace

extern "C" int LLVMFuzzerInitialize(int*, char***) {
  for (const char* name : {"room.obj", "room.mtl", "extra.mtl", "pyramid.ply", "room_instances.txt"})
    write(name, sceneData(name));
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, std::size_t size) {
  if (asksForMuch(text(data, size))) return -1;
  load(write("s.toml", text(data, size)));
  return 0;
}
