// Scenes from a seed: something worth rendering with no download. The same seed gives the same triangles everywhere.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include "tracer/scene/scene.h"

namespace copse {

struct GeneratorEntry {
  const char* name;
  const char* meaning;
  uint32_t defaultTriangles;
  /// About `triangles` triangles with materials, lights and three views. Throws InputError for a count that is too
  /// small or large.
  Scene (*generate)(uint32_t triangles, uint64_t seed);
};

std::span<const GeneratorEntry> generators();
/// Throws InputError that lists the names.
const GeneratorEntry& findGenerator(std::string_view name);

/// Writes FILE.obj and FILE.mtl beside it, whole or not at all.
void writeObj(const Scene& scene, const std::string& file);

}  // namespace copse
