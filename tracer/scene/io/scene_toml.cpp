// Scene descriptions by toml++: meshes, lights, views. Unknown keys, wrong types and values that make no scene are
// errors with their line.
#include "tracer/scene/io/scene_toml.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>

#include "builder/base/error.h"
#include "builder/base/files.h"
#include "builder/base/text.h"
#include "builder/base/toml_keys.h"
#include "tracer/generators/generators.h"
#include "tracer/scene/io/assemble.h"
#include "tracer/scene/io/find_scene_file.h"
#include "tracer/scene/io/origin.h"

namespace copse {
namespace {

glm::dvec3 toVec3(const TomlKeys::Triple& values) { return {values[0], values[1], values[2]}; }

/// The mesh of a `file`, or what a `generator` makes.
Mesh readSource(const std::string& file, const TomlKeys& keys) {
  if (keys.has("file") == keys.has("generator")) keys.fail("generator", "[[mesh]] needs either a file or a generator");
  const auto refuse = [&](std::initializer_list<std::string_view> others, std::string_view one) {
    for (const std::string_view key : others)
      if (keys.has(key)) keys.fail(key, fmt::format("'{}' cannot be used with '{}'", key, one));
  };
  if (keys.has("file")) {
    refuse({"triangles", "seed"}, "file");
    const std::string mesh = findSceneFile(keys.text("file"), file, keys.where("file"));
    if (keys.has("material") && !keys.has("materials")) keys.fail("material", "'material' needs 'materials'");
    GivenMaterials given;
    if (keys.has("materials")) given.library = findSceneFile(keys.text("materials"), file, keys.where("materials"));
    given.material = keys.text("material", "");
    given.where = keys.where(keys.has("material") ? "material" : "materials");
    given.areForInstances = keys.has("instances");
    return loadMesh(mesh, given);
  }
  refuse({"materials", "material", "instances"}, "generator");
  const int64_t seed = keys.integer("seed", 0, std::numeric_limits<int64_t>::max(), 1);
  const int64_t triangles = keys.integer("triangles", 1, static_cast<int64_t>(maxTriangles), 0);
  Mesh mesh;
  try {
    const GeneratorEntry& entry = findGenerator(keys.text("generator"));
    const uint32_t count = triangles ? static_cast<uint32_t>(triangles) : entry.defaultTriangles;
    mesh.scene = entry.generate(count, static_cast<uint64_t>(seed));
  } catch (const InputError& error) {
    keys.fail("generator", error.what());
  }
  mesh.scene.exactPositions.assign(mesh.scene.positions.begin(), mesh.scene.positions.end());
  mesh.scene.positions = {};
  return mesh;
}

/// The axis that points up in the mesh's file; generators have y.
UpAxis upOf(const TomlKeys& keys, const LoadOptions& options) {
  if (!keys.has("up")) return keys.has("generator") ? UpAxis::y : options.up;
  if (keys.has("generator")) keys.fail("up", "'up' cannot be used with 'generator'");
  try {
    return upAxis(keys.text("up"));
  } catch (const InputError& error) {
    keys.fail("up", fmt::format("'up': {}", error.what()));
  }
}

void readMesh(Scene& scene, const toml::table& table, const LoadOptions& options) {
  const TomlKeys keys(scene.file, table, "[[mesh]]",
                      {"file", "generator", "triangles", "seed", "materials", "material", "instances", "instance_lines",
                       "up", "scale", "transform", "leave_out_materials"});
  // What is cheap to check comes before what takes long to read.
  const double scale = keys.number("scale", 1);
  if (!(std::abs(scale) > 0)) keys.fail("scale", "'scale': expected a number other than 0");
  Affine affine;
  if (keys.has("transform")) std::ranges::copy(keys.numbers("transform", 12), affine.m);
  for (int i = 0; i < 12; ++i)
    if (i % 4 != 3) affine.m[i] *= scale;
  const std::vector<std::string> leftOut = keys.texts("leave_out_materials");
  if (keys.has("instance_lines") && !keys.has("instances"))
    keys.fail("instance_lines", "'instance_lines' needs 'instances'");
  const int64_t lines = keys.integer("instance_lines", 1, std::numeric_limits<int64_t>::max(), 0);

  const UpAxis up = upOf(keys, options);

  Mesh mesh = readSource(scene.file, keys);
  if (keys.has("instances"))
    placeInstances(mesh, findSceneFile(keys.text("instances"), scene.file, keys.where("instances")),
                   static_cast<uint64_t>(lines));
  leaveOutMaterials(mesh.scene, leftOut, keys.where("leave_out_materials"));
  turnUp(mesh.scene, up);
  if (keys.has("scale") || keys.has("transform")) transform(mesh.scene, affine);
  dropOutOfReach(mesh.scene, keys.has("file") ? keys.text("file") : keys.text("generator"));

  scene.quads.insert(scene.quads.end(), mesh.scene.quads.begin(), mesh.scene.quads.end());
  scene.cameras.insert(scene.cameras.end(), mesh.scene.cameras.begin(), mesh.scene.cameras.end());
  if (!scene.sky) scene.sky = mesh.scene.sky;
  scene.generated = scene.generated || keys.has("generator");
  append(scene, std::move(mesh.scene));
}

/// What is given in the bounds' space: quads and views by index.
struct InBounds {
  std::vector<std::size_t> quads, cameras;
};

/// 0 becomes the lowest corner of what the meshes are, 1 a step of their largest extent from it. `own` are the quads
/// and views as they are given.
void placeInBounds(Scene& scene, const Scene& own, const InBounds& which) {
  if (which.quads.empty() && which.cameras.empty()) return;
  const Box box = scene.bounds();
  const vec3 size = box.hi - box.lo;
  if (!(size.x >= 0)) return;  // Nothing is there: nothing is lit or seen either.
  const float extent = std::max({size.x, size.y, size.z});
  for (const std::size_t i : which.quads) {
    const QuadLight& quad = own.quads[i];
    scene.quads[i] = {box.lo + extent * quad.corner, extent * quad.edgeU, extent * quad.edgeV, quad.radiance};
  }
  for (const std::size_t i : which.cameras) {
    scene.cameras[i].setEye(box.lo + extent * own.cameras[i].eye);
    scene.cameras[i].setAt(box.lo + extent * own.cameras[i].at);
  }
}

bool isInBounds(const TomlKeys& keys) {
  const std::string space = keys.text("space", "world");
  if (space != "world" && space != "bounds")
    keys.fail("space", fmt::format("unknown space '{}' (expected world or bounds)", space));
  return space == "bounds";
}

void readLight(Scene& scene, InBounds& inBounds, const toml::table& table) {
  const std::string kind = TomlKeys(scene.file, table, "[[light]]",
                                    {"kind", "corner", "edge_u", "edge_v", "radiance", "image", "rotation", "space"})
                               .text("kind");
  if (kind == "quad") {
    const TomlKeys keys(scene.file, table, "a quad light", {"kind", "corner", "edge_u", "edge_v", "radiance", "space"});
    const glm::dvec3 corner = toVec3(keys.triple("corner"));
    QuadLight quad{corner, toVec3(keys.triple("edge_u")), toVec3(keys.triple("edge_v")),
                   toVec3(keys.tripleNotNegative("radiance"))};
    quad.cornerRest = restOf(corner, quad.corner);
    if (!(glm::length(glm::cross(quad.edgeU, quad.edgeV)) > 0)) keys.fail("edge_u", "the quad has no area");
    if (isInBounds(keys)) inBounds.quads.push_back(scene.quads.size());
    scene.quads.push_back(quad);
    return;
  }
  const TomlKeys keys(scene.file, table, "a sky light", {"kind", "radiance", "image", "rotation"});
  if (kind != "sky") keys.fail("kind", fmt::format("unknown light kind '{}' (expected quad or sky)", kind));
  if (scene.sky) keys.fail("kind", "a scene can have only one sky");
  if (keys.has("radiance") == keys.has("image")) keys.fail({}, "a sky needs either radiance or an image");
  if (keys.has("rotation") && !keys.has("image")) keys.fail("rotation", "'rotation' needs an image to turn");
  scene.sky.emplace();
  scene.sky->rotation = keys.number("rotation", 0);
  if (keys.has("image"))
    scene.sky->file = findSceneFile(keys.text("image"), scene.file, keys.where("image"));
  else
    scene.sky->radiance = toVec3(keys.tripleNotNegative("radiance"));
}

void readView(Scene& scene, InBounds& inBounds, const toml::table& table) {
  const TomlKeys keys(scene.file, table, "[[view]]", {"name", "eye", "at", "up", "vfov", "space"});
  Camera camera{keys.text("name", fmt::format("view{}", scene.cameras.size() + 1)), vec3(0), vec3(0),
                toVec3(keys.triple("up", TomlKeys::Triple{0, 1, 0})), static_cast<float>(keys.number("vfov", 45))};
  camera.setEye(toVec3(keys.triple("eye")));
  camera.setAt(toVec3(keys.triple("at")));
  if (camera.name == "all") keys.fail("name", "a view cannot be called 'all': that means every view");
  for (const Camera& other : scene.cameras)
    if (other.name == camera.name) keys.fail("name", fmt::format("duplicate view '{}'", camera.name));
  if (camera.exactEye() == camera.exactAt()) keys.fail("eye", "'eye' and 'at' are the same point");
  if (!(camera.vfov > 0 && camera.vfov < 180))
    keys.fail("vfov", fmt::format("'vfov': expected an angle between 0 and 180 degrees, got {}", camera.vfov));
  const vec3 forward = glm::normalize(camera.exactAt() - camera.exactEye());
  if (!(glm::length(glm::cross(forward, camera.up)) > 1e-6f * glm::length(camera.up))) {
    camera.up = std::abs(forward.y) < 0.9f ? vec3(0, 1, 0) : vec3(0, 0, 1);
    scene.notes.push_back(fmt::format("{}: view '{}' looks along its up vector; using another up vector",
                                      keys.where("eye"), camera.name));
  }
  if (isInBounds(keys)) inBounds.cameras.push_back(scene.cameras.size());
  scene.cameras.push_back(camera);
}

}  // namespace

Scene readSceneToml(const std::string& file, const LoadOptions& options) {
  const toml::table root = parseToml(readFile(file), file);
  const TomlKeys keys(file, root, "a scene", {"name", "mesh", "light", "view"});
  Scene scene;
  scene.file = file;
  scene.name = keys.text("name", std::filesystem::path(file).stem().string());

  // Lights and views first: they are checked at once, while meshes may take long. They replace a generator's.
  Scene own;
  InBounds inBounds;
  own.file = file;
  const std::vector<const toml::table*> lights = keys.tables("light"), views = keys.tables("view"),
                                        meshes = keys.tables("mesh");
  if (meshes.empty()) throw InputError(fmt::format("{}: a scene needs at least one [[mesh]]", file));
  for (const toml::table* light : lights) readLight(own, inBounds, *light);
  for (const toml::table* camera : views) readView(own, inBounds, *camera);
  for (const toml::table* mesh : meshes) readMesh(scene, *mesh, options);
  if (!lights.empty()) scene.quads = own.quads, scene.sky = own.sky;
  if (!views.empty()) scene.cameras = own.cameras;
  dropUnused(scene);
  moveToOrigin(scene);
  placeInBounds(scene, own, inBounds);
  scene.notes.insert(scene.notes.end(), own.notes.begin(), own.notes.end());
  return scene;
}

}  // namespace copse
