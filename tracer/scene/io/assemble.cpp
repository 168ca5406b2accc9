// Parts into one scene.
#include "tracer/scene/io/assemble.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <string_view>
#include <unordered_map>
#include <utility>

#include "builder/base/error.h"

namespace copse {
namespace {

constexpr uint32_t none = ~0u;

template <class Keep>
std::size_t keepTriangles(Scene& scene, Keep keep) {
  std::size_t kept = 0;
  const std::size_t count = scene.triangles.size();
  for (std::size_t i = 0; i < count; ++i) {
    if (!keep(i)) continue;
    scene.triangles[kept] = scene.triangles[i];
    scene.materialOf[kept] = scene.materialOf[i];
    if (!scene.uvTriangles.empty()) scene.uvTriangles[kept] = scene.uvTriangles[i];
    ++kept;
  }
  scene.triangles.resize(kept);
  scene.materialOf.resize(kept);
  if (!scene.uvTriangles.empty()) scene.uvTriangles.resize(kept);
  return count - kept;
}

/// New indices for the items that are marked; `items` shrinks to them.
template <class T>
std::vector<uint32_t> compact(std::vector<T>& items, const std::vector<char>& used) {
  std::vector<uint32_t> index(items.size(), none);
  uint32_t kept = 0;
  for (std::size_t i = 0; i < items.size(); ++i) {
    if (!used[i]) continue;
    if (kept != i) items[kept] = std::move(items[i]);
    index[i] = kept++;
  }
  items.erase(items.begin() + kept, items.end());
  return index;
}

template <class T>
void moveTo(std::vector<T>& to, std::vector<T>& from) {
  if (to.empty())
    to = std::move(from);
  else
    std::move(from.begin(), from.end(), std::back_inserter(to));
  from = {};
}

}  // namespace

void transform(Scene& scene, const Affine& affine) {
  for (glm::dvec3& p : scene.exactPositions) p = affine.point(p);
  for (QuadLight& quad : scene.quads) {
    const glm::dvec3 corner = affine.point(glm::dvec3(quad.corner) + quad.cornerRest);
    quad.corner = vec3(corner);
    quad.cornerRest = restOf(corner, quad.corner);
    quad.edgeU = affine.vector(quad.edgeU);
    quad.edgeV = affine.vector(quad.edgeV);
    if (affine.determinant() < 0) std::swap(quad.edgeU, quad.edgeV);
  }
  for (Camera& camera : scene.cameras) {
    camera.setEye(affine.point(camera.exactEye()));
    camera.setAt(affine.point(camera.exactAt()));
    camera.up = affine.vector(camera.up);
  }
}

void turnUp(Scene& scene, UpAxis up) {
  if (up == UpAxis::z)
    for (glm::dvec3& p : scene.exactPositions) p = {p.x, p.z, -p.y};
}

void leaveOutMaterials(Scene& scene, const std::vector<std::string>& names, const std::string& where) {
  std::vector<char> out(scene.materials.size(), 0);
  std::unordered_map<std::string_view, bool> isFound;
  for (const std::string& name : names) isFound.emplace(name, false);
  for (std::size_t i = 0; i < out.size(); ++i)
    if (const auto place = isFound.find(scene.materials[i].name); place != isFound.end()) out[i] = place->second = true;
  for (const std::string& name : names)
    if (!isFound[name]) throw InputError(fmt::format("{}: the mesh has no material '{}' to leave out", where, name));
  if (!names.empty()) keepTriangles(scene, [&](std::size_t i) { return !out[scene.materialOf[i]]; });
}

void dropOutOfReach(Scene& scene, const std::string& file) {
  enum : uint8_t { good, far, notFinite };
  std::vector<uint8_t> state(scene.exactPositions.size());
  for (std::size_t i = 0; i < state.size(); ++i) {
    const glm::dvec3 p = scene.exactPositions[i];
    state[i] = !isFinite(p) ? notFinite : glm::length(p) <= farthest ? good : far;
  }
  if (std::ranges::count(state, good) == std::ssize(state)) return;
  std::size_t dropped[3] = {};
  keepTriangles(scene, [&](std::size_t i) {
    const uvec3 t = scene.triangles[i];
    const uint8_t worst = std::max({state[t.x], state[t.y], state[t.z]});
    ++dropped[worst];
    return worst == good;
  });
  for (const uint8_t why : {notFinite, far})
    if (const std::size_t count = dropped[why])
      scene.notes.push_back(fmt::format(
          "{}: dropped {} triangle{} with a vertex that is {}", file, count, count == 1 ? "" : "s",
          why == far ? fmt::format("farther than {:g} from the origin", farthest) : std::string("not finite")));
}

void append(Scene& scene, Scene&& part) {
  if (scene.triangles.size() + part.triangles.size() > maxTriangles)
    throw InputError(fmt::format("{}: more than {} triangles", scene.file, maxTriangles));
  if (scene.exactPositions.size() + part.exactPositions.size() > 0xfffffffeu)
    throw InputError(fmt::format("{}: more vertices than 32 bits count", scene.file));
  // A part without texture coordinates beside one that has them gets the point (0, 0).
  const bool hasUv = !scene.uvTriangles.empty() || !part.uvTriangles.empty();
  for (Scene* one : {&scene, &part}) {
    if (!hasUv || one->uvTriangles.size() == one->triangles.size()) continue;
    const uint32_t origin = static_cast<uint32_t>(one->uvs.size());
    one->uvs.push_back({0, 0});
    one->uvTriangles.assign(one->triangles.size(), uvec3(origin));
  }

  const uint32_t positions = static_cast<uint32_t>(scene.exactPositions.size());
  const uint32_t uvs = static_cast<uint32_t>(scene.uvs.size());
  const uint32_t materials = static_cast<uint32_t>(scene.materials.size());
  const int textures = static_cast<int>(scene.textures.size());
  for (uvec3& t : part.triangles) t += positions;
  for (uvec3& t : part.uvTriangles) t += uvs;
  for (uint32_t& m : part.materialOf) m += materials;
  for (Material& m : part.materials) m.texture += m.texture >= 0 ? textures : 0;
  moveTo(scene.exactPositions, part.exactPositions);
  moveTo(scene.triangles, part.triangles);
  moveTo(scene.materialOf, part.materialOf);
  moveTo(scene.uvs, part.uvs);
  moveTo(scene.uvTriangles, part.uvTriangles);
  moveTo(scene.materials, part.materials);
  moveTo(scene.textures, part.textures);
  moveTo(scene.notes, part.notes);
  moveTo(scene.remarks, part.remarks);
}

void dropUnused(Scene& scene) {
  std::vector<char> used(scene.exactPositions.size(), 0);
  for (const uvec3& t : scene.triangles) used[t.x] = used[t.y] = used[t.z] = 1;
  if (std::find(used.begin(), used.end(), 0) != used.end()) {
    const std::vector<uint32_t> index = compact(scene.exactPositions, used);
    for (uvec3& t : scene.triangles) t = {index[t.x], index[t.y], index[t.z]};
  }
  std::vector<char> usedMaterials(scene.materials.size(), 0), usedTextures(scene.textures.size(), 0);
  for (const uint32_t m : scene.materialOf) usedMaterials[m] = 1;
  const std::vector<uint32_t> index = compact(scene.materials, usedMaterials);
  for (uint32_t& m : scene.materialOf) m = index[m];
  for (const Material& m : scene.materials)
    if (m.texture >= 0) usedTextures[m.texture] = 1;
  const std::vector<uint32_t> textureIndex = compact(scene.textures, usedTextures);
  for (Material& m : scene.materials)
    if (m.texture >= 0) m.texture = static_cast<int>(textureIndex[m.texture]);
}

}  // namespace copse
