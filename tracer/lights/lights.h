// Light that arrives: samples of all lights chosen by power, the sky, and the density with which sampling would have
// found what a bounce found (for the balance heuristic, Veach 1997).
#pragma once

#include <cfloat>
#include <cmath>

#include "tracer/accel/ray.h"
#include "tracer/materials/scene_view.h"
#include "tracer/materials/surface.h"

namespace copse {

/// How far from a triangle the test of rays may find it, relative to the distance of the origin from its corners: 16
/// roundings of half an ulp.
inline constexpr float distanceError = 0x1p-20f;

/// Where `direction` meets the equirectangular image, in [0, 1]²: +y is at the top, and in one that is not turned -z in
/// the middle, +x to its right.
HD inline vec2 skyPoint(const SkyView& sky, const vec3& direction) {
  const float y = direction.y < -1 ? -1 : direction.y > 1 ? 1 : direction.y;
  const float x = 0.5f + atan2f(direction.x, -direction.z) / (2 * pi) + sky.turn;
  return {x > 1 ? x - 1 : x, acosf(y) / pi};
}

/// Bilinear; repeats to the sides and ends at the poles.
HD inline vec3 skyRadiance(const SkyView& sky, const vec3& direction) {
  if (!sky.texels) return sky.radiance;
  const vec2 point = skyPoint(sky, direction);
  const float x = point.x * sky.width - 0.5f, y = point.y * sky.height - 0.5f;
  const float x0 = floorf(x), y0 = floorf(y);
  const float fx = x - x0, fy = y - y0;
  const auto column = [&](int i) { return i < 0 ? i + sky.width : i >= sky.width ? i - sky.width : i; };
  const auto row = [&](int i) { return i < 0 ? 0 : i >= sky.height ? sky.height - 1 : i; };
  const int left = column(static_cast<int>(x0)), right = column(static_cast<int>(x0) + 1);
  const vec3* upper = sky.texels + static_cast<uint64_t>(row(static_cast<int>(y0))) * sky.width;
  const vec3* lower = sky.texels + static_cast<uint64_t>(row(static_cast<int>(y0) + 1)) * sky.width;
  return (upper[left] * (1 - fx) + upper[right] * fx) * (1 - fy) + (lower[left] * (1 - fx) + lower[right] * fx) * fy;
}

/// Density by solid angle with which skyDirection() gives `direction`, whose cosine to the surface is `cosine`.
HD inline float skyDensity(const SkyView& sky, const vec3& direction, float cosine) {
  if (!sky.texels) return cosine / pi;
  const vec2 point = skyPoint(sky, direction);
  const uint32_t x = static_cast<uint32_t>(point.x * sky.tableWidth);
  const uint32_t y = static_cast<uint32_t>(point.y * sky.tableHeight);
  const uint32_t column = x < sky.tableWidth ? x : sky.tableWidth - 1;
  const uint32_t row = y < sky.tableHeight ? y : sky.tableHeight - 1;
  const float inCell = sky.cells[row * sky.tableWidth + column].probability;
  const float sine = sqrtf(direction.x * direction.x + direction.z * direction.z);
  const float cells = static_cast<float>(sky.tableWidth) * static_cast<float>(sky.tableHeight);
  return sine > 0 ? inCell * cells / (2 * pi * pi * sine) : 0;
}

/// A direction to a constant sky follows the surface's cosine; one to an image follows the image.
HD inline vec3 skyDirection(const SkyView& sky, const vec3& normal, uint64_t bits, uint64_t inCell) {
  float cosine;
  if (!sky.texels) return cosineDirection(normal, bits, cosine);
  const uint32_t cell = pick(sky.cells, sky.tableWidth * sky.tableHeight, bits);
  const float column = static_cast<float>(cell % sky.tableWidth), row = static_cast<float>(cell / sky.tableWidth);
  const float azimuth = 2 * pi * ((column + unitFloat(highWord(inCell))) / sky.tableWidth - 0.5f - sky.turn);
  const float polar = pi * ((row + unitFloat(lowWord(inCell))) / sky.tableHeight);
  const float sine = sinf(polar);
  return {sine * sinf(azimuth), cosf(polar), -sine * cosf(azimuth)};
}

/// Light that reaches a surface from one chosen light if nothing is in the way of `ray`.
struct LightSample {
  Ray ray;
  vec3 radiance;
  float cosine;     ///< At the surface; 0 or below where there is nothing to gain.
  float density;    ///< By solid angle, with the choice of the light in it.
  bool bounceable;  ///< A bounce could have found it too: every light but the quads.
};

/// `origin` lies off the surface already. `random(k)`, k = 0, 1, 2, gives 64 random bits each.
template <class Random>
HD inline LightSample sampleLight(const SceneView& scene, const vec3& origin, const vec3& normal,
                                  const Random& random) {
  LightSample sample;
  sample.cosine = 0;
  sample.ray.origin = origin;
  sample.ray.tMin = 0;
  const LightRecord light = scene.lights[pick(scene.lightCells, scene.lightCount, random(0))];
  if (light.kind == LightKind::sky) {
    const vec3 direction = skyDirection(scene.sky, normal, random(1), scene.sky.texels ? random(2) : 0);
    sample.ray.direction = direction;
    sample.ray.tMax = FLT_MAX;
    sample.cosine = glm::dot(direction, normal);
    sample.density = light.density * skyDensity(scene.sky, direction, sample.cosine);
    sample.radiance = skyRadiance(scene.sky, direction);
    sample.bounceable = true;
    return sample;
  }
  const uint64_t bits = random(1);
  float a = unitFloat(highWord(bits)), b = unitFloat(lowWord(bits));
  if (light.kind == LightKind::triangle && a + b > 1) {
    a = 1 - a;
    b = 1 - b;
  }
  const vec3 point = light.corner + light.edge1 * a + light.edge2 * b;
  vec3 facing = glm::cross(light.edge1, light.edge2) * light.inverseCross;
  if (glm::dot(facing, origin - point) < 0) {
    if (light.kind == LightKind::quad) return sample;
    facing = -facing;
  }
  // Unscaled, so that the light is at t = 1 to the last bit; a surface that emits lies just behind it.
  const vec3 straight = point - origin;
  const vec3 to = point + facing * (light.offset + distanceError * largest(glm::abs(straight))) - origin;
  const float square = glm::dot(to, to);
  const float inverse = 1 / sqrtf(square);
  const float cosineAtLight = -glm::dot(facing, to) * inverse;
  if (!(cosineAtLight > 0)) return sample;
  sample.ray.direction = to;
  sample.ray.tMax = 1;
  sample.cosine = glm::dot(normal, to) * inverse;
  sample.density = light.density * square / cosineAtLight;
  sample.radiance = light.radiance;
  sample.bounceable = light.kind == LightKind::triangle;
  return sample;
}

/// Density with which sampleLight() finds the point of an emitting triangle that a ray found at `distance`.
HD inline float emitterDensity(const LightRecord& light, float distance, float cosineAtLight) {
  return cosineAtLight > 0 ? light.density * distance * distance / cosineAtLight : 0;
}

}  // namespace copse
