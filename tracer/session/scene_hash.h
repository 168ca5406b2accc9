// Whether two scenes give the same images: a number for all that a render reads of a loaded scene.
#pragma once

#include <cstdint>

#include "tracer/scene/scene.h"

namespace copse {

/// 64 bits over triangles, texture coordinates, materials, texels, lights and sky; not over names, files and views.
/// Linear in the scene's size: some gigabytes per second. Textures and sky must have been loaded.
uint64_t sceneHash(const Scene& scene);

}  // namespace copse
