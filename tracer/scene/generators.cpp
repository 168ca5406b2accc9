// The table of generators. A new one is a file in generators/ and a row here; tests and `copse list` find it there.
#include "tracer/scene/generators.h"

#include <fmt/format.h>

#include "builder/parallel/error.h"
#include "tracer/scene/generators/generate.h"

namespace copse {

namespace {
const GeneratorEntry table[] = {
    {"atrium", "a two-storey colonnaded court with vaults, drapery, plants and cables, open to the sky", 262'144,
     generator::generateAtrium},
    {"hairball", "thin curled strands around a ball: 288 overlapping triangles each, the hardest case for boxes",
     2'880'000, generator::generateHairball},
    {"cornell", "the measured Cornell box, its walls and blocks subdivided", 38, generator::generateCornell},
};
}  // namespace

std::span<const GeneratorEntry> generators() { return table; }

const GeneratorEntry& findGenerator(const std::string& name) {
  std::string names;
  for (const GeneratorEntry& entry : table) {
    if (name == entry.name) return entry;
    names += (names.empty() ? "" : ", ") + std::string(entry.name);
  }
  throw InputError(fmt::format("no generator '{}': there is {}", name, names));
}

void generator::checkRange(const char* name, uint32_t triangles, uint32_t least, uint32_t most) {
  if (triangles < least || triangles > most)
    throw InputError(
        fmt::format("generator '{}': {} triangles asked for, it makes {} to {}", name, triangles, least, most));
}

}  // namespace copse
