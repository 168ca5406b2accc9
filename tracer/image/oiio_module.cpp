// Loads the module that links OpenImageIO when the first texture or preview asks for it: beside the program's folder,
// where builds and installs put it, or on the program's run path. Where it is not there EXR alone is read and written.
#include <dlfcn.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "builder/base/error.h"
#include "builder/base/files.h"
#include "builder/base/whole_file.h"
#include "builder/parallel/device.h"
#include "tracer/image/image_io.h"
#include "tracer/image/oiio.h"

namespace copse {

namespace {

struct Loaded {
  const OiioModule* module = nullptr;
  std::string why = "this build does not support OpenImageIO";
};

Loaded load() {
  Loaded loaded;
#ifdef COPSE_OIIO_MODULE
  try {
    openDevice("cpu", 8);  // Its libraries start threads as they are loaded, and end the program where they cannot.
  } catch (const DeviceError& error) {
    loaded.why = std::string("cannot load OpenImageIO: ") + error.what();
    return loaded;
  }
  std::error_code ignored;
  const std::filesystem::path name = COPSE_OIIO_MODULE;  // From the program's folder on.
  const std::filesystem::path beside = std::filesystem::read_symlink("/proc/self/exe", ignored).parent_path() / name;
  const bool there = std::filesystem::exists(beside, ignored);
  void* library = ::dlopen(there ? beside.c_str() : name.filename().c_str(), RTLD_LAZY | RTLD_LOCAL);
  if (library) loaded.module = static_cast<const OiioModule*>(::dlsym(library, oiioModuleSymbol));
  if (!loaded.module) loaded.why = std::string("cannot load OpenImageIO: ") + ::dlerror();
#endif
  return loaded;
}

const Loaded& oiio() {
  static const Loaded once = load();
  return once;
}

/// What the module's errors are outside of it.
template <class Call>
auto named(const std::string& file, Call call) {
  try {
    return call();
  } catch (const std::runtime_error& error) {
    throw InputError(file + ": " + error.what());
  }
}

/// IEC 61966-2-1.
float sRgbOf(float l) { return l <= 0.0031308f ? 12.92f * l : 1.055f * std::pow(l, 1 / 2.4f) - 0.055f; }

}  // namespace

bool hasOpenImageIO() { return oiio().module != nullptr; }
std::string whyNoOpenImageIO() { return hasOpenImageIO() ? "" : oiio().why; }

void writePng(const std::string& file, const Image& image, float exposure) {
  if (!hasOpenImageIO()) throw InputError(file + ": cannot write PNG: " + oiio().why);
  if (image.width < 1 || image.height < 1) throw InputError(file + ": cannot write an image without pixels");
  const float scale = std::exp2(exposure);
  std::vector<unsigned char> bytes(3 * image.pixels.size());
  for (std::size_t i = 0; i < image.pixels.size(); ++i)
    for (int c = 0; c < 3; ++c) {
      const float value = image.pixels[i][c] * scale;
      // The comparison sends NaN to 0.
      bytes[3 * i + c] = static_cast<unsigned char>(value > 0 ? std::lround(255 * sRgbOf(std::min(value, 1.0f))) : 0);
    }
  WholeFile whole(file);
  const std::vector<unsigned char> encoded =
      named(file, [&] { return oiio().module->encodePng(image.width, image.height, bytes.data()); });
  whole.write(encoded.data(), encoded.size());
  whole.commit();
}

Decoded decode(const std::string& file) {
  checkFile(file);
  if (!hasOpenImageIO()) throw InputError(file + ": cannot read this format (only EXR): " + oiio().why);
  return named(file, [&] { return oiio().module->read(file); });
}

}  // namespace copse
