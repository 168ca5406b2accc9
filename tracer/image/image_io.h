// Images in and out. EXR by OpenEXR; textures and PNG previews by OpenImageIO, which one module alone links.
#pragma once

#include <map>
#include <string>
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
/// The data window of any RGB or luminance EXR, half or float; a missing channel of the three is 0. `attributes`, if
/// not null, receives the string attributes. Throws InputError "FILE: why".
Image readExr(const std::string& file, std::map<std::string, std::string>* attributes = nullptr);
/// The named channel of the same files. Throws InputError "FILE: why", as where there is no such channel.
std::vector<float> readExrChannel(const std::string& file, const std::string& name);

/// By its name.
bool isExr(const std::string& file);

/// True where OpenImageIO is there. The first of its callers loads it, which takes 0.2 s.
bool hasOpenImageIO();
/// "this build does not support OpenImageIO", or what kept it from being loaded; "" where it is there.
std::string whyNoOpenImageIO();
/// 8-bit sRGB preview of linear pixels times 2^exposure. Written whole or not at all. Throws InputError "FILE: why",
/// always where OpenImageIO is not there.
void writePng(const std::string& file, const Image& image, float exposure = 0);
/// A texture in linear RGB: sRGB is decoded for files of whole numbers (8 and 16 bits), float files are taken as
/// linear. Alpha is left out. Without OpenImageIO only EXR files can be read. Throws InputError "FILE: why".
Image readTexture(const std::string& file);

/// Reads every texture of the scene, brought into 0 … 1, and its sky. A texture that cannot be read leaves the
/// material's kd and adds a note; a sky that cannot be read is an InputError. Materials whose textures are the same
/// file share the first; the others stay empty.
void loadTextures(Scene& scene);

}  // namespace copse
