// A mesh as its file says it: a part of a scene, and which object each triangle belongs to. Readers of OBJ, MTL and
// PLY.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "tracer/scene/scene.h"

namespace copse {

struct Mesh {
  Scene scene;                       ///< Geometry, materials, textures, notes; a generator's has lights and views too.
  std::vector<std::string> objects;  ///< Names of the OBJ's `o` (where it has none: `g`) groups.
  std::vector<uint32_t> objectOf;    ///< Per triangle, into objects; empty where there are no objects.
};

/// The nearest float, not infinite where the number is not: what is too far away is told from what is no number.
inline float toCoordinate(double value) {
  constexpr double max = std::numeric_limits<float>::max();
  return static_cast<float>(std::isfinite(value) ? std::clamp(value, -max, max) : value);
}

/// The grey of what has no material.
inline Material greyMaterial(const std::string& name) { return {name, {0.6f, 0.6f, 0.6f}, {0, 0, 0}, -1}; }

/// Reads FILE.obj or FILE.ply. `library` is one more MTL beside those that the file names; "" for none.
/// Polygons are triangulated: n corners make n - 2 triangles, those of no area included. Vertices may not be finite.
/// Throws InputError "FILE:LINE: what".
Mesh loadMesh(const std::string& file, const std::string& library = "");
Mesh loadObj(const std::string& file, const std::string& library);
Mesh loadPly(const std::string& file);

/// Adds the materials of an MTL, and the textures that they name, to the scene's. Throws InputError "FILE:LINE: what".
void readMaterials(const std::string& file, Scene& scene);

}  // namespace copse
