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
  Scene scene;  ///< Geometry (with exactPositions), materials, textures, notes; a generator's has lights and views too.
  std::vector<std::string> objects;  ///< Names of the OBJ's `o` (where it has none: `g`) groups.
  std::vector<uint32_t> objectOf;    ///< Per triangle, into objects; empty where there are no objects.
};

/// What a scene says of the materials of a mesh. For none every string is "".
struct GivenMaterials {
  std::string library;           ///< One more MTL beside those that the file names.
  std::string material;          ///< Of that library, for a mesh that names none.
  std::string where;             ///< "FILE:LINE" of what is given, for messages.
  bool areForInstances = false;  ///< Instances name materials, so that the mesh need not.
};

/// The nearest float, not infinite where the number is not.
inline float toCoordinate(double value) {
  constexpr double max = std::numeric_limits<float>::max();
  return static_cast<float>(std::isfinite(value) ? std::clamp(value, -max, max) : value);
}

inline vec3 toCoordinates(const glm::dvec3& p) { return {toCoordinate(p.x), toCoordinate(p.y), toCoordinate(p.z)}; }

/// The grey of what has no material.
inline Material greyMaterial(const std::string& name) { return {.name = name}; }

/// Reads FILE.obj or FILE.ply.
/// Polygons are triangulated: n corners make n - 2 triangles, those of no area included. Vertices may not be finite.
/// Throws InputError "FILE:LINE: what".
Mesh loadMesh(const std::string& file, const GivenMaterials& given = {});
Mesh loadObj(const std::string& file, const GivenMaterials& given);
Mesh loadPly(const std::string& file);

/// Adds the materials of an MTL, and the textures that they name, to the scene's. What is ignored or guessed becomes
/// remarks. Throws InputError "FILE: why" where the file cannot be read or is no text; materials before that place
/// stay.
void readMaterials(const std::string& file, Scene& scene);

}  // namespace copse
