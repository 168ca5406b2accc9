// A scene file of any kind into a Scene that can be rendered: what the file leaves out is made up, and said.
#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <limits>
#include <new>

#include "builder/base/error.h"
#include "builder/base/files.h"
#include "tracer/scene/io/assemble.h"
#include "tracer/scene/io/libraries.h"
#include "tracer/scene/io/scene_toml.h"

namespace copse {
namespace {

/// Looks at the whole of the bounding sphere from the front, a little from the right and from above.
Camera frame(Scene& scene) {
  const Box bounds = scene.bounds();
  const bool empty = bounds.empty();
  const glm::dvec3 diagonal = empty ? glm::dvec3(2, 0, 0) : glm::dvec3(bounds.hi) - glm::dvec3(bounds.lo);
  const vec3 centre = empty ? vec3(0) : bounds.lo + 0.5f * (bounds.hi - bounds.lo);
  const double radius = 0.5 * glm::length(diagonal);
  // Eye and centre are rounded to float: nearer than this the rounding would turn the view by more than a fiftieth.
  const double nearest = 32.0 * std::numeric_limits<float>::epsilon() * glm::length(glm::dvec3(centre));
  if (radius > 0 && radius < nearest)
    scene.notes.push_back(fmt::format(
        "{}: too small for its distance from the origin: float precision moves the camera farther away", scene.file));
  const float vfov = 45;
  const double far = radius > 0 ? std::max(radius, nearest) : std::max(nearest, 1e-6);
  const glm::dvec3 way = far / std::sin(vfov / 2 * 0.017453292519943295) * glm::normalize(glm::dvec3(0.5, 0.4, 1));
  return {"front", vec3(glm::dvec3(centre) + way), centre, {0, 1, 0}, vfov};
}

Scene readBareMesh(const std::string& file) {
  Scene scene;
  scene.file = file;
  scene.name = std::filesystem::path(file).stem().string();
  Mesh mesh = loadMesh(file);
  dropOutOfReach(mesh.scene, file);
  append(scene, std::move(mesh.scene));
  scene.sky = SkyLight{{1, 1, 1}, "", {}};
  scene.notes.push_back(fmt::format("{}: a bare mesh, lit by a white sky of radiance 1", file));
  return scene;
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

Scene loadScene(const std::string& file) {
  const std::string ending = extensionOf(file);
  if (ending != ".toml" && ending != ".obj" && ending != ".ply")
    throw InputError(fmt::format("{}: unsupported scene format '{}' (expected .toml, .obj or .ply)", file, ending));
  try {
    Scene scene = ending == ".toml" ? readSceneToml(file) : readBareMesh(file);
    dropUnused(scene);
    placeTextures(scene);
    noteRemarks(scene);
    makeUp(scene);
    return scene;
  } catch (const std::bad_alloc&) {
    throw InputError(fmt::format("{}: not enough memory", file));
  }
}

}  // namespace copse
