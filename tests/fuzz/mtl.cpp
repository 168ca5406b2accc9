// A library, of a mesh that uses all its materials.
#include "builder/base/text.h"
#include "tests/fuzz/meshes.h"

using namespace copse;
using namespace copse::fuzz;

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, std::size_t size) {
  std::string mesh = "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nf 1/1 2/2 3/3\n";
  const std::string_view library = text(data, size);
  for (std::size_t at = 0; at < size;) {
    const std::size_t end = std::min(library.find('\n', at), size);
    std::string_view line = library.substr(at, end - at);
    if (lowered(nextWord(line)) == "newmtl") mesh.append("usemtl ").append(trim(line)).append("\nf 1/1 2/2 3/3\n");
    at = end + 1;
  }
  write("m.mtl", library);
  load(write("m.obj", mesh));
  return 0;
}
