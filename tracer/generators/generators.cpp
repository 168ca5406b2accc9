// The table of generators. A new one is a file in generators/ and a row here; tests and `copse list` find it there.
#include "tracer/generators/generators.h"

#include <fmt/format.h>

#include <cmath>

#include <glm/geometric.hpp>

#include "builder/base/error.h"
#include "tracer/generators/generate.h"

namespace copse {

namespace {
const GeneratorEntry table[] = {
    {"atrium", "a two-storey colonnaded court with vaults, drapery, plants and cables, open to the sky", 262'144,
     generator::generateAtrium},
    {"hairball", "thin curled strands around a ball: 288 overlapping triangles each, the hardest case for boxes",
     2'880'000, generator::generateHairball},
    {"statue", "a robed figure as a scanner sees it: one closed surface of small triangles of nearly one size",
     1'087'716, generator::generateStatue},
    {"conference", "a panelled conference room: an oval table, 34 chairs, curtains, blinds, lamps in the ceiling",
     331'179, generator::generateConference},
    {"office", "furnished floors: storeys of rooms along corridors, with desks, chairs, books, blinds and stairs",
     2'169'000, generator::generateOffice},
    {"plant",
     "a power plant: pipes, machines, ducts, cables, gratings and stairs in a steel frame, long thin triangles",
     12'759'246, generator::generatePlant},
    {"cornell", "the measured Cornell box, its walls and blocks subdivided", 38, generator::generateCornell},
};
}  // namespace

std::span<const GeneratorEntry> generators() { return table; }

const GeneratorEntry& findGenerator(std::string_view name) {
  std::string names;
  for (const GeneratorEntry& entry : table) {
    if (name == entry.name) return entry;
    names += (names.empty() ? "" : ", ") + std::string(entry.name);
  }
  throw InputError(fmt::format("unknown generator '{}' (available: {})", name, names));
}

void generator::checkRange(const char* name, uint32_t triangles, uint32_t min, uint32_t max) {
  if (triangles < min || triangles > max)
    throw InputError(fmt::format("generator '{}': expected {} to {} triangles, got {}", name, min, max, triangles));
}

QuadLight generator::lampAt(const vec3& at, const vec3& towards, float side, const vec3& radiance) {
  const vec3 way = glm::normalize(towards - at);
  const vec3 u = glm::normalize(glm::cross(way, std::abs(way.y) < 0.9f ? vec3(0, 1, 0) : vec3(0, 0, 1)));
  const vec3 v = glm::cross(way, u);  // cross(u, v) is `way`.
  return {at - 0.5f * side * (u + v), side * u, side * v, radiance};
}

void generator::dropUnusedMaterials(Scene& scene) {
  constexpr uint32_t unused = ~0u;
  std::vector<uint32_t> becomes(scene.materials.size(), unused);
  for (const uint32_t m : scene.materialOf) becomes[m] = 0;
  std::vector<Material> kept;
  for (std::size_t i = 0; i < becomes.size(); ++i) {
    if (becomes[i] == unused) continue;
    becomes[i] = static_cast<uint32_t>(kept.size());
    kept.push_back(scene.materials[i]);
  }
  for (uint32_t& m : scene.materialOf) m = becomes[m];
  scene.materials = std::move(kept);
}

}  // namespace copse
