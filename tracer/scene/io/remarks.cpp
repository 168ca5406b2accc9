// What is left to do with materials once a scene is whole: their textures' places, and what is to be said about them.
#include <fmt/format.h>

#include <map>
#include <unordered_map>

#include "tracer/scene/io/assemble.h"

namespace copse {

void placeTextures(Scene& scene) {
  for (Material& material : scene.materials)
    if (material.texture >= 0 && scene.uvTriangles.empty())
      material.remarks.push_back({"no coordinates", fmt::format("'{}' has a texture, but the mesh no texture "
                                                                "coordinates; using Kd",
                                                                material.name)});
  // Triangles of one material share corners; those of two do not get each other's coordinates.
  std::vector<std::unordered_map<uint32_t, uint32_t>> placed(scene.materials.size());
  for (std::size_t i = 0; i < scene.uvTriangles.size(); ++i) {
    const Material& material = scene.materials[scene.materialOf[i]];
    if (material.texture < 0 || (material.uvScale == vec2(1) && material.uvOffset == vec2(0))) continue;
    for (int k = 0; k < 3; ++k) {
      uint32_t& index = scene.uvTriangles[i][k];
      const auto [place, isNew] =
          placed[scene.materialOf[i]].try_emplace(index, static_cast<uint32_t>(scene.uvs.size()));
      if (isNew) {
        const vec2 uv = material.uvScale * scene.uvs[index] + material.uvOffset;
        scene.uvs.push_back(std::isfinite(uv.x) && std::isfinite(uv.y) ? uv : vec2(0));
      }
      index = place->second;
    }
  }
  for (Material& material : scene.materials) material.uvScale = vec2(1), material.uvOffset = vec2(0);
}

void noteRemarks(Scene& scene) {
  std::vector<std::pair<std::string, std::size_t>> notes;  // In the order of the first of each kind.
  std::map<std::string, std::size_t> ofKind;
  const auto take = [&](std::vector<Remark>& remarks) {
    for (Remark& remark : remarks) {
      const auto [place, isNew] = ofKind.try_emplace(remark.kind, notes.size());
      if (isNew) notes.emplace_back(std::move(remark.text), 0);
      ++notes[place->second].second;
    }
    remarks = {};
  };
  take(scene.remarks);
  for (Material& material : scene.materials) take(material.remarks);
  for (const auto& [text, count] : notes)
    scene.notes.push_back(count == 1 ? text : fmt::format("{} ({} in all)", text, count));
}

}  // namespace copse
