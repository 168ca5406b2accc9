// The surface at a hit: the normal that faces the ray, the albedo; and how far off the surface the next ray starts.
#pragma once

#include <cmath>

#include "builder/math/box.h"
#include "tracer/accel/ray.h"
#include "tracer/materials/scene_view.h"

namespace copse {

/// By how much a point off a triangle, corner + u edge1 + v edge2 + offset normal, may be misplaced along an axis,
/// relative to |corner| + |edge1| + |edge2| there: five roundings of half an ulp each (an edge, its product, two sums,
/// the offset), with room for the roundings of the test that is to find the triangle behind it. Where an axis enters
/// neither a corner nor an edge, such as the height of a floor at 0, nothing is rounded.
inline constexpr float pointError = 0x1p-21f;

/// How far along its unit normal a point of a triangle is moved, so that it lies beyond the plane whatever its error:
/// that error's bound along the normal (after Wächter and Binder, Ray Tracing Gems 2019, ch. 6, and Pharr, Jakob and
/// Humphreys, Physically Based Rendering 2016, 3.9).
HD inline float errorAlong(const vec3& normal, const vec3& corner, const vec3& edge1, const vec3& edge2) {
  return pointError * glm::dot(glm::abs(normal), glm::abs(corner) + glm::abs(edge1) + glm::abs(edge2));
}

/// Edges whose cross product squared would leave the range of floats are scaled first. 0 where there is no area.
HD inline vec3 unitNormal(vec3 edge1, vec3 edge2) {
  vec3 n = glm::cross(edge1, edge2);
  float square = glm::dot(n, n);
  if (!(square > 1e-30f && square < 1e30f)) {
    const vec3 size = maxOf(glm::abs(edge1), glm::abs(edge2));
    const float scale = largest(size);
    if (!(scale > 0)) return vec3(0);
    edge1 /= scale;
    edge2 /= scale;
    n = glm::cross(edge1, edge2);
    square = glm::dot(n, n);
    if (!(square > 1e-30f)) return vec3(0);
  }
  return n / sqrtf(square);
}

/// Bilinear and repeating; v = 0 is the bottom row. u and v within [0, 1].
HD inline vec3 bilinear(const TextureView& texture, const float* table, float u, float v) {
  const float x = u * texture.width - 0.5f, y = (1 - v) * texture.height - 0.5f;
  const float x0 = floorf(x), y0 = floorf(y);
  const float fx = x - x0, fy = y - y0;
  const auto wrap = [](int i, int n) { return i < 0 ? i + n : i >= n ? i - n : i; };
  const int left = wrap(static_cast<int>(x0), texture.width), right = wrap(static_cast<int>(x0) + 1, texture.width);
  const int top = wrap(static_cast<int>(y0), texture.height), bottom = wrap(static_cast<int>(y0) + 1, texture.height);
  const auto texel = [&](int column, int row) {
    return decodeTexel(texture.texels, texture.format, table, static_cast<uint64_t>(row) * texture.width + column);
  };
  return (texel(left, top) * (1 - fx) + texel(right, top) * fx) * (1 - fy) +
         (texel(left, bottom) * (1 - fx) + texel(right, bottom) * fx) * fy;
}

/// The texture where there is one and the texture coordinates are finite, otherwise kd.
HD inline vec3 albedo(const SceneView& scene, const SurfaceMaterial& material, const Hit& hit) {
  if (material.texture < 0 || !scene.uvTriangles) return material.kd;
  const uvec3 corner = scene.uvTriangles[hit.triangle];
  const vec2 uv = scene.uvs[corner.x] * (1 - hit.u - hit.v) + scene.uvs[corner.y] * hit.u + scene.uvs[corner.z] * hit.v;
  const float u = uv.x - floorf(uv.x), v = uv.y - floorf(uv.y);
  if (!(u >= 0 && v >= 0)) return material.kd;
  return bilinear(scene.textures[material.texture], scene.texelTable, u, v);
}

}  // namespace copse
