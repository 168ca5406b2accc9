// Files decoded to linear light. Whole numbers go through tables, so that 8-bit texels need no arithmetic.
#include <Imath/half.h>

#include <algorithm>
#include <fstream>
#include <string_view>
#include <utility>

#include "builder/base/files.h"
#include "tracer/image/image_io.h"
#include "tracer/image/oiio.h"
#include "tracer/scene/colour.h"

namespace copse {

namespace {

/// Linear light of each 16-bit value: 65,536 floats.
std::vector<float> lightOfWords(bool linear) {
  std::vector<float> values(65536);
  for (int i = 0; i < 65536; ++i) {
    const float value = i * (1 / 65535.0f);
    values[i] = linear ? value : linearOfScreen(value);
  }
  return values;
}

/// Into 0 … 1, NaN to 0.
float reflectance(float value) { return value > 0 ? std::min(value, 1.0f) : 0; }

uint64_t halfOf(float value) { return half(reflectance(value)).bits(); }

std::vector<uint64_t> halvesOf(const std::vector<vec3>& pixels) {
  std::vector<uint64_t> halves;
  halves.reserve(pixels.size());
  for (const vec3& p : pixels) halves.push_back(halfOf(p.x) | halfOf(p.y) << 16 | halfOf(p.z) << 32);
  return halves;
}

}  // namespace

bool isExr(const std::string& file) {
  if (extensionOf(file) == ".exr") return true;
  char start[4] = {};
  std::ifstream(file, std::ios::binary).read(start, 4);
  return std::string_view(start, 4) == "\x76\x2f\x31\x01";
}

Image readImage(const std::string& file, const std::string& layer, ImageSource* source) {
  ImageSource unused;
  if (!source) source = &unused;
  if (isExr(file)) return readExrLayer(file, layer, *source);
  Decoded decoded = decode(file);
  Image image{decoded.width, decoded.height, std::move(decoded.floats)};
  source->transfer = !decoded.bytes.empty() ? "8-bit sRGB" : !decoded.words.empty() ? "16-bit sRGB" : "linear floats";
  source->isPlain = false;
  if (!decoded.bytes.empty()) {
    image.pixels.reserve(decoded.bytes.size());
    const float* const table = texelTable().data();
    for (std::size_t i = 0; i < decoded.bytes.size(); ++i)
      image.pixels.push_back(decodeTexel(decoded.bytes.data(), TexelFormat::srgb8, table, i));
  } else if (!decoded.words.empty()) {
    image.pixels.reserve(decoded.words.size());
    const std::vector<float> light = lightOfWords(false);
    for (const uint64_t word : decoded.words)
      image.pixels.push_back({light[word & 0xffff], light[word >> 16 & 0xffff], light[word >> 32 & 0xffff]});
  }
  return image;
}

Texels texelsOf(const Image& image) {
  return {.width = image.width,
          .height = image.height,
          .format = TexelFormat::half,
          .bytes = {},
          .halves = halvesOf(image.pixels)};
}

Texels readTexels(const std::string& file, bool linear) {
  if (isExr(file)) return texelsOf(readExr(file));
  Decoded decoded = decode(file);
  Texels texels{decoded.width, decoded.height, TexelFormat::half, {}, {}, decoded.seeThrough};
  if (!decoded.bytes.empty()) {
    texels.format = linear ? TexelFormat::linear8 : TexelFormat::srgb8;
    texels.bytes = std::move(decoded.bytes);
  } else if (!decoded.words.empty()) {
    const std::vector<float> light = lightOfWords(linear);
    std::vector<uint64_t> halves(light.size());
    std::ranges::transform(light, halves.begin(), halfOf);
    texels.halves = std::move(decoded.words);
    for (uint64_t& word : texels.halves)
      word = halves[word & 0xffff] | halves[word >> 16 & 0xffff] << 16 | halves[word >> 32 & 0xffff] << 32;
  } else {
    texels.halves = halvesOf(decoded.floats);
  }
  return texels;
}

}  // namespace copse
