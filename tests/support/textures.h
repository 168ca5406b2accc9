// Textures without files.
#pragma once

#include <memory>
#include <string>
#include <utility>

#include "tracer/image/image_io.h"
#include "tracer/scene/scene.h"

namespace copse::test {

inline Texture textureOf(const Image& image, std::string name = "texture") {
  return {.file = std::move(name), .texels = std::make_shared<const Texels>(texelsOf(image))};
}

/// The texels decoded to linear RGB.
inline Image lightOf(const Texels& texels) {
  Image image{texels.width, texels.height, {}};
  for (int y = 0; y < texels.height; ++y)
    for (int x = 0; x < texels.width; ++x) image.pixels.push_back(texels.at(x, y));
  return image;
}

}  // namespace copse::test
