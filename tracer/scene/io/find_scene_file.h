// Where the files that a scene names are looked for.
#pragma once

#include <string>

namespace copse {

/// Looks for `name` beside `scene`, then in the folders that COPSE_SCENES names (colon between two). Throws InputError
/// "WHERE: …" that says where it looked; `where` is the FILE:LINE that names the file.
std::string findSceneFile(const std::string& name, const std::string& scene, const std::string& where);

}  // namespace copse
