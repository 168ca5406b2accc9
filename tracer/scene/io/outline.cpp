// Reads the TOML alone; generators are asked for the smallest scene that they make.
#include "tracer/scene/io/outline.h"

#include <fmt/format.h>
#include <toml++/toml.h>

#include <filesystem>

#include "builder/base/error.h"
#include "builder/base/files.h"
#include "builder/base/text.h"
#include "builder/base/toml_keys.h"
#include "tracer/generators/generators.h"
#include "tracer/scene/io/find_scene_file.h"

namespace copse {

namespace {

const char* const madeUpView = "front";

std::string placeOf(const std::string& file, const toml::node& node) {
  return fmt::format("{}:{}", file, node.source().begin.line);
}

/// Names of the [[view]] tables, or what loadScene calls those without a name.
std::vector<std::string> viewsOf(const toml::table& root) {
  std::vector<std::string> names;
  if (const toml::array* views = root["view"].as_array())
    for (const toml::node& view : *views)
      if (const toml::table* table = view.as_table())
        names.push_back((*table)["name"].value_or(fmt::format("view{}", names.size() + 1)));
  return names;
}

}  // namespace

std::vector<std::string> generatorViews(const std::string& generator) {
  const GeneratorEntry& entry = findGenerator(generator);
  std::vector<std::string> names;
  for (const uint32_t triangles : {uint32_t{5000}, uint32_t{20'000}, uint32_t{100'000}, entry.defaultTriangles}) {
    try {
      for (const Camera& camera : entry.generate(triangles, 1).cameras) names.push_back(camera.name);
      return names;
    } catch (const InputError&) {
      if (triangles == entry.defaultTriangles) throw;
    }
  }
  return names;
}

SceneOutline outlineOf(const std::string& file) {
  SceneOutline outline;
  const std::filesystem::path path(file);
  outline.name = path.stem().string();
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) {
    outline.missing = fmt::format("no file {}", file);
    return outline;
  }
  if (extensionOf(file) != ".toml") {
    outline.views = {madeUpView};
    if (const auto size = std::filesystem::file_size(path, error); !error) outline.bytes = size;
    return outline;
  }
  const toml::table root = parseToml(readFile(file), file);
  outline.name = root["name"].value_or(outline.name);
  outline.views = viewsOf(root);
  const bool ownViews = !outline.views.empty();
  const toml::array* meshes = root["mesh"].as_array();
  for (std::size_t i = 0; meshes && i < meshes->size(); ++i) {
    const toml::table* mesh = (*meshes)[i].as_table();
    if (!mesh) continue;
    for (const char* key : {"file", "materials", "instances"}) {
      const toml::node* name = mesh->get(key);
      if (!name || !name->is_string() || !outline.missing.empty()) continue;
      try {
        const std::string found = findSceneFile(name->as_string()->get(), file, placeOf(file, *name));
        if (const auto size = std::filesystem::file_size(found, error); !error) outline.bytes += size;
      } catch (const InputError& notThere) {
        outline.missing = notThere.what();
      }
    }
    const std::optional<std::string> generator = (*mesh)["generator"].value<std::string>();
    if (generator)
      outline.triangles += (*mesh)["triangles"].value_or(int64_t{findGenerator(*generator).defaultTriangles});
    if (generator && !ownViews)
      for (const std::string& view : generatorViews(*generator)) outline.views.push_back(view);
  }
  if (outline.views.empty()) outline.views = {madeUpView};
  return outline;
}

}  // namespace copse
