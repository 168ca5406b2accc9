// What the registry knows of the generators: one function a file.
#pragma once

#include <cstdint>

#include "tracer/scene/scene.h"

namespace copse::generator {

Scene generateAtrium(uint32_t triangles, uint64_t seed);
Scene generateHairball(uint32_t triangles, uint64_t seed);
Scene generateCornell(uint32_t triangles, uint64_t seed);
Scene generateConference(uint32_t triangles, uint64_t seed);
Scene generateOffice(uint32_t triangles, uint64_t seed);
Scene generatePlant(uint32_t triangles, uint64_t seed);
Scene generateStatue(uint32_t triangles, uint64_t seed);

/// A square light of that side which shines from `at` towards `towards`.
QuadLight lampAt(const vec3& at, const vec3& towards, float side, const vec3& radiance);

/// Leaves out the materials that no triangle has.
void dropUnusedMaterials(Scene& scene);

/// Throws InputError that names the range where `triangles` is outside [min, max].
void checkRange(const char* name, uint32_t triangles, uint32_t min, uint32_t max);

}  // namespace copse::generator
