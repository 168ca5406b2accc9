// What the module that links OpenImageIO gives, and the one way to it. Its 258 libraries cost 0.2 s to load and start
// threads of their own, so a program that reads no textures and writes no previews never loads it.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "builder/math/vec.h"

namespace copse {

/// An image's red, green and blue as its file has them, row by row from the top, in one of three vectors of width *
/// height; the others are empty.
struct Decoded {
  int width = 0, height = 0;
  std::vector<uint32_t> bytes;  ///< Files of 8 bits a channel or fewer: red is in the lowest bits.
  std::vector<uint64_t> words;  ///< Files of more bits, as 16: red is in the lowest bits.
  std::vector<vec3> floats;     ///< Files of floats.
  bool seeThrough = false;      ///< Some alpha, which is not kept, is below 0.98.
};

/// Both throw std::runtime_error with the reason alone.
struct OiioModule {
  /// The first image of any file that OpenImageIO reads. Grey is in all three channels; alpha is left out and colours
  /// are not multiplied by it.
  Decoded (*read)(const std::string& file);
  /// A PNG file of 8-bit sRGB triples.
  std::vector<unsigned char> (*encodePng)(int width, int height, const unsigned char* bytes);
};

/// By the module, which is loaded when it is first asked. Throws InputError "FILE: why".
Decoded decode(const std::string& file);

/// The name that a module exports its OiioModule by.
inline constexpr const char* oiioModuleSymbol = "copseOiioModule";

}  // namespace copse
