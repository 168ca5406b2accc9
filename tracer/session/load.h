// The first step of a run: a scene into memory, and the parts that are needed onto the device.
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "tracer/integrators/path/scene_on_device.h"
#include "tracer/scene/scene.h"

namespace copse {

/// What the scene is loaded for.
enum class LoadFor {
  renders,    ///< Textures are read, and everything is uploaded; the scene lets go of its texels.
  builds,     ///< The triangles are uploaded, no textures are read.
  reference,  ///< Textures are read, nothing is uploaded.
};

/// A scene, and its parts on the device.
struct LoadedScene {
  Scene scene;
  std::unique_ptr<const SceneOnDevice> onDevice;  ///< For renders.
  Buffer<vec3> positions;                         ///< For builds only, as is the next.
  Buffer<uvec3> indices;
  double ms = 0;      ///< Reading files, textures and the upload.
  uint64_t hash = 0;  ///< sceneHash(), unless for builds.

  /// On the device; none where nothing was uploaded.
  TrianglesView triangles() const;
};

/// `read` makes the scene, from a file or otherwise. Throws InputError as loadScene() and loadTextures() do.
LoadedScene load(const Device& device, const std::function<Scene()>& read, LoadFor purpose);
LoadedScene load(const Device& device, const std::string& file, LoadFor purpose, const LoadOptions& options = {});

}  // namespace copse
