// Eight bytes at a time, each mixed in by a multiplication. It tells accidents apart and not attacks.
#include "tracer/session/scene_hash.h"

#include <cstring>
#include <vector>

namespace copse {

namespace {

class Hash {
 public:
  void add(const void* bytes, std::size_t count) {
    mix(count);
    const char* at = static_cast<const char*>(bytes);
    for (; count >= 8; at += 8, count -= 8) mix(wordAt(at, 8));
    if (count > 0) mix(wordAt(at, count));
  }
  template <class T>
  void add(const std::vector<T>& values) {
    add(values.data(), values.size() * sizeof(T));
  }
  void mix(uint64_t word) {
    state_ = (state_ ^ word) * 0x9e3779b97f4a7c15;
    state_ ^= state_ >> 32;
  }
  uint64_t value() const { return state_; }

 private:
  static uint64_t wordAt(const char* at, std::size_t count) {
    uint64_t word = 0;
    std::memcpy(&word, at, count);
    return word;
  }

  uint64_t state_ = 0x243f6a8885a308d3;
};

}  // namespace

uint64_t sceneHash(const Scene& scene) {
  Hash hash;
  hash.add(&scene.origin, sizeof scene.origin);
  hash.add(scene.positions);
  hash.add(scene.triangles);
  hash.add(scene.materialOf);
  hash.add(scene.uvs);
  hash.add(scene.uvTriangles);
  for (const Material& material : scene.materials) {
    hash.add(&material.kd, sizeof material.kd);
    hash.add(&material.ke, sizeof material.ke);
    hash.mix(static_cast<uint64_t>(material.texture));
  }
  for (const Texture& texture : scene.textures) {
    hash.mix(texture.texels != nullptr);
    if (!texture.texels) continue;
    const Texels& texels = *texture.texels;
    hash.mix(static_cast<uint64_t>(texels.width) << 32 | static_cast<uint32_t>(texels.format));
    hash.add(texels.data(), texels.sizeInBytes());
  }
  hash.add(scene.quads);
  hash.mix(scene.sky.has_value());
  if (scene.sky) {
    hash.add(&scene.sky->radiance, sizeof scene.sky->radiance);
    const double turn = scene.sky->turn();
    hash.add(&turn, sizeof turn);
    hash.mix(static_cast<uint64_t>(scene.sky->image.width));
    hash.add(scene.sky->image.pixels);
  }
  return hash.value();
}

}  // namespace copse
