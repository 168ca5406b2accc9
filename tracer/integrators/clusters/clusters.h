// The clusters of a k-means pass as a picture, as figure 2 of Meister and Bittner 2016 shows them: each in a colour of
// its own, lit from the eye, with the clusters' representatives as wireframe boxes. 32 bytes per pixel.
#pragma once

#include "builder/method.h"
#include "tracer/integrators/primary_rays.h"
#include "tracer/materials/scene_view.h"
#include "tracer/scene/image.h"

namespace copse {

namespace phases {
inline constexpr PhaseName clusters{"clusters", &groups::pictures};
/// Part of the build: making the clusters once more, for the picture.
inline constexpr PhaseName passClusters{"clusters of a pass", &groups::pictures};
}  // namespace phases

struct ClusterPicture {
  Image image;
  std::vector<float> cluster;  ///< Per pixel: what its first sample hits; -1 for nothing, or where there is no sample.
  uint64_t samples = 0;        ///< Over all pixels; each was one ray.
};

/// More boxes than this would hide the image, and are not drawn.
inline constexpr std::size_t maxBoxesDrawn = 4096;

/// Linear RGB; fixed per number, and unlike the colours of neighbouring numbers: hues are golden angles apart.
vec3 clusterColour(uint32_t cluster);

/// Phases `generate`, `tracePrimary` and `clusters`. Lines that lie behind a surface show through it faintly.
ClusterPicture renderClusters(const Device& device, const SceneView& scene, const RayTracer& tracer,
                              const PassClusters& clusters, const Camera& camera, const RenderSettings& settings,
                              bool boxes = true, const Watch& watch = {}, uint32_t queue = 0);

}  // namespace copse
