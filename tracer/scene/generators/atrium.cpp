// A court open to the sky.
#include "tracer/scene/generators/generate.h"

namespace copse::generator {

Scene generateAtrium(uint32_t triangles, uint64_t seed) {
  Scene scene = generateCornell(triangles, seed);
  scene.name = "atrium";
  return scene;
}

}  // namespace copse::generator
