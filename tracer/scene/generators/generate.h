// What the registry knows of the generators: one function a file.
#pragma once

#include <cstdint>

#include "tracer/scene/scene.h"

namespace copse::generator {

Scene generateAtrium(uint32_t triangles, uint64_t seed);
Scene generateHairball(uint32_t triangles, uint64_t seed);
Scene generateCornell(uint32_t triangles, uint64_t seed);

/// Throws InputError that names the range where `triangles` is outside [least, most].
void checkRange(const char* name, uint32_t triangles, uint32_t least, uint32_t most);

}  // namespace copse::generator
