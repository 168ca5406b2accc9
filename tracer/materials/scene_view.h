// What kernels read of a scene: plain pointers into device memory, passed by value. One 48-byte record holds all that a
// hit on a triangle needs except texture coordinates; one 64-byte record holds a light.
#pragma once

#include <cstdint>

#include "builder/math/vec.h"
#include "tracer/materials/sampling.h"
#include "tracer/scene/texels.h"

namespace copse {

struct alignas(16) SurfaceTriangle {
  static constexpr uint32_t noLight = 0xffffffffu;

  vec3 v0;
  uint32_t material;
  vec3 edge1;
  uint32_t light;  ///< Index into lights, or noLight.
  vec3 edge2;
};
static_assert(sizeof(SurfaceTriangle) == 48);

struct alignas(16) SurfaceMaterial {
  vec3 kd;      ///< Within [0, 1].
  int texture;  ///< Replaces kd; -1 for none.
  vec3 ke;
  uint32_t emits;
};

struct TextureView {
  const void* texels;  ///< As Texels::data(); row 0 is the top.
  int width, height;
  TexelFormat format;
};

enum class LightKind : uint32_t { quad, triangle, sky };

/// Points are corner + a edge1 + b edge2. `density` is the probability that this light is chosen, over its area; for
/// the sky the probability alone.
struct alignas(16) LightRecord {
  vec3 corner;
  float density;
  vec3 edge1;
  float inverseCross;  ///< 1 / |edge1 x edge2|
  vec3 edge2;
  LightKind kind;
  vec3 radiance;
  float offset;  ///< How far points on the light are at least moved towards what they light.
};
static_assert(sizeof(LightRecord) == 64);

/// Constant where `texels` is null. The image's cells are chosen by `cells`, tableWidth * tableHeight of them.
struct SkyView {
  vec3 radiance;
  const vec3* texels;
  int width, height;
  const AliasCell* cells;
  uint32_t tableWidth, tableHeight;
  float probability;  ///< That the sky is chosen among the lights; 0 where it has no power.
  float turn;         ///< As SkyLight::turn().
};

struct SceneView {
  const SurfaceTriangle* triangles;
  const SurfaceMaterial* materials;
  const TextureView* textures;
  const float* texelTable;   ///< As texelTable().
  const uvec3* uvTriangles;  ///< Null where nothing has texture coordinates.
  const vec2* uvs;
  const LightRecord* lights;
  const AliasCell* lightCells;
  uint32_t lightCount;  ///< 0 where nothing emits.
  SkyView sky;
};

}  // namespace copse
