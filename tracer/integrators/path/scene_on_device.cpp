// Lays a scene out for the path tracer's kernels and uploads it.
#include "tracer/integrators/path/scene_on_device.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "builder/base/error.h"
#include "tracer/lights/light_table.h"

namespace copse {

namespace {

/// Within [0, 1]; NaN is 0. A surface that reflects more than it receives would let throughput grow without bound.
vec3 usableAlbedo(const vec3& kd) {
  vec3 usable(0);
  for (int k = 0; k < 3; ++k) usable[k] = kd[k] > 0 ? std::min(kd[k], 1.0f) : 0;
  return usable;
}

template <class T>
Buffer<T> uploaded(const Device& device, const std::vector<T>& from) {
  return Buffer<T>(device, std::span<const T>(from));
}

void check(const Scene& scene) {
  const auto fail = [&](const char* what) { throw InputError(fmt::format("{}: {}", scene.file, what)); };
  if (scene.triangles.size() >= 0x80000000u) fail("expected fewer than 2^31 triangles");
  if (scene.materialOf.size() != scene.triangles.size())
    fail("the number of material indices differs from that of triangles");
  for (const uint32_t m : scene.materialOf)
    if (m >= scene.materials.size()) fail("a triangle's material index is out of range");
  for (const uvec3& t : scene.triangles)
    if (std::max({t.x, t.y, t.z}) >= scene.positions.size()) fail("a triangle's vertex index is out of range");
  if (scene.uvTriangles.empty()) return;
  if (scene.uvTriangles.size() != scene.triangles.size())
    fail("expected texture coordinates for all triangles or for none");
  for (const uvec3& t : scene.uvTriangles)
    if (std::max({t.x, t.y, t.z}) >= scene.uvs.size()) fail("a triangle's texture coordinate index is out of range");
}

}  // namespace

SceneOnDevice::SceneOnDevice(const Device& device, const Scene& scene) {
  check(scene);
  count_ = static_cast<uint32_t>(scene.triangles.size());
  positions_ = uploaded(device, scene.positions);
  indices_ = uploaded(device, scene.triangles);
  uploadTextures(device, scene);
  uploadLights(device, scene);
  uploadSurfaces(device, scene);
}

void SceneOnDevice::uploadTextures(const Device& device, const Scene& scene) {
  std::vector<TextureView> textures;
  const auto wordsOf = [](const Texels& texels) { return (texels.sizeInBytes() + 7) / 8; };
  std::size_t total = 0;
  for (const Texture& texture : scene.textures) {
    const Texels* texels = texture.texels.get();
    textures.push_back(texels ? TextureView{texels->data(), texels->width, texels->height, texels->format}
                              : TextureView{});
    total += texels ? wordsOf(*texels) : 0;
  }
  if (device.isCuda()) {
    texels_ = Buffer<uint64_t>(device, total);
    uint64_t* next = texels_.data();
    for (std::size_t i = 0; i < textures.size(); ++i) {
      const Texels* texels = scene.textures[i].texels.get();
      if (!texels || texels->sizeInBytes() == 0) continue;
      copyToDevice(device, next, texels->data(), texels->sizeInBytes());
      textures[i].texels = next;
      next += wordsOf(*texels);
    }
  } else {
    for (const Texture& texture : scene.textures)
      if (texture.texels) sharedTexels_.push_back(texture.texels);
  }
  textures_ = uploaded(device, textures);
  texelTable_ = uploaded(device, texelTable());

  std::vector<SurfaceMaterial> materials;
  for (const Material& material : scene.materials) {
    const auto texture = static_cast<std::size_t>(material.texture);
    const bool textured = material.texture >= 0 && texture < scene.textures.size() && scene.textures[texture].texels &&
                          scene.textures[texture].texels->sizeInBytes() > 0;
    const vec3 ke = usableRadiance(material.ke);
    materials.push_back({usableAlbedo(material.kd), textured ? material.texture : -1, ke, largest(ke) > 0});
  }
  materials_ = uploaded(device, materials);
  uvTriangles_ = uploaded(device, scene.uvTriangles);
  uvs_ = uploaded(device, scene.uvs);
}

void SceneOnDevice::uploadLights(const Device& device, const Scene& scene) {
  if (!scene.sky) return;
  const Image& image = scene.sky->image;
  sky_.radiance = usableRadiance(scene.sky->radiance);
  if (image.pixels.empty()) return;
  std::vector<vec3> texels = image.pixels;
  for (vec3& texel : texels) texel = usableRadiance(texel);
  const SkyTable table = makeSkyTable(image);
  skyTexels_ = uploaded(device, texels);
  skyCells_ = uploaded(device, aliasTable(table.weights));
  sky_ = {vec3(0),
          skyTexels_.data(),
          image.width,
          image.height,
          skyCells_.data(),
          table.width,
          table.height,
          0,
          static_cast<float>(scene.sky->turn())};
}

void SceneOnDevice::uploadSurfaces(const Device& device, const Scene& scene) {
  const LightTable table = makeLightTable(scene);
  lights_ = uploaded(device, table.lights);
  lightCells_ = uploaded(device, table.cells);
  sky_.probability = table.skyProbability;

  std::vector<SurfaceTriangle> surfaces(count_);
  for (uint32_t i = 0; i < count_; ++i) {
    const uvec3 t = scene.triangles[i];
    const vec3 a = scene.positions[t.x], b = scene.positions[t.y], c = scene.positions[t.z];
    surfaces[i] = {a, scene.materialOf[i], b - a, SurfaceTriangle::noLight, c - a};
  }
  for (std::size_t k = 0; k < table.emittingTriangles.size(); ++k)
    surfaces[table.emittingTriangles[k]].light = table.firstTriangle + static_cast<uint32_t>(k);
  surfaces_ = uploaded(device, surfaces);
}

SceneView SceneOnDevice::view() const {
  return {surfaces_.data(),
          materials_.data(),
          textures_.data(),
          texelTable_.data(),
          uvTriangles_.data(),
          uvs_.data(),
          lights_.data(),
          lightCells_.data(),
          static_cast<uint32_t>(lights_.size()),
          sky_};
}

}  // namespace copse
