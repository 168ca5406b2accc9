// The small things that a scene knows about itself.
#include "tracer/scene/scene.h"

#include <fmt/format.h>

#include <algorithm>

#include "builder/base/error.h"

namespace copse {

Box Scene::bounds() const {
  Box box;
  for (const uvec3& t : triangles)
    for (int k = 0; k < 3; ++k) box.grow(positions[t[k]]);
  return box;
}

uint32_t Scene::emitterCount() const {
  const auto shines = [](vec3 radiance) { return radiance != vec3(0); };
  const auto skyShines = [&] {  // An image that is not loaded yet is taken for one that shines.
    if (sky->file.empty()) return shines(sky->radiance);
    return sky->image.pixels.empty() || std::ranges::any_of(sky->image.pixels, shines);
  };
  uint32_t count = sky && skyShines();
  for (const QuadLight& quad : quads) count += shines(quad.radiance);
  for (std::size_t i = 0; i < triangles.size(); ++i) count += emits(i) && hasArea(i);
  return count;
}

bool Scene::hasArea(std::size_t triangle) const {
  using glm::dvec3;
  const uvec3 t = triangles[triangle];
  const dvec3 corner(positions[t.x]);
  return glm::length(glm::cross(dvec3(positions[t.y]) - corner, dvec3(positions[t.z]) - corner)) > 0;
}

glm::dvec3 restOf(const glm::dvec3& exact, const vec3& rounded) { return exact - glm::dvec3(rounded); }

UpAxis upAxis(const std::string& name) {
  if (name == "y") return UpAxis::y;
  if (name == "z") return UpAxis::z;
  throw InputError(fmt::format("unknown axis '{}' (expected y or z)", name));
}

Camera inFiles(const Scene& scene, Camera camera) {
  camera.setEye(scene.origin + camera.exactEye());
  camera.setAt(scene.origin + camera.exactAt());
  return camera;
}

const Camera& findCamera(const Scene& scene, const std::string& name) {
  std::string names;
  for (const Camera& camera : scene.cameras) {
    if (name.empty() || camera.name == name) return camera;
    names += (names.empty() ? "" : ", ") + camera.name;
  }
  throw InputError(fmt::format("{}: no view '{}' (available: {})", scene.file, name, names.empty() ? "none" : names));
}

}  // namespace copse
