// What a scene file says, flattened: indexed triangles, materials, lights, views. Host memory; no room below the
// tracers changes it.
#pragma once

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

/// A light and not a surface: rays pass through it and no camera sees it. Shines to the side of cross(edgeU, edgeV).
struct QuadLight {
  vec3 corner, edgeU, edgeV;
  vec3 radiance;
};

/// Light from infinitely far away. Seen by the camera and by every ray that leaves the scene.
struct SkyLight {
  vec3 radiance{0, 0, 0};
  std::string file;  ///< Equirectangular image in place of `radiance`; +y up, centre column -z, +x right of that.
  Image image;       ///< Empty until loadTextures() of tracer/image.
};

/// A `[[view]]` of a scene file.
struct Camera {
  std::string name;
  vec3 eye, at, up;
  float vfov;  ///< Degrees, the whole vertical angle.
};

struct Scene {
  std::string name;
  std::string file;        ///< The file that was read, for messages.
  bool generated = false;  ///< Some of its triangles are made by a generator.

  std::vector<vec3> positions;
  std::vector<uvec3> triangles;      ///< Into positions.
  std::vector<uint32_t> materialOf;  ///< Per triangle, into materials.
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
Scene loadScene(const std::string& file);

/// The camera of that name; the first for "". Throws InputError that lists the names.
const Camera& findCamera(const Scene& scene, const std::string& name);

}  // namespace copse
