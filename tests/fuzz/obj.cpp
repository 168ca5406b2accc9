// An OBJ, and after the first byte 30 (the control character "record separator") its library.
#include "tests/fuzz/meshes.h"

using namespace copse::fuzz;

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, std::size_t size) {
  const std::string_view both = text(data, size);
  const std::size_t end = both.find('\x1e');
  // Whatever the mtllib line calls it, NAME.mtl beside NAME.obj is found.
  write("m.mtl", end == std::string_view::npos ? "" : both.substr(end + 1));
  load(write("m.obj", both.substr(0, end)));
  return 0;
}
