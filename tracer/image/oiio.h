// What the module that links OpenImageIO gives, and the one way to it. Its 258 libraries cost 0.2 s to load and start
// threads of their own, so a program that reads no textures and writes no previews never loads it.
#pragma once

#include <string>
#include <vector>

#include "tracer/scene/image.h"

namespace copse {

/// Both throw std::runtime_error with the reason alone.
struct OiioModule {
  /// The first image of any file that OpenImageIO reads, in linear RGB: whole numbers are taken as sRGB, floats as
  /// linear. Alpha is left out and colours are not multiplied by it.
  Image (*read)(const std::string& file);
  /// A PNG file of 8-bit sRGB triples.
  std::vector<unsigned char> (*encodePng)(int width, int height, const unsigned char* bytes);
};

/// The name that a module exports its OiioModule by.
inline constexpr const char* oiioModuleSymbol = "copseOiioModule";

}  // namespace copse
