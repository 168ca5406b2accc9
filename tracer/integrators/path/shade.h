// The kernel between two traces: the surface that a ray hit, its direct light, and the bounce.
#pragma once

#include "tracer/lights/lights.h"
#include "tracer/materials/surface.h"

namespace copse {

/// Dimensions of the random numbers at a hit; the three of light sample k begin at `light` + 3 k.
struct Dimension {
  static constexpr uint32_t bounce = 0, roulette = 1, light = 2;
};

/// The state of paths, by place in the queue. `slot` is the path's number within its batch, which indexes what is kept
/// for a whole path.
struct PathQueue {
  Ray* rays;
  vec4* throughput;  ///< w: the density of the bounce that made the ray.
  uint32_t* slots;
};

struct ShadeSettings {
  uint32_t hit;  ///< 1 for the camera ray's.
  uint32_t maxDepth, lightSamples;
  bool bounceFindsLight;  ///< Both techniques, with MIS; otherwise light samples alone.
};

/// What follows from a hit, packed so that one scan sums both: whether its path goes on, and its number of shadow rays.
struct Onward {
  HD static uint64_t of(uint32_t goesOn, uint32_t shadowRays) { return uint64_t{shadowRays} << 32 | goesOn; }
  HD static uint32_t paths(uint64_t onward) { return lowWord(onward); }
  HD static uint32_t shadowRays(uint64_t onward) { return highWord(onward); }
};

/// One call per path. Overwrites the path's ray and throughput with the bounce's, and writes up to lightSamples shadow
/// rays, with the radiance each would add, from i * lightSamples on.
struct Shade {
  SceneView scene;
  ShadeSettings settings;
  PathQueue queue;
  const Hit* hits;
  const uint64_t* keys;  ///< Per slot.
  vec3* radiance;        ///< Per slot.
  uint64_t* onward;      ///< See Onward.
  Ray* shadowRays;
  vec3* shadowLight;

  HD void operator()(uint32_t i) const {
    onward[i] = 0;
    const Hit hit = hits[i];
    const vec3 direction = queue.rays[i].direction;
    const vec4 carried = queue.throughput[i];
    vec3 throughput(carried.x, carried.y, carried.z);
    const uint32_t slot = queue.slots[i];
    if (hit.triangle == Hit::none) {
      const vec3 seen = skyRadiance(scene.sky, direction);
      if (!(largest(seen) > 0)) return;
      const float sampled = scene.sky.probability * skyDensity(scene.sky, direction, carried.w * pi);
      radiance[slot] += throughput * seen * bounceWeight(carried.w, sampled);
      return;
    }
    const SurfaceTriangle triangle = scene.triangles[hit.triangle];
    const SurfaceMaterial material = scene.materials[triangle.material];
    vec3 normal = unitNormal(triangle.edge1, triangle.edge2);
    const float towards = -glm::dot(normal, direction);
    if (towards < 0) normal = -normal;
    if (material.emits) {
      const float sampled = triangle.light == SurfaceTriangle::noLight
                                ? 0
                                : emitterDensity(scene.lights[triangle.light], hit.t, fabsf(towards));
      radiance[slot] += throughput * material.ke * bounceWeight(carried.w, sampled);
    }
    if (settings.hit > settings.maxDepth) return;
    throughput *= albedo(scene, material, hit);
    if (!(largest(throughput) > 0) || !(glm::dot(normal, normal) > 0)) return;

    const vec3 point = triangle.v0 + triangle.edge1 * hit.u + triangle.edge2 * hit.v;
    const vec3 origin = point + normal * errorAlong(normal, triangle.v0, triangle.edge1, triangle.edge2);
    const uint64_t key = keys[slot];
    const uint32_t lit = sampleLights(i, key, origin, normal, throughput);
    onward[i] = Onward::of(settings.hit < settings.maxDepth ? bounce(i, key, origin, normal, throughput) : 0, lit);
  }

 private:
  /// Balance heuristic between one bounce and lightSamples light samples; the camera ray's hit has no second technique.
  HD float bounceWeight(float bounced, float sampled) const {
    if (settings.hit == 1) return 1;
    if (!(sampled > 0)) return 1;
    return settings.bounceFindsLight ? bounced / (bounced + settings.lightSamples * sampled) : 0;
  }

  /// `bits` with the high word, which chooses the light, in the k-th of lightSamples equal strata, so that the samples
  /// of a hit spread over the lights. The other numbers are not stratified; the density of all samples together is
  /// unchanged.
  HD uint64_t inStratum(uint64_t bits, uint32_t k) const {
    const uint64_t step = (uint64_t{1} << 32) / settings.lightSamples;
    return (k * step + ((highWord(bits) * step) >> 32)) << 32 | lowWord(bits);
  }

  HD uint32_t sampleLights(uint32_t i, uint64_t key, const vec3& origin, const vec3& normal,
                           const vec3& throughput) const {
    if (scene.lightCount == 0) return 0;
    const bool rival = settings.bounceFindsLight && settings.hit < settings.maxDepth;
    const uint64_t first = static_cast<uint64_t>(i) * settings.lightSamples;
    uint32_t count = 0;
    for (uint32_t k = 0; k < settings.lightSamples; ++k) {
      const LightSample sample = sampleLight(scene, origin, normal, [&](uint32_t dimension) {
        const uint64_t bits = randomBits(key, settings.hit, Dimension::light + 3 * k + dimension);
        return dimension == 0 ? inStratum(bits, k) : bits;
      });
      if (!(sample.cosine > 0)) continue;
      const float bounced = rival && sample.bounceable ? sample.cosine / pi : 0;
      const float weight = sample.cosine / pi / (settings.lightSamples * sample.density + bounced);
      const vec3 light = throughput * sample.radiance * weight;
      const float size = largest(light);
      if (!(size > 0 && size < FLT_MAX)) continue;  // Also where the density was 0 or not finite.
      shadowRays[first + count] = sample.ray;
      shadowLight[first + count] = light;
      ++count;
    }
    return count;
  }

  HD uint32_t bounce(uint32_t i, uint64_t key, const vec3& origin, const vec3& normal, vec3 throughput) const {
    if (settings.hit >= 3) {
      const float survival = minOf(largest(throughput), 0.95f);
      if (unitFloat(highWord(randomBits(key, settings.hit, Dimension::roulette))) >= survival) return 0;
      throughput /= survival;
    }
    float cosine;
    const vec3 direction = cosineDirection(normal, randomBits(key, settings.hit, Dimension::bounce), cosine);
    queue.rays[i] = {origin, 0, direction, FLT_MAX};
    queue.throughput[i] = vec4(throughput, cosine / pi);
    return 1;
  }
};

}  // namespace copse
