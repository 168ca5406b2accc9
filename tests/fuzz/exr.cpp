// An EXR, as `info`, `compare`, a sky and `render --resume` read it.
#include "tests/fuzz/fuzz.h"
#include "tracer/image/compare.h"
#include "tracer/image/image_io.h"
#include "tracer/session/resume.h"

using namespace copse;
using namespace copse::fuzz;

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, std::size_t size) {
  const std::string file = write("i.exr", text(data, size));
  std::string layer;
  attempt([&] {
    for (const ExrPartFacts& part : readExrFacts(file))
      for (const auto& [name, type] : part.channels) layer = name;
  });
  attempt([&] {
    const Image image = readExr(file);
    if (image.pixels.size() != static_cast<std::size_t>(image.width) * static_cast<std::size_t>(image.height))
      finding("an image that is not whole");
    if (image.pixels.size() <= 1024) compareImages(image, image);  // Half a second for a hundred times as many.
    texelsOf(image);
  });
  ImageSource source;
  attempt([&] {
    lookForExrLayer(file, layer);
    readExrLayer(file, layer, source);
  });
  attempt([&] { readExrChannel(file, layer); });
  attempt([&] { readFilm(readEarlierRender(file)); });
  return 0;
}
