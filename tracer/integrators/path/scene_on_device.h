// A scene in a device's memory, as the path tracer's kernels read it.
#pragma once

#include <memory>
#include <vector>

#include "builder/bvh.h"
#include "builder/parallel/buffer.h"
#include "tracer/materials/scene_view.h"
#include "tracer/scene/scene.h"

namespace copse {

/// 24 bytes per triangle for the builders, 48 for shading. Texels, 4 or 8 bytes each, are copied to a GPU; threads read
/// the scene's own, which live on with this.
class SceneOnDevice {
 public:
  SceneOnDevice(const Device& device, const Scene& scene);

  SceneView view() const;
  TrianglesView triangles() const { return {positions_.data(), indices_.data(), count_}; }

 private:
  void uploadSurfaces(const Device& device, const Scene& scene);
  void uploadTextures(const Device& device, const Scene& scene);
  void uploadLights(const Device& device, const Scene& scene);

  uint32_t count_ = 0;
  Buffer<vec3> positions_;
  Buffer<uvec3> indices_;
  Buffer<SurfaceTriangle> surfaces_;
  Buffer<SurfaceMaterial> materials_;
  Buffer<TextureView> textures_;
  Buffer<float> texelTable_;
  Buffer<uint64_t> texels_;  ///< Those of all textures, one after another; none where threads read the scene's.
  std::vector<std::shared_ptr<const Texels>> sharedTexels_;
  Buffer<uvec3> uvTriangles_;
  Buffer<vec2> uvs_;
  Buffer<LightRecord> lights_;
  Buffer<AliasCell> lightCells_;
  Buffer<vec3> skyTexels_;
  Buffer<AliasCell> skyCells_;
  SkyView sky_{};
};

}  // namespace copse
