// A texture's texels as the host and a device keep them: 4 bytes each where the file had 8 bits a channel, otherwise 8.
// Each is one load, and has the same value for every reader to the last bit.
#pragma once

#include <cstdint>
#include <vector>

#include "builder/math/vec.h"
#include "builder/parallel/bits.h"

namespace copse {

enum class TexelFormat : uint32_t {
  srgb8,    ///< 8 bits a channel on the curve of a screen (IEC 61966-2-1).
  linear8,  ///< 8 bits a channel, 255 for 1.
  half,     ///< 16-bit floats (IEEE 754 binary16), linear, neither negative nor infinite nor NaN.
};

/// Row 0 is the top. Red is in the lowest bits, then green and blue; the highest quarter is not read.
struct Texels {
  int width = 0, height = 0;
  TexelFormat format = TexelFormat::srgb8;
  std::vector<uint32_t> bytes;   ///< width * height, row by row, of the formats of 8 bits; otherwise empty.
  std::vector<uint64_t> halves;  ///< The same of `half`.
  bool seeThrough = false;       ///< The file has an alpha below 0.98, which is not kept.

  const void* data() const;
  std::size_t sizeInBytes() const { return bytes.size() * sizeof bytes[0] + halves.size() * sizeof halves[0]; }
  /// Linear RGB.
  vec3 at(int x, int y) const;
};

/// Linear light of the 256 values of `srgb8`, followed by that of `linear8`: 512 floats.
const std::vector<float>& texelTable();

/// Of a half as TexelFormat has them. Its bits are in place for a float whose exponent is 112 too small; the product is
/// exact, and right for subnormal halves too.
HD inline float floatOfHalf(uint32_t half) { return floatOfBits(half << 13) * 0x1p112f; }

/// Texel `i` of `texels`, which are those of Texels::data(); `table` is that of texelTable().
HD inline vec3 decodeTexel(const void* texels, TexelFormat format, const float* table, uint64_t i) {
  if (format == TexelFormat::half) {
    const uint64_t word = static_cast<const uint64_t*>(texels)[i];
    return {floatOfHalf(word & 0xffff), floatOfHalf(word >> 16 & 0xffff), floatOfHalf(word >> 32 & 0xffff)};
  }
  const uint32_t word = static_cast<const uint32_t*>(texels)[i];
  const float* value = table + 256 * static_cast<uint32_t>(format);
  return {value[word & 0xff], value[word >> 8 & 0xff], value[word >> 16 & 0xff]};
}

}  // namespace copse
