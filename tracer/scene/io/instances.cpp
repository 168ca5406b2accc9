// Instances by text, flattened: the traversal knows one level of triangles only. A line is
//   object material m00 m01 m02 m03 m10 … m23
// with ALL for every object and - to keep the materials. Linear in the file and in the triangles that come out.
#include <fmt/format.h>

#include <cmath>
#include <functional>
#include <unordered_map>

#include "builder/base/error.h"
#include "builder/base/files.h"
#include "builder/base/text.h"
#include "tracer/scene/io/assemble.h"

namespace copse {
namespace {

constexpr uint32_t none = ~0u;

struct Instance {
  uint32_t object, material;
  Affine affine;
};

/// The triangles of an object, and its own vertices: `corners` index into those.
struct Part {
  std::vector<uint32_t> triangles, vertices;
  std::vector<uvec3> corners;
};

/// Names have no blanks in this format, so a blank in an OBJ's name stands as '_'.
std::unordered_map<std::string, uint32_t> index(std::size_t count,
                                                const std::function<std::string(std::size_t)>& name) {
  std::unordered_map<std::string, uint32_t> of;
  for (std::size_t i = 0; i < count; ++i) of.try_emplace(name(i), static_cast<uint32_t>(i));
  for (std::size_t i = 0; i < count; ++i) {
    std::string plain = name(i);
    for (char& c : plain) c = c == ' ' || c == '\t' ? '_' : c;
    of.try_emplace(plain, static_cast<uint32_t>(i));
  }
  return of;
}

std::vector<Instance> readInstances(const Mesh& mesh, const std::string& file, uint64_t lines) {
  const std::string text = readFile(file);
  const uint32_t all = static_cast<uint32_t>(mesh.objects.size());
  auto objects = index(mesh.objects.size(), [&](std::size_t i) { return mesh.objects[i]; });
  auto materials = index(mesh.scene.materials.size(), [&](std::size_t i) { return mesh.scene.materials[i].name; });
  objects["ALL"] = all;
  materials["-"] = none;

  std::vector<Instance> instances;
  std::string_view rest = withoutMark(text);
  for (int number = 1; !rest.empty() && (lines == 0 || instances.size() < lines); ++number) {
    const std::size_t end = std::min(rest.find('\n'), rest.size());
    std::string_view line = rest.substr(0, end);
    rest.remove_prefix(std::min(end + 1, rest.size()));
    const auto fail = [&](const std::string& what) { throw InputError(fmt::format("{}:{}: {}", file, number, what)); };

    const std::string object(nextWord(line)), material(nextWord(line));
    if (object.empty() || object[0] == '#') continue;
    const auto objectPlace = objects.find(object), materialPlace = materials.find(material);
    if (objectPlace == objects.end()) fail(fmt::format("the mesh has no object '{}'", object));
    if (material.empty()) fail("expected object, material, 12 numbers");
    if (materialPlace == materials.end())
      fail(fmt::format("the mesh and its libraries have no material '{}'", material));
    Instance instance{objectPlace->second, materialPlace->second, {}};
    for (int i = 0; i < 12; ++i) {
      const std::string_view word = nextWord(line);
      double value = 0;
      if (word.empty()) fail(fmt::format("expected a row-major 3x4 matrix of 12 numbers, got {}", i));
      if (!parseNumber(word, value)) fail(fmt::format("'{}' is not a number", word));
      if (!(std::abs(value) <= 1e30)) fail(fmt::format("'{}' is not finite", word));
      instance.affine.m[i] = value;
    }
    if (const std::string_view more = nextWord(line); !more.empty() && more[0] != '#')
      fail(fmt::format("unexpected '{}' after the 12 numbers of the matrix", more));
    instances.push_back(instance);
  }
  if (lines > instances.size())
    throw InputError(fmt::format("{}: expected at least {} instances, got {}", file, lines, instances.size()));
  return instances;
}

/// One part per object, and last the one of all.
std::vector<Part> makeParts(const Mesh& mesh, const std::vector<Instance>& instances) {
  const std::size_t all = mesh.objects.size();
  std::vector<char> used(all + 1, 0);
  for (const Instance& instance : instances) used[instance.object] = 1;
  std::vector<Part> parts(all + 1);
  for (uint32_t i = 0; i < mesh.scene.triangles.size(); ++i) {
    if (used[all]) parts[all].triangles.push_back(i);
    if (!mesh.objectOf.empty() && used[mesh.objectOf[i]]) parts[mesh.objectOf[i]].triangles.push_back(i);
  }
  std::vector<uint32_t> local(mesh.scene.exactPositions.size(), none);
  for (Part& part : parts) {
    part.corners.reserve(part.triangles.size());
    for (const uint32_t i : part.triangles) {
      uvec3 corners;
      for (int k = 0; k < 3; ++k) {
        const uint32_t vertex = mesh.scene.triangles[i][k];
        if (local[vertex] == none) {
          local[vertex] = static_cast<uint32_t>(part.vertices.size());
          part.vertices.push_back(vertex);
        }
        corners[k] = local[vertex];
      }
      part.corners.push_back(corners);
    }
    for (const uint32_t vertex : part.vertices) local[vertex] = none;
  }
  return parts;
}

}  // namespace

void placeInstances(Mesh& mesh, const std::string& file, uint64_t lines) {
  const std::vector<Instance> instances = readInstances(mesh, file, lines);
  const std::vector<Part> parts = makeParts(mesh, instances);
  uint64_t triangles = 0, vertices = 0;
  for (const Instance& instance : instances) {
    triangles += parts[instance.object].triangles.size();
    vertices += parts[instance.object].vertices.size();
  }
  if (triangles > maxTriangles || vertices > 0xfffffffeu)
    throw InputError(fmt::format("{}: {} triangles with {} vertices exceed the maximum of {} triangles", file,
                                 triangles, vertices, maxTriangles));

  const Scene& from = mesh.scene;
  Scene to;
  const bool hasUv = !from.uvTriangles.empty();
  to.exactPositions.reserve(vertices);
  to.triangles.reserve(triangles);
  to.materialOf.reserve(triangles);
  if (hasUv) to.uvTriangles.reserve(triangles);
  for (const Instance& instance : instances) {
    const Part& part = parts[instance.object];
    const uint32_t first = static_cast<uint32_t>(to.exactPositions.size());
    for (const uint32_t vertex : part.vertices)
      to.exactPositions.push_back(instance.affine.point(from.exactPositions[vertex]));
    for (const uvec3& corners : part.corners) to.triangles.push_back(corners + first);
    for (const uint32_t i : part.triangles)
      to.materialOf.push_back(instance.material == none ? from.materialOf[i] : instance.material);
    if (hasUv)
      for (const uint32_t i : part.triangles) to.uvTriangles.push_back(from.uvTriangles[i]);
  }
  mesh.scene.exactPositions = std::move(to.exactPositions);
  mesh.scene.triangles = std::move(to.triangles);
  mesh.scene.materialOf = std::move(to.materialOf);
  mesh.scene.uvTriangles = std::move(to.uvTriangles);
  mesh.objects.clear();
  mesh.objectOf.clear();
}

}  // namespace copse
