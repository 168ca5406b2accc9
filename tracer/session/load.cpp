// Loading with the clock around it.
#include "tracer/session/load.h"

#include "builder/parallel/timed.h"
#include "tracer/image/image_io.h"
#include "tracer/session/scene_hash.h"

namespace copse {

TrianglesView LoadedScene::triangles() const {
  if (onDevice) return onDevice->triangles();
  return {positions.data(), indices.data(), static_cast<uint32_t>(indices.size())};
}

LoadedScene load(const Device& device, const std::function<Scene()>& read, LoadFor purpose) {
  const Stopwatch watch;
  LoadedScene loaded;
  loaded.scene = read();
  if (purpose != LoadFor::builds) {
    loadTextures(loaded.scene);
    loaded.hash = sceneHash(loaded.scene);
  }
  if (purpose == LoadFor::renders) {
    loaded.onDevice = std::make_unique<const SceneOnDevice>(device, loaded.scene);
    for (Texture& texture : loaded.scene.textures) texture.texels.reset();  // What is on the device is enough.
  }
  if (purpose == LoadFor::builds) {
    loaded.positions = Buffer<vec3>(device, loaded.scene.positions);
    loaded.indices = Buffer<uvec3>(device, loaded.scene.triangles);
  }
  if (purpose != LoadFor::reference) synchronise(device);
  loaded.ms = watch.ms();
  return loaded;
}

LoadedScene load(const Device& device, const std::string& file, LoadFor purpose, const LoadOptions& options) {
  return load(
      device, [&] { return loadScene(file, options); }, purpose);
}

}  // namespace copse
