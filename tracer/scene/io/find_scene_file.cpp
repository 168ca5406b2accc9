// Beside the scene, then in the folders of COPSE_SCENES.
#include "tracer/scene/io/find_scene_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <string_view>
#include <vector>

#include "builder/base/error.h"

namespace copse {
namespace fs = std::filesystem;

std::string findSceneFile(const std::string& name, const std::string& scene, const std::string& where) {
  std::vector<fs::path> folders{fs::path(scene).parent_path()};
  const char* named = std::getenv("COPSE_SCENES");
  std::string_view rest = named ? named : "";
  while (!rest.empty()) {
    const std::size_t colon = std::min(rest.find(':'), rest.size());
    if (colon > 0) folders.emplace_back(rest.substr(0, colon));
    rest.remove_prefix(std::min(colon + 1, rest.size()));
  }
  if (fs::path(name).is_absolute()) folders = {""};

  std::string looked;
  for (const fs::path& folder : folders) {
    const fs::path file = folder / name;
    std::error_code error;
    if (fs::exists(file, error)) return file.string();
    looked += "\n  looked at " + file.string();
  }
  throw InputError(fmt::format("{}: no file '{}'{}\n  COPSE_SCENES, {}, names more folders to search", where, name,
                               looked, named && *named ? "separated by colons" : "which is not set"));
}

}  // namespace copse
