// What is done to a mesh between its file and the scene: placed, freed of what is left out or cannot be traced, joined.
#pragma once

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "tracer/scene/io/mesh.h"

namespace copse {

/// From the origin, in a scene's unit: beyond it products of three lengths leave the range of float.
inline constexpr double farthest = 1e12;

inline bool isFinite(const glm::dvec3& p) { return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z); }

/// Row-major 3x4, from the mesh's space to the scene's.
struct Affine {
  double m[12] = {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0};

  glm::dvec3 vector(const glm::dvec3& v) const {
    return {m[0] * v.x + m[1] * v.y + m[2] * v.z, m[4] * v.x + m[5] * v.y + m[6] * v.z,
            m[8] * v.x + m[9] * v.y + m[10] * v.z};
  }
  /// A finite point stays finite: where a double overflows it is as far away as one can be.
  glm::dvec3 point(const glm::dvec3& p) const {
    const glm::dvec3 placed = vector(p) + glm::dvec3(m[3], m[7], m[11]);
    return isFinite(placed) || !isFinite(p) ? placed : glm::dvec3(std::numeric_limits<float>::max());
  }
  /// Negative where it mirrors.
  double determinant() const {
    return m[0] * (m[5] * m[10] - m[6] * m[9]) - m[1] * (m[4] * m[10] - m[6] * m[8]) +
           m[2] * (m[4] * m[9] - m[5] * m[8]);
  }
};

/// The maximum number of triangles of a scene: 2^31 - 2.
inline constexpr uint64_t maxTriangles = 0x7ffffffe;

/// Replaces the mesh by the copies that an instance file lists, one per line: object, material, 12 numbers. Reads the
/// first `lines` of them, 0 for all. Throws InputError "FILE:LINE: what".
void placeInstances(Mesh& mesh, const std::string& file, uint64_t lines);

/// Moves geometry, quads and views, in double. Quads go on shining to the side that they lit.
void transform(Scene& scene, const Affine& affine);

/// A file's z-up coordinates as y-up ones, exactly: (x, z, -y).
void turnUp(Scene& scene, UpAxis up);

/// Removes the triangles of these materials. Throws InputError "WHERE: …" for a name that the scene does not have.
void leaveOutMaterials(Scene& scene, const std::vector<std::string>& names, const std::string& where);

/// Removes triangles with a vertex that is not finite, or beyond `farthest`; notes how many of each.
void dropOutOfReach(Scene& scene, const std::string& file);

/// Adds a part's geometry, materials, textures, notes and remarks. Throws InputError where there are too many
/// triangles.
void append(Scene& scene, Scene&& part);

/// Removes the positions, materials and textures that no triangle uses.
void dropUnused(Scene& scene);

/// Texture coordinates as the materials scale and move them; linear in the triangles of those that do.
void placeTextures(Scene& scene);

/// Makes notes of the remarks of the scene and its materials: of each kind the first, with their number.
void noteRemarks(Scene& scene);

}  // namespace copse
