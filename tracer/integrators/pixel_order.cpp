// The tiles of a square whose edge is a power of two, less those that lie outside of the image.
#include "tracer/integrators/pixel_order.h"

#include <algorithm>
#include <bit>
#include <span>
#include <vector>

namespace copse {

namespace {

/// Bits 0, 2, 4 … of `code` side by side.
uint32_t everySecondBit(uint64_t code) {
  uint32_t bits = 0;
  for (uint32_t i = 0; i < 32; ++i) bits |= static_cast<uint32_t>(code >> (2 * i) & 1) << i;
  return bits;
}

std::vector<uint32_t> tileOrder(uint32_t width, uint32_t height) {
  std::vector<uint32_t> pixels;
  pixels.reserve(static_cast<std::size_t>(width) * height);
  const uint32_t across = (width + pixelTile - 1) / pixelTile, down = (height + pixelTile - 1) / pixelTile;
  // The square of the shorter side is repeated along the longer one, so that no more tiles are passed over than there are.
  const uint32_t edge = std::bit_ceil(std::min(across, down));
  for (uint32_t top = 0; top < down; top += edge)
    for (uint32_t left = 0; left < across; left += edge)
      for (uint64_t code = 0; code < uint64_t{edge} * edge; ++code) {
        const uint32_t x = (left + everySecondBit(code)) * pixelTile, y = (top + everySecondBit(code >> 1)) * pixelTile;
        for (uint32_t row = y; row < std::min(y + pixelTile, height); ++row)
          for (uint32_t column = x; column < std::min(x + pixelTile, width); ++column)
            pixels.push_back(row * width + column);
      }
  return pixels;
}

}  // namespace

PixelOrder::PixelOrder(const Device& device, int width, int height)
    : pixelAt_(device, std::span<const uint32_t>(tileOrder(static_cast<uint32_t>(width), static_cast<uint32_t>(height)))) {}

}  // namespace copse
