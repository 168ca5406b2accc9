// What stands in for oiio.cpp in a build without OpenImageIO: EXR files are still read and written.
#include "builder/parallel/error.h"
#include "tracer/image/image_io.h"
#include "tracer/image/oiio.h"

namespace copse {

bool hasOpenImageIO() { return false; }

void writePng(const std::string& file, const Image&, float) {
  throw InputError(file + ": cannot be written: this build has no OpenImageIO, which writes PNG");
}

Image readByOpenImageIO(const std::string& file) {
  throw InputError(file + ": cannot be read: this build has no OpenImageIO, which reads all but EXR");
}

}  // namespace copse
