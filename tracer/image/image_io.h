// Images in and out. EXR by OpenEXR; textures and PNG previews by OpenImageIO, which one file alone links.
#pragma once

#include <map>
#include <string>

#include "tracer/scene/image.h"
#include "tracer/scene/scene.h"

namespace copse {

/// 32-bit float RGB, with string attributes. Written whole or not at all. Throws InputError "FILE: why".
void writeExr(const std::string& file, const Image& image, const std::map<std::string, std::string>& attributes);
/// Any RGB or luminance EXR, half or float. `attributes`, if not null, receives the string attributes.
Image readExr(const std::string& file, std::map<std::string, std::string>* attributes = nullptr);

/// True where this build has OpenImageIO.
bool hasOpenImageIO();
/// sRGB preview of linear pixels times 2^exposure. Written whole or not at all.
void writePng(const std::string& file, const Image& image, float exposure = 0);
/// A texture in linear RGB: sRGB is decoded for 8-bit files, float files are taken as linear.
Image readTexture(const std::string& file);

/// Reads every texture of the scene and its sky. A missing texture leaves the material's kd and adds a note.
void loadTextures(Scene& scene);

}  // namespace copse
