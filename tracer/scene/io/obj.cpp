// Wavefront OBJ by tinyobjloader's callbacks, which keep file order and little memory. Around it: a check of every
// line, resolved indices, our own triangulation, and materials by name.
#include <fmt/format.h>
#include <tiny_obj_loader.h>

#include <algorithm>
#include <cmath>
#include <istream>
#include <limits>
#include <unordered_map>

#include "builder/base/error.h"
#include "builder/base/files.h"
#include "builder/base/text.h"
#include "tracer/scene/io/checked_lines.h"
#include "tracer/scene/io/libraries.h"
#include "tracer/scene/io/mesh.h"
#include "tracer/scene/io/origin.h"
#include "tracer/scene/io/polygon.h"

namespace copse {
namespace {

constexpr uint32_t none = ~0u;

/// Indices of one kind (v or vt), counted from 0. An index may come before what it names, so the check waits for the
/// file's end; of all such lines only those with a new largest index can be the first that is wrong.
struct IndexCheck {
  struct Record {
    int line;
    int64_t index;
  };
  std::vector<Record> records;

  void forward(int line, int64_t index) {
    if (records.empty() || index > records.back().index) records.push_back({line, index});
  }
  bool isGood(std::size_t count) const {
    return records.empty() || records.back().index <= static_cast<int64_t>(count);
  }
  void finish(const std::string& file, const char* what, std::size_t count) const {
    for (const Record& r : records)
      if (r.index > static_cast<int64_t>(count))
        throw InputError(
            fmt::format("{}:{}: {} index {} is out of range: the file has {}", file, r.line, what, r.index, count));
  }
};

class ObjReader {
 public:
  ObjReader(const std::string& file, const std::string& text)
      : file_(file), lines_(file, text, [this](std::string& line) { check(line); }) {}

  Mesh read(const GivenMaterials& given);

 private:
  struct Corner {
    uint32_t position, uv;
  };
  struct Face {
    uint32_t corners, material, object;
  };

  void check(std::string& line);
  void checkCorner(std::string_view word);
  uint32_t resolvePosition(int index);
  uint32_t resolveUv(int index);
  void checkIndices();
  void face(const tinyobj::index_t* indices, int count);
  uint32_t named(std::string_view name, std::vector<std::string>& names, std::unordered_map<std::string, uint32_t>& of);
  void object(std::string_view name) { object_ = named(name, mesh_.objects, objectIndex_); }
  void takeMaterials(const GivenMaterials& given);
  void makeTriangles();

  std::string file_;
  CheckedLines lines_;
  Mesh mesh_;
  std::vector<Corner> corners_;
  std::vector<Face> faces_;
  IndexCheck positionCheck_, uvCheck_;
  IndexCheck::Record farBack_{0, 0};                ///< The first texture coordinate before the first.
  std::vector<std::string> materials_, libraries_;  ///< As usemtl and mtllib name them.
  std::unordered_map<std::string, uint32_t> materialIndex_, objectIndex_;
  uint32_t material_ = none, object_ = none;
  glm::dvec3 vertex_{0};  ///< Of the current v line, as its check reads it: tinyobjloader has floats.
  bool finite_ = true;    ///< Whether the current vt line is.
  bool far_ = false;      ///< A number of that line is beyond what a float holds.
  bool namesMaterials_ = false;
  bool hasO_ = false;  ///< From the first `o` on, `g` names no objects.
  std::size_t badUvs_ = 0, zeroUvs_ = 0, lostUvs_ = 0, badNormals_ = 0, coloured_ = 0, shortFaces_ = 0;
  std::size_t normals_ = 0;
  int64_t maxNormal_ = 0;  ///< The largest index of one, from 1 or from the end.
};

/// Normals are not read, so any index of one will do, and 0 stands for no texture coordinate, as some programs write.
void ObjReader::checkCorner(std::string_view word) {
  const std::string_view whole = word;
  for (int part = 0;; ++part) {
    const std::size_t slash = std::min(word.find('/'), word.size());
    const std::string_view digits = word.substr(0, slash);
    int64_t index = 1;
    if (part == 2 && slash == word.size()) {
      if (digits.empty()) return;
      if (!parseInteger(digits, index) || index == 0) ++badNormals_;
      maxNormal_ = std::max(maxNormal_, index < 0 ? -std::max(index, -std::numeric_limits<int64_t>::max()) : index);
      return;
    }
    if (part > 2 || !(parseInteger(digits, index) || (part > 0 && digits.empty())))
      lines_.fail(fmt::format("invalid corner '{}' (expected v, v/vt, v//vn or v/vt/vn)", whole));
    if (index == 0 && part == 1) ++zeroUvs_;
    if (index == 0 && part == 0)
      lines_.fail(fmt::format("index 0 in '{}': indices start at 1, or at -1 from the end", whole));
    if (index < -std::numeric_limits<int>::max() || index > std::numeric_limits<int>::max())
      lines_.fail(fmt::format("index {} is out of range", index));
    if (slash == word.size()) return;
    word.remove_prefix(slash + 1);
  }
}

/// A line of numbers as tinyobjloader reads them.
std::string inPlainNumbers(std::string_view line) {
  std::string plain(nextWord(line));
  double value;
  for (std::string_view word = nextWord(line); !word.empty(); word = nextWord(line))
    plain += parseNumber(word, value) ? fmt::format(" {}", value) : fmt::format(" {}", word);
  return plain;
}

/// tinyobjloader takes words that it cannot read for 0, nan among them; what passes here it reads rightly.
void ObjReader::check(std::string& line) {
  std::string_view rest = line;
  const std::string_view key = nextWord(rest);
  if (key.empty() || key.front() == '#') return line.clear();
  const bool isVertex = key == "v", isUv = key == "vt", isFace = key == "f";
  if (key.size() == 6 && lowered(key) == "mtllib") libraries_.emplace_back(trim(rest));
  if (key.size() == 6 && lowered(key) == "usemtl") material_ = named(rest, materials_, materialIndex_);
  if (!isVertex && !isUv && !isFace) {
    normals_ += key == "vn";
    const bool names = key == "o" || key == "g";
    if (!names) line.clear();  // Normals, lines, points, curves, smoothing: nothing that is traced.
    return;
  }

  finite_ = true;
  far_ = false;
  int words = 0;
  bool unusual = false;  // A number that tinyobjloader would not read rightly.
  for (std::string_view word = nextWord(rest); !word.empty() && word.front() != '#'; word = nextWord(rest), ++words) {
    if (isFace) {
      checkCorner(word);
      continue;
    }
    if (words >= (isUv ? 2 : 3)) continue;  // Weights and colours.
    double value = 0;
    if (!parsePlainNumber(word, value)) {
      if (!parseNumber(word, value)) lines_.fail(fmt::format("'{}' is not a number", word));
      unusual = true;
    }
    if (isVertex) vertex_[words] = value;
    finite_ &= std::isfinite(value);
    far_ |= std::abs(value) > std::numeric_limits<float>::max();
  }
  coloured_ += isVertex && words >= 6;
  if (isVertex && words < 3) lines_.fail(fmt::format("vertex: expected three numbers, got {}", words));
  if (isUv && words < 1) lines_.fail("texture coordinates without a number");
  if (isFace && words < 3) {
    if (lines_.isOpen()) lines_.fail(fmt::format("face: expected at least three corners, got {}", words));
    ++shortFaces_;
    return line.clear();
  }
  const std::string_view kept = withoutComment(line);
  line.resize(static_cast<std::size_t>(kept.data() + kept.size() - line.data()));
  if (unusual) line = inPlainNumbers(line);
  // In "1/ 2/ 3/" tinyobjloader would take 2 for the texture coordinate of 1.
  for (std::size_t i = line.size(); isFace && i-- > 0;)
    if (line[i] == '/' && (i + 1 == line.size() || line[i + 1] == ' ' || line[i + 1] == '\t')) line[i] = ' ';
}

uint32_t ObjReader::resolvePosition(int index) {
  const std::size_t count = mesh_.scene.exactPositions.size();
  if (index > 0) {
    if (static_cast<std::size_t>(index) > count) positionCheck_.forward(lines_.lineNumber(), index);
    return static_cast<uint32_t>(index - 1);
  }
  const int64_t at = static_cast<int64_t>(count) + index;
  if (at < 0) lines_.fail(fmt::format("vertex index {} reaches back before the first of {}", index, count));
  return static_cast<uint32_t>(at);
}

/// Whether texture coordinates are read at all is known at the file's end.
uint32_t ObjReader::resolveUv(int index) {
  const std::size_t count = mesh_.scene.uvs.size();
  if (index == 0) return none;
  if (index < 0) {
    const int64_t at = static_cast<int64_t>(count) + index;
    if (at >= 0) return static_cast<uint32_t>(at);
    ++lostUvs_;
    if (farBack_.line == 0) farBack_ = {lines_.lineNumber(), index};
    return none;
  }
  if (static_cast<std::size_t>(index) > count) uvCheck_.forward(lines_.lineNumber(), index);
  return static_cast<uint32_t>(index - 1);
}

/// Errors where an index that is wrong would be followed, notes where nothing is read by it.
void ObjReader::checkIndices() {
  Scene& scene = mesh_.scene;
  const auto note = [&](std::size_t count, const std::string& what) {
    if (count) scene.notes.push_back(fmt::format("{}: ignored {} {}", file_, count, what));
  };
  if (!uvCheck_.isGood(scene.uvs.size()) || lostUvs_) {
    const bool areRead = !scene.textures.empty() && !scene.uvs.empty();
    if (areRead) {
      if (farBack_.line)
        throw InputError(fmt::format("{}:{}: texture coordinate index {} reaches back before the first", file_,
                                     farBack_.line, farBack_.index));
      uvCheck_.finish(file_, "texture coordinate", scene.uvs.size());
    }
    for (Corner& corner : corners_) {
      if (corner.uv == none || corner.uv < scene.uvs.size()) continue;
      corner.uv = none;
      ++lostUvs_;
    }
    note(lostUvs_, fmt::format("texture coordinate indices out of range: the file has {}", scene.uvs.size()));
  }
  note(zeroUvs_, "texture coordinate indices of 0");
  note(badNormals_, "normal indices that are 0 or no number");
  if (maxNormal_ > static_cast<int64_t>(normals_))
    scene.notes.push_back(
        fmt::format("{}: ignored normal indices out of range, up to {}: the file has {}", file_, maxNormal_, normals_));
}

void ObjReader::face(const tinyobj::index_t* indices, int count) {
  for (int i = 0; i < count; ++i) {
    corners_.push_back({resolvePosition(indices[i].vertex_index), resolveUv(indices[i].texcoord_index)});
  }
  faces_.push_back({static_cast<uint32_t>(count), material_, object_});
}

uint32_t ObjReader::named(std::string_view name, std::vector<std::string>& names,
                          std::unordered_map<std::string, uint32_t>& of) {
  const auto [place, isNew] = of.try_emplace(std::string(trim(name)), static_cast<uint32_t>(names.size()));
  if (isNew) names.push_back(place->first);
  return place->second;
}

/// Makes the scene's materials, and the faces' indices point to them.
void ObjReader::takeMaterials(const GivenMaterials& given) {
  Scene& scene = mesh_.scene;
  namesMaterials_ = std::ranges::any_of(materials_, [](const std::string& name) { return !name.empty(); });
  readLibraries(file_, libraries_, namesMaterials_ && given.library.empty(), scene);
  if (namesMaterials_ && !given.library.empty()) readLibrary(given.library, scene);
  if (namesMaterials_ && !given.material.empty())
    scene.remarks.push_back(
        {"material not given", fmt::format("{}: ignored 'material': the mesh names its own", given.where)});
  const bool hasLibrary = !scene.materials.empty();
  if (namesMaterials_ && !hasLibrary && libraries_.empty())
    scene.remarks.push_back({"no library", fmt::format("{}: names materials but no library; using grey", file_)});
  if (!namesMaterials_ && hasLibrary && given.library.empty() && !faces_.empty())
    scene.remarks.push_back({"no usemtl", fmt::format("{}: names a library but no material; using grey", file_)});

  const std::vector<uint32_t> index = findMaterials(file_, materials_, scene);
  uint32_t grey = none;
  for (Face& face : faces_) {
    if (face.material != none) face.material = index[face.material];
    if (face.material == none && grey == none) {
      grey = static_cast<uint32_t>(scene.materials.size());
      scene.materials.push_back(greyMaterial("default"));
    }
    if (face.material == none) face.material = grey;
  }
}

void ObjReader::makeTriangles() {
  Scene& scene = mesh_.scene;
  std::size_t count = 0;
  bool hasUv = false;
  for (const Face& face : faces_) count += face.corners - 2;
  for (const Corner& corner : corners_) hasUv |= corner.uv != none;
  scene.triangles.reserve(count);
  scene.materialOf.reserve(count);
  if (hasUv) scene.uvTriangles.reserve(count);
  if (!mesh_.objects.empty()) mesh_.objectOf.reserve(count);
  if (!hasUv) scene.uvs.clear();
  uint32_t noUv = none;
  for (const Corner& corner : corners_) {
    if (!hasUv || corner.uv != none || noUv != none) continue;
    noUv = static_cast<uint32_t>(scene.uvs.size());
    scene.uvs.push_back({0, 0});
  }

  const glm::dvec3 origin = originOf(scene.exactPositions);
  std::vector<vec3> polygon;
  std::vector<uvec3> cut;
  std::size_t crossing = 0;
  const Corner* corner = corners_.data();
  for (const Face& face : faces_) {
    cut.clear();
    polygon.clear();
    if (face.corners > 3)
      for (uint32_t i = 0; i < face.corners; ++i)
        polygon.push_back(toCoordinates(scene.exactPositions[corner[i].position] - origin));
    if (face.corners > 3)
      crossing += !triangulate(polygon, cut);
    else
      cut.push_back({0, 1, 2});
    for (const uvec3& t : cut) {
      scene.triangles.push_back({corner[t.x].position, corner[t.y].position, corner[t.z].position});
      scene.materialOf.push_back(face.material);
      if (!mesh_.objects.empty()) mesh_.objectOf.push_back(face.object);
      const auto uv = [&](uint32_t i) { return corner[i].uv == none ? noUv : corner[i].uv; };
      if (hasUv) scene.uvTriangles.push_back({uv(t.x), uv(t.y), uv(t.z)});
    }
    corner += face.corners;
  }
  noteCrossingFaces(file_, crossing, scene.notes);
}

Mesh ObjReader::read(const GivenMaterials& given) {
  tinyobj::callback_t callbacks;
  callbacks.vertex_cb = [](void* self, float, float, float, float) {
    ObjReader& reader = *static_cast<ObjReader*>(self);
    reader.mesh_.scene.exactPositions.push_back(reader.vertex_);
  };
  callbacks.texcoord_cb = [](void* self, float u, float v, float) {
    ObjReader& reader = *static_cast<ObjReader*>(self);
    const bool good = reader.finite_ && !reader.far_;
    reader.badUvs_ += !good;
    reader.mesh_.scene.uvs.push_back(good ? vec2(u, v) : vec2(0));
  };
  callbacks.index_cb = [](void* self, tinyobj::index_t* indices, int count) {
    static_cast<ObjReader*>(self)->face(indices, count);
  };
  callbacks.group_cb = [](void* self, const char** names, int count) {
    std::string name;
    for (int i = 0; i < count; ++i) name.append(" ").append(names[i]);
    if (!static_cast<ObjReader*>(self)->hasO_) static_cast<ObjReader*>(self)->object(name);
  };
  callbacks.object_cb = [](void* self, const char* name) {
    static_cast<ObjReader*>(self)->hasO_ = true;
    static_cast<ObjReader*>(self)->object(name);
  };
  std::istream stream(&lines_);
  stream.exceptions(std::ios::badbit);  // So that the check's InputError comes through.
  tinyobj::LoadObjWithCallback(stream, callbacks, this);

  Scene& scene = mesh_.scene;
  if (scene.exactPositions.empty()) throw InputError(fmt::format("{}: no vertices (expected lines `v x y z`)", file_));
  positionCheck_.finish(file_, "vertex", scene.exactPositions.size());
  if (badUvs_)
    scene.notes.push_back(fmt::format("{}: replaced {} non-finite texture coordinates by 0", file_, badUvs_));
  if (shortFaces_)
    scene.notes.push_back(fmt::format("{}: ignored {} faces with fewer than three corners", file_, shortFaces_));
  if (coloured_)
    scene.remarks.push_back(
        {"vertex colours", fmt::format("{}: ignored the colours of {} vertices", file_, coloured_)});
  takeMaterials(given);
  checkIndices();
  // Faces before the first group belong to one without a name.
  if (!mesh_.objects.empty())
    for (Face& face : faces_)
      if (face.object == none) face.object = named("", mesh_.objects, objectIndex_);
  makeTriangles();
  if (!namesMaterials_ && !given.library.empty()) giveMaterial(scene, given);
  return std::move(mesh_);
}

}  // namespace

Mesh loadObj(const std::string& file, const GivenMaterials& given) {
  const std::string text = readFile(file);
  Mesh mesh = ObjReader(file, text).read(given);
  noteOpenEnd(file, text, mesh.scene.notes);
  return mesh;
}

}  // namespace copse
