// A scene file of any kind into a Scene that can be rendered: what the file leaves out is made up, and said.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <new>

#include "builder/base/error.h"
#include "builder/base/files.h"
#include "tracer/scene/io/assemble.h"
#include "tracer/scene/io/libraries.h"
#include "tracer/scene/io/origin.h"
#include "tracer/scene/io/scene_toml.h"

namespace copse {
namespace {

/// Looks at the whole of the bounding sphere from the front, a little from the right and from above.
Camera frame(const Scene& scene) {
  const Box bounds = scene.bounds();
  const bool empty = bounds.empty();
  const glm::dvec3 diagonal = empty ? glm::dvec3(2, 0, 0) : glm::dvec3(bounds.hi) - glm::dvec3(bounds.lo);
  const vec3 centre = empty ? vec3(0) : bounds.lo + 0.5f * (bounds.hi - bounds.lo);
  const double radius = 0.5 * glm::length(diagonal);
  const float vfov = 45;
  const double far = radius > 0 ? radius : 1e-6;
  const glm::dvec3 way = far / std::sin(vfov / 2 * 0.017453292519943295) * glm::normalize(glm::dvec3(0.5, 0.4, 1));
  return {"front", vec3(glm::dvec3(centre) + way), centre, {0, 1, 0}, vfov};
}

Scene readBareMesh(const std::string& file, const LoadOptions& options) {
  Scene scene;
  scene.file = file;
  scene.name = std::filesystem::path(file).stem().string();
  Mesh mesh = loadMesh(file);
  turnUp(mesh.scene, options.up);
  dropOutOfReach(mesh.scene, file);
  append(scene, std::move(mesh.scene));
  dropUnused(scene);
  moveToOrigin(scene);
  scene.sky = SkyLight{{1, 1, 1}, "", {}};
  scene.notes.push_back(fmt::format("{}: a bare mesh, lit by a white sky of radiance 1", file));
  return scene;
}

void turnSky(Scene& scene, const LoadOptions& options) {
  if (!options.skyRotation) return;
  if (scene.sky && !scene.sky->file.empty())
    scene.sky->rotation = *options.skyRotation;
  else
    scene.notes.push_back(fmt::format("{}: ignored the sky's rotation: the scene has no image of a sky", scene.file));
}

void makeUp(Scene& scene) {
  if (scene.triangles.empty()) scene.notes.push_back(fmt::format("{}: the scene has no triangles", scene.file));
  if (scene.cameras.empty()) {
    scene.cameras.push_back(frame(scene));
    scene.notes.push_back(fmt::format("{}: no view; using a camera that frames the scene", scene.file));
  }
}

}  // namespace

Mesh loadMesh(const std::string& file, const GivenMaterials& given) {
  const std::string ending = extensionOf(file);
  if (ending == ".obj") return loadObj(file, given);
  if (ending != ".ply")
    throw InputError(fmt::format("{}: unsupported mesh format '{}' (expected .obj or .ply)", file, ending));
  Mesh mesh = loadPly(file);
  if (!given.library.empty()) giveMaterial(mesh.scene, given);
  return mesh;
}

Scene loadScene(const std::string& file, const LoadOptions& options) {
  const std::string ending = extensionOf(file);
  if (ending != ".toml" && ending != ".obj" && ending != ".ply")
    throw InputError(fmt::format("{}: unsupported scene format '{}' (expected .toml, .obj or .ply)", file, ending));
  try {
    Scene scene = ending == ".toml" ? readSceneToml(file, options) : readBareMesh(file, options);
    placeTextures(scene);
    noteRemarks(scene);
    scene.options = options;
    turnSky(scene, options);
    makeUp(scene);
    finishViews(scene);
    return scene;
  } catch (const std::bad_alloc&) {
    throw InputError(fmt::format("{}: not enough memory", file));
  }
}

}  // namespace copse
