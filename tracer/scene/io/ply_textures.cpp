// One material a texture, and a grey one for faces without.
#include "tracer/scene/io/ply_textures.h"

#include <fmt/format.h>

#include <cmath>

#include "tracer/scene/io/file_finder.h"
#include "tracer/scene/io/mesh.h"

namespace copse {

void PlyTextures::takeFace(std::size_t count, Scene& scene) {
  if (!hasCorners && !hasNumbers) return;
  const bool isOne = number >= 0 && number < static_cast<double>(files.size());
  faces_.push_back({static_cast<uint32_t>(scene.uvs.size()),
                    isOne ? static_cast<uint32_t>(number) : static_cast<uint32_t>(files.size())});
  if (!hasCorners) return;
  const bool good = corners.size() == 2 * count;
  badFaces_ += !good;
  for (std::size_t i = 0; i < count; ++i) {
    const vec2 uv = good ? vec2(corners[2 * i], corners[2 * i + 1]) : vec2(0);
    scene.uvs.push_back(std::abs(uv.x) < 1e30f && std::abs(uv.y) < 1e30f ? uv : vec2(0));
  }
}

void PlyTextures::addTriangles(const std::vector<uvec3>& cut, Scene& scene) {
  if (faces_.empty()) return;
  const Face& face = faces_[added_++];
  if (hasNumbers) scene.materialOf.resize(scene.triangles.size(), face.material);
  if (!hasCorners) return;
  for (const uvec3& t : cut) scene.uvTriangles.push_back(t + face.firstUv);
}

void PlyTextures::finish(const std::string& file, Scene& scene) {
  const auto remark = [&](const std::string& kind, const std::string& what) {
    scene.remarks.push_back({kind, fmt::format("{}: {}", file, what)});
  };
  if (!hasCorners && !scene.uvs.empty()) scene.uvTriangles = scene.triangles;
  if (badFaces_)
    remark("PLY corners", fmt::format("ignored the texture coordinates of {} faces: expected two per "
                                      "corner",
                                      badFaces_));
  if (!files.empty() && scene.uvTriangles.empty() && !scene.triangles.empty())
    remark("PLY without coordinates", fmt::format("ignored texture {}: the mesh has no texture coordinates", files[0]));
  if (files.size() > 1 && !hasNumbers)
    remark("PLY without numbers",
           fmt::format("no face says which of {} textures it has; using {}", files.size(), files[0]));
  FileFinder finder(file);
  for (const std::string& name : files) {
    const std::optional<FoundFile> found = finder.find(name);
    if (found && found->guessed)
      remark("guessed texture", fmt::format("no texture {}; using {}", finder.place(name), found->path));
    Material material = greyMaterial(name);
    if (!scene.uvTriangles.empty()) material.texture = static_cast<int>(scene.textures.size());
    scene.textures.emplace_back().file = found ? found->path : finder.place(name);
    scene.materials.push_back(std::move(material));
  }
  scene.materials.push_back(greyMaterial("default"));
  scene.materialOf.resize(scene.triangles.size(), 0);
}

}  // namespace copse
