// A tile's pixels stand behind those of all tiles before it, and these make up whole quadrants of squares, less what
// lies outside of the image: so each tile finds its place by itself.
#include "tracer/integrators/pixel_order.h"

#include <algorithm>
#include <bit>

#include "builder/parallel/launch.h"
#include "tracer/integrators/phases.h"

namespace copse {

namespace {

/// Index: a tile, numbered row by row. Lengths are in pixels.
struct PlaceTile {
  uint32_t width, height;
  uint32_t square;  ///< Edge of the squares that the Morton curve fills one after the other along the longer side.
  uint32_t* pixelAt;

  HD static uint32_t overlap(uint32_t begin, uint32_t length, uint32_t end) {
    return begin >= end ? 0 : begin + length < end ? length : end - begin;
  }
  HD uint32_t pixelsIn(uint32_t left, uint32_t top, uint32_t edge) const {
    return overlap(left, edge, width) * overlap(top, edge, height);
  }

  HD void operator()(uint32_t tile) const {
    const uint32_t across = (width + pixelTile - 1) / pixelTile;
    const uint32_t x = tile % across * pixelTile, y = tile / across * pixelTile;
    uint32_t left = x / square * square, top = y / square * square;
    uint32_t place = left * height + top * width;  // One of them is 0.
    for (uint32_t edge = square / 2; edge >= pixelTile; edge /= 2) {
      const bool right = x >= left + edge, low = y >= top + edge;
      if (right || low) place += pixelsIn(left, top, edge);
      if (low) place += pixelsIn(left + edge, top, edge);
      if (low && right) place += pixelsIn(left, top + edge, edge);
      left += right ? edge : 0;
      top += low ? edge : 0;
    }
    for (uint32_t row = y; row < y + overlap(y, pixelTile, height); ++row)
      for (uint32_t column = x; column < x + overlap(x, pixelTile, width); ++column)
        pixelAt[place++] = row * width + column;
  }
};

uint32_t tilesIn(uint32_t pixels) { return (pixels + pixelTile - 1) / pixelTile; }

}  // namespace

PixelOrder::PixelOrder(const Device& device, int width, int height)
    : pixelAt_(device, static_cast<std::size_t>(width) * static_cast<std::size_t>(height)) {
  const uint32_t w = static_cast<uint32_t>(width), h = static_cast<uint32_t>(height);
  const uint32_t square = pixelTile * std::bit_ceil(tilesIn(std::min(w, h)));
  launch(device, phases::generate, tilesIn(w) * tilesIn(h), PlaceTile{w, h, square, pixelAt_.data()});
}

}  // namespace copse
