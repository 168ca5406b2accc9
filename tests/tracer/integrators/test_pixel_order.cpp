// The order of an image's pixels: each of them once, tile by tile.
#include <algorithm>
#include <numeric>

#include "tests/support/catch.h"
#include "tests/support/devices.h"
#include "tracer/integrators/pixel_order.h"

using namespace copse;
using namespace copse::test;

namespace {

std::vector<uint32_t> orderOf(const Device& device, int width, int height) {
  const PixelOrder order(device, width, height);
  std::vector<uint32_t> pixels(order.pixels());
  copyToHost(device, pixels.data(), order.pixelAt(), pixels.size() * sizeof(uint32_t));
  return pixels;
}

struct Extent {
  uint32_t columns, rows;
};

Extent extentOf(const std::vector<uint32_t>& pixels, std::size_t begin, std::size_t end, uint32_t width) {
  uint32_t left = ~0u, right = 0, top = ~0u, bottom = 0;
  for (std::size_t i = begin; i < end; ++i) {
    left = std::min(left, pixels[i] % width), right = std::max(right, pixels[i] % width);
    top = std::min(top, pixels[i] / width), bottom = std::max(bottom, pixels[i] / width);
  }
  return {right - left + 1, bottom - top + 1};
}

}  // namespace

TEST_CASE("every pixel of an image comes once, whatever its size") {
  for (const Device& device : devices())
    for (const auto& [width, height] :
         {std::pair{1, 1}, {1, 50}, {50, 1}, {8, 8}, {9, 7}, {17, 33}, {100, 3}, {64, 48}, {1023, 17}}) {
      INFO(width << " x " << height);
      std::vector<uint32_t> pixels = orderOf(device, width, height), expected(pixels.size());
      REQUIRE(pixels.size() == static_cast<std::size_t>(width * height));
      std::iota(expected.begin(), expected.end(), 0u);
      std::sort(pixels.begin(), pixels.end());
      CHECK(pixels == expected);
    }
}

TEST_CASE("a warp covers 8 x 4 pixels, and runs of 64 and 256 rays squares of 8 and 16") {
  for (const Device& device : devices()) {
    const std::vector<uint32_t> pixels = orderOf(device, 128, 96);
    for (std::size_t begin = 0; begin < pixels.size(); begin += 256) {
      const Extent warp = extentOf(pixels, begin, begin + 32, 128), tile = extentOf(pixels, begin, begin + 64, 128),
                   run = extentOf(pixels, begin, begin + 256, 128);
      REQUIRE((warp.columns == 8 && warp.rows == 4));
      REQUIRE((tile.columns == 8 && tile.rows == 8));
      REQUIRE((run.columns == 16 && run.rows == 16));
    }
  }
}
