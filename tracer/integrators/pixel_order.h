// The order in which the samples of an image are numbered: pixel by pixel of tiles of 8 x 8, and the tiles along a
// Morton curve. Rays that follow one another then start close together, so that they read the same nodes: a run of 256
// on a CPU's thread covers 16 x 16 pixels, and a warp 8 x 4. Random numbers belong to pixels and not to places in this
// order, so the order does not show in the image.
#pragma once

#include "builder/parallel/buffer.h"

namespace copse {

/// Edge of a tile in pixels.
constexpr uint32_t pixelTile = 8;

/// A permutation of an image's pixels, in the device's memory: 4 bytes per pixel.
class PixelOrder {
 public:
  /// Phase `generate`. `width` and `height` are at least 1.
  PixelOrder(const Device& device, int width, int height);

  uint32_t pixels() const { return static_cast<uint32_t>(pixelAt_.size()); }
  /// The pixel, numbered row by row from the top left corner, that comes at each place.
  const uint32_t* pixelAt() const { return pixelAt_.data(); }

 private:
  Buffer<uint32_t> pixelAt_;
};

}  // namespace copse
