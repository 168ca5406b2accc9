// An experiment's TOML: its rows, and its scenes' files looked for.
#include "tracer/bench/experiment.h"
#include "tests/fuzz/fuzz.h"

using namespace copse;
using namespace copse::fuzz;

extern "C" int LLVMFuzzerInitialize(int*, char***) {
  for (const char* name : {"room.obj", "room.mtl", "extra.mtl", "pyramid.ply", "room.toml"})
    write(name, sceneData(name));
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, std::size_t size) {
  const std::string file = write("e.toml", text(data, size));
  attempt([&] { readExperiment(file); });
  return 0;
}
