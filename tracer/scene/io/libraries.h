// Which libraries a mesh means, and which of their materials.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tracer/scene/io/mesh.h"

namespace copse {

/// Adds a library's materials to the scene's. One that cannot be read to its end costs a remark and never an error.
void readLibrary(const std::string& library, Scene& scene);

/// Adds the materials of all libraries that the mtllib lines of the OBJ `file` name, each file once. `lines` are what
/// follows the key: one file, or several, whose names may have blanks or quotes. Where none of them is there and the
/// mesh `needsOne`, NAME.mtl beside NAME.obj stands in. All that is missing or guessed is remarked on.
void readLibraries(const std::string& file, const std::vector<std::string>& lines, bool needsOne, Scene& scene);

/// Indices into the scene's materials by name, and where there is none by foldedName(); where there is none of that
/// either a grey one of that name is added, with a remark. The first of several of a name is taken; "" is no name
/// unless a material has it, and gives ~0u.
std::vector<uint32_t> findMaterials(const std::string& file, const std::vector<std::string>& names, Scene& scene);

/// For a mesh that names no material: adds those of the given library, and all triangles get the one that is given, or
/// the library's only one. Throws InputError "WHERE: …" where there is no such material.
void giveMaterial(Scene& scene, const GivenMaterials& given);

}  // namespace copse
