// What a scene file says before its meshes are read: its name, its views, and the files that are not there. For those
// who plan long work and want to know first.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace copse {

struct SceneOutline {
  std::string name;
  std::vector<std::string> views;  ///< Names, in the order that loadScene gives them.
  uint64_t triangles = 0;          ///< From its generators; those of files are not known before they are read.
  uint64_t bytes = 0;              ///< The size of its meshes' files.
  std::string missing;             ///< The first file that is not there, and where it was looked for; "" where all are.
};

/// Outlines a scene TOML or a bare mesh. A file that is not there, or whose meshes are not, is `missing`; one that is
/// there and wrong throws InputError "FILE:LINE: what". Keys of meshes and lights are checked by loadScene alone.
SceneOutline outlineOf(const std::string& file);

/// The names of the views that a generator's scene has. Throws InputError that lists the generators.
std::vector<std::string> generatorViews(const std::string& generator);

}  // namespace copse
