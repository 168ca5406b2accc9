// The lights of a scene as records that are chosen by power. Host code; O(triangles + sky pixels).
#pragma once

#include <vector>

#include "tracer/materials/scene_view.h"
#include "tracer/scene/scene.h"

namespace copse {

/// Every light that has power: quads, then triangles, then the sky. A light without power has no record and is never
/// chosen.
struct LightTable {
  std::vector<LightRecord> lights;
  std::vector<AliasCell> cells;             ///< One per light; empty where there is none.
  std::vector<uint32_t> emittingTriangles;  ///< Ascending; the record of the k-th is firstTriangle + k.
  uint32_t firstTriangle = 0;
  float skyProbability = 0;
};

/// Power: a quad's area L π, an emitting triangle's 2 area L π (both sides), and for the sky π R² times π L, what
/// enters the sphere of radius R around the triangles; L is the luminance of the radiance, for the sky its mean over
/// directions.
LightTable makeLightTable(const Scene& scene);

/// The integral of the sky's bilinear luminance over each cell of a table, weighted by solid angle.
struct SkyTable {
  uint32_t width = 0, height = 0;
  std::vector<double> weights;
  double meanLuminance = 0;  ///< Over the sphere.
};
SkyTable makeSkyTable(const Image& sky);

/// Finite and not negative, channel by channel.
vec3 usableRadiance(const vec3& radiance);

}  // namespace copse
