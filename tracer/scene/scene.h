// What a scene file says, flattened: indexed triangles, materials, lights, views. Host memory; no room below the
// tracers changes it.
#pragma once

#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "builder/math/box.h"
#include "builder/math/vec.h"
#include "tracer/scene/image.h"
#include "tracer/scene/texels.h"

namespace copse {

/// Something that a file says and that is not followed to the letter. Of each kind a scene's notes have the first and
/// how many there are.
struct Remark {
  std::string kind, text;  ///< `text` is a whole note.
};

/// Lambertian and two-sided. Emission leaves both sides of the triangle.
struct Material {
  std::string name;
  vec3 kd{0.6f, 0.6f, 0.6f};
  vec3 ke{0, 0, 0};  ///< Radiance, W/(m² sr).
  int texture = -1;  ///< Index into Scene::textures, in place of kd; -1 for none.
  /// Where in the texture a triangle's coordinates are: uvScale * uv + uvOffset. loadScene() applies both to the
  /// coordinates, so that scenes have 1 and 0 here.
  vec2 uvScale{1, 1}, uvOffset{0, 0};
  std::vector<Remark> remarks = {};  ///< Until loadScene() has made notes of those whose material a triangle uses.
};

/// Kd map: bilinear, repeating; v = 0 is the bottom row.
struct Texture {
  std::string file;
  bool linear = false;  ///< Whole numbers in the file are light or data as they are, not sRGB.
  /// Null until loadTextures() of tracer/image; while it is, the material's kd is used. Shared with what renders, so
  /// that the texels lie in memory once.
  std::shared_ptr<const Texels> texels;
};

/// What rounding to float takes from a place. Not inline: where GCC 12 sees doubles turned to floats and back, it takes
/// two at a time for unchanged.
glm::dvec3 restOf(const glm::dvec3& exact, const vec3& rounded);

/// A light and not a surface: rays pass through it and no camera sees it. Shines to the side of cross(edgeU, edgeV).
struct QuadLight {
  vec3 corner, edgeU, edgeV;
  vec3 radiance;
  glm::dvec3 cornerRest{0};  ///< Until loadScene() has moved the scene to where floats are: what `corner` lacks.
};

/// Light from infinitely far away. Seen by the camera and by every ray that leaves the scene.
struct SkyLight {
  vec3 radiance{0, 0, 0};
  std::string file;  ///< Equirectangular image in place of `radiance`; +y up, centre column -z, +x right of that.
  Image image;       ///< Empty until loadTextures() of tracer/image.
  /// Degrees by which the image is turned about +y, counter-clockwise from above: at 90 its centre column is at -x.
  double rotation = 0;

  /// The same as a part of the image's width, 0 … 1: what is added to where an unturned image would be looked up.
  double turn() const { return rotation / 360 - std::floor(rotation / 360); }
};

/// A `[[view]]` of a scene file.
struct Camera {
  std::string name;
  vec3 eye, at, up;
  float vfov;  ///< Degrees, the whole vertical angle.
  /// What `eye` and `at` lack where floats are too coarse for them: in a view from far away, and until loadScene() has
  /// moved the scene to where floats are.
  glm::dvec3 eyeRest{0}, atRest{0};
  /// In a view from far away: no triangle is nearer than that along it, and rays start there; see tracer/integrators.
  double start = 0;

  glm::dvec3 exactEye() const { return glm::dvec3(eye) + eyeRest; }
  glm::dvec3 exactAt() const { return glm::dvec3(at) + atRest; }
  void setEye(const glm::dvec3& exact) {
    eye = vec3(exact);
    eyeRest = restOf(exact, eye);
  }
  void setAt(const glm::dvec3& exact) {
    at = vec3(exact);
    atRest = restOf(exact, at);
  }
};

/// The axis of a mesh's file that points up.
enum class UpAxis { y, z };
/// "y" or "z"; throws InputError for all else.
UpAxis upAxis(const std::string& name);

/// What a user says of a scene beside its file.
struct LoadOptions {
  UpAxis up = UpAxis::y;              ///< Of meshes from files whose [[mesh]] does not say it.
  std::optional<double> skyRotation;  ///< In degrees; replaces the sky's own.
};

struct Scene {
  std::string name;
  std::string file;        ///< The file that was read, for messages.
  bool generated = false;  ///< Some of its triangles are made by a generator.
  LoadOptions options;     ///< What it was loaded with.

  /// Where the zero of all coordinates here is in those of the files: not 0 where the scene is far from their zero
  /// compared with its size, since floats would not tell its details apart there. See io/origin.h.
  glm::dvec3 origin{0};
  std::vector<vec3> positions;
  std::vector<glm::dvec3> exactPositions;  ///< In place of `positions`, until loadScene() has rounded them.
  std::vector<uvec3> triangles;            ///< Into positions.
  std::vector<uint32_t> materialOf;        ///< Per triangle, into materials.
  std::vector<vec2> uvs;
  std::vector<uvec3> uvTriangles;  ///< Per triangle, into uvs; empty where the scene has none.
  std::vector<Material> materials;
  std::vector<Texture> textures;

  std::vector<QuadLight> quads;
  std::optional<SkyLight> sky;
  std::vector<Camera> cameras;

  std::vector<std::string> notes;  ///< What a user should be told: made-up camera, dropped triangles, missing MTL.
  std::vector<Remark> remarks;     ///< What becomes notes once the scene is whole.

  Box bounds() const;
  bool emits(std::size_t triangle) const {
    const vec3 ke = materials[materialOf[triangle]].ke;
    return ke.x > 0 || ke.y > 0 || ke.z > 0;
  }
  bool hasArea(std::size_t triangle) const;
  /// Emitting triangles that have an area, and quads and a sky whose radiance is not 0.
  uint32_t emitterCount() const;
};

/// Reads a scene TOML or a bare mesh (.obj, .ply). Throws InputError "FILE:LINE: what".
/// Does not read textures: see loadTextures().
Scene loadScene(const std::string& file, const LoadOptions& options = {});

/// A view of the scene in the coordinates of its files.
Camera inFiles(const Scene& scene, Camera camera);

/// The camera of that name; the first for "". Throws InputError that lists the names.
const Camera& findCamera(const Scene& scene, const std::string& name);

}  // namespace copse
