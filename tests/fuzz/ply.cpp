// A PLY.
#include "tests/fuzz/meshes.h"

using namespace copse::fuzz;

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, std::size_t size) {
  load(write("m.ply", text(data, size)));
  return 0;
}
