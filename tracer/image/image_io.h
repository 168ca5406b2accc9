// Images in and out. EXR by OpenEXR; textures and PNG previews by OpenImageIO, which one module alone links.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "tracer/scene/image.h"
#include "tracer/scene/scene.h"

namespace copse {

/// What an EXR file holds beside its RGB, a float a pixel, row by row. Layers are named as OpenEXR has them:
/// "layer.component".
struct Channel {
  std::string name;
  std::vector<float> values;
};

/// 32-bit float RGB and further channels, with string attributes. Written whole or not at all. Throws InputError
/// "FILE: why".
void writeExr(const std::string& file, const Image& image, const std::map<std::string, std::string>& attributes,
              const std::vector<Channel>& channels = {});

/// Where the pixels of an Image come from.
struct ImageSource {
  std::string layer;     ///< Of an EXR; "" for channels without one.
  std::string channels;  ///< Of an EXR: "R, G, B"; "" otherwise.
  std::string transfer;  ///< How numbers became light, "8-bit sRGB"; "" for an EXR.
  std::string window;    ///< Of an EXR whose data window is not the display window: what both are; otherwise "".
  bool isPlain = true;   ///< Linear RGB or luminance of a single picture: nothing had to be chosen.
  std::map<std::string, std::string> attributes;  ///< The strings that an EXR carries.
};

/// The display window of an EXR: black where the data window leaves it out. Half, float and whole numbers, scan lines
/// and tiles; of several layers the one that exr_layers.h says, a missing channel of the three is 0. Deep pixels are
/// an error. `attributes`, if not null, receives the string attributes. Throws InputError "FILE: why".
Image readExr(const std::string& file, std::map<std::string, std::string>* attributes = nullptr);
/// The same of a layer or a channel by its name; "" for what readExr() reads.
Image readExrLayer(const std::string& file, const std::string& layer, ImageSource& source);
struct ExrHas {
  bool layer = false;      ///< readExrLayer() finds it.
  std::size_t layers = 0;  ///< Channels without a layer count as one.
};
/// Reads no pixels. Throws InputError "FILE: why".
ExrHas lookForExrLayer(const std::string& file, const std::string& layer);
/// The named channel of the same files, in its data window. Throws InputError "FILE: why", as where there is no such
/// channel.
std::vector<float> readExrChannel(const std::string& file, const std::string& name);

/// What an EXR says of a part before its pixels.
struct ExrPartFacts {
  std::string name;
  bool deep = false, tiled = false;
  int64_t width = 0, height = 0;                              ///< Of the display window.
  std::string window;                                         ///< The data window where it is another; otherwise "".
  std::vector<std::pair<std::string, std::string>> channels;  ///< Names, and half, float or uint.
  std::map<std::string, std::string> attributes;              ///< Strings alone.
};
/// Reads no pixels, and so deep files too. Throws InputError "FILE: why", as where parts of the file are missing.
std::vector<ExrPartFacts> readExrFacts(const std::string& file);

/// By its name, or by its first bytes.
bool isExr(const std::string& file);

/// True where OpenImageIO is there. The first of its callers loads it, which takes 0.2 s.
bool hasOpenImageIO();
/// "this build does not support OpenImageIO", or what kept it from being loaded; "" where it is there.
std::string whyNoOpenImageIO();
/// 8-bit sRGB preview of linear pixels times 2^exposure. Written whole or not at all. Throws InputError "FILE: why",
/// always where OpenImageIO is not there.
void writePng(const std::string& file, const Image& image, float exposure = 0);
/// Any image as linear light: whole numbers are taken as sRGB, floats as linear. Alpha is left out. An EXR is told by
/// its first bytes as well; without OpenImageIO nothing else can be read. `layer` is that of an EXR and means nothing
/// for other files. Throws InputError "FILE: why".
Image readImage(const std::string& file, const std::string& layer = "", ImageSource* source = nullptr);

/// A texture in 0 … 1: 8 bits a channel stay as they are, everything else becomes halves. `linear`: whole numbers are
/// not sRGB. Throws as readImage().
Texels readTexels(const std::string& file, bool linear = false);
/// The same of pixels; NaN is 0.
Texels texelsOf(const Image& image);

/// Reads every texture of the scene, brought into 0 … 1, and its sky. A texture that cannot be read leaves the
/// material's kd and adds a note; a sky that cannot be read is an InputError. Materials whose textures are the same
/// file share the first; the others stay empty.
void loadTextures(Scene& scene);

}  // namespace copse
