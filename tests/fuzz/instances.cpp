// A file of instances, of the small room.
#include "tests/fuzz/meshes.h"

using namespace copse::fuzz;

extern "C" int LLVMFuzzerInitialize(int*, char***) {
  write("room.obj", sceneData("room.obj"));
  write("room.mtl", sceneData("room.mtl"));
  write("extra.mtl", sceneData("extra.mtl"));
  write("s.toml", "[[mesh]]\nfile = 'room.obj'\ninstances = 'i.txt'\n");
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, std::size_t size) {
  write("i.txt", text(data, size));
  load(folder() / "s.toml");
  return 0;
}
