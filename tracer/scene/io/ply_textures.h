// Textures as MeshLab and others put them into a PLY: "comment TextureFile NAME", and perhaps coordinates per corner.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tracer/scene/scene.h"

namespace copse {

struct PlyTextures {
  std::vector<std::string> files;  ///< As the header names them.
  bool hasCorners = false;         ///< Faces have coordinates; they come before those of vertices.
  bool hasNumbers = false;         ///< Faces say which of the files is theirs.

  // The face in hand.
  std::vector<float> corners;  ///< u and v of each corner.
  double number = 0;           ///< Into files.

  /// Keeps what is said of the face in hand, which has so many corners.
  void takeFace(std::size_t count, Scene& scene);
  /// Its triangles, by its corners; the scene has got them already. Faces come in the order in which they were taken.
  void addTriangles(const std::vector<uvec3>& cut, Scene& scene);
  /// Makes the scene's materials and texture coordinates, once all faces are there.
  void finish(const std::string& file, Scene& scene);

 private:
  struct Face {
    uint32_t firstUv, material;
  };
  std::vector<Face> faces_;
  std::size_t added_ = 0;
  std::size_t badFaces_ = 0;
};

}  // namespace copse
