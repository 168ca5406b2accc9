// Stanford PLY (Greg Turk, 1994): text and binary of both byte orders. Vertices with x y z and perhaps texture
// coordinates, faces as lists of vertex indices; every other element and property is skipped. One pass over the file.
#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include "builder/base/error.h"
#include "builder/base/files.h"
#include "builder/base/text.h"
#include "tracer/scene/io/mesh.h"
#include "tracer/scene/io/polygon.h"

namespace copse {
namespace {

enum class Type { i8, u8, i16, u16, i32, u32, f32, f64 };

struct Property {
  std::string name;
  Type type;
  bool isList = false;
  Type countType = Type::u8;
};

struct Element {
  std::string name;
  uint64_t count;
  std::vector<Property> properties;
  int line;  ///< In the header.
};

bool parseType(std::string_view word, Type& type) {
  static constexpr std::pair<std::string_view, Type> names[] = {
      {"char", Type::i8},   {"int8", Type::i8},     {"uchar", Type::u8},   {"uint8", Type::u8},
      {"short", Type::i16}, {"int16", Type::i16},   {"ushort", Type::u16}, {"uint16", Type::u16},
      {"int", Type::i32},   {"int32", Type::i32},   {"uint", Type::u32},   {"uint32", Type::u32},
      {"float", Type::f32}, {"float32", Type::f32}, {"double", Type::f64}, {"float64", Type::f64}};
  for (const auto& [name, value] : names)
    if (word == name) return type = value, true;
  return false;
}

std::size_t sizeOf(Type type) {
  static constexpr std::size_t sizes[] = {1, 1, 2, 2, 4, 4, 4, 8};
  return sizes[static_cast<int>(type)];
}

class PlyReader {
 public:
  PlyReader(const std::string& file, const std::string& text)
      : file_(file), text_(text), rest_(text), size_(text.size()) {}
  Mesh read();

 private:
  [[noreturn]] void fail(const std::string& what) const {
    if (!binary_) throw InputError(fmt::format("{}:{}: {}", file_, line_, what));
    throw InputError(fmt::format("{}: at byte {}: {}", file_, size_ - rest_.size(), what));
  }

  std::string_view takeLine();
  std::string_view takeWord();
  void readHeader();
  void checkFaces();
  void readProperty(std::string_view rest);
  void checkSize(const Element& element) const;
  double number(Type type);
  template <class T>
  T raw();
  void skip(const Property& property);
  uint32_t listSize(const Property& property);
  void readVertices(const Element& element);
  void readFaces(const Element& element);
  void addFace();

  std::string file_;
  std::string_view text_, rest_;
  std::size_t size_;
  int line_ = 0;
  bool binary_ = false, swap_ = false;
  std::vector<Element> elements_;
  Mesh mesh_;
  std::vector<int64_t> polygon_;
  std::vector<vec3> corners_;
  std::vector<uvec3> cut_;
  uint64_t vertexCount_ = 0;
  std::size_t shortFaces_ = 0;
};

std::string_view PlyReader::takeLine() {
  if (rest_.empty()) fail("the file ends within its header");
  const std::size_t end = std::min(rest_.find_first_of("\r\n"), rest_.size());
  const std::string_view line = rest_.substr(0, end);
  const bool crlf = rest_.substr(end, 2) == "\r\n";
  rest_.remove_prefix(std::min(end + 1 + crlf, rest_.size()));
  ++line_;
  return line;
}

void PlyReader::readProperty(std::string_view rest) {
  if (elements_.empty()) fail("a property before the first element");
  Property property;
  std::string_view word = nextWord(rest);
  property.isList = word == "list";
  if (property.isList) {
    word = nextWord(rest);
    if (!parseType(word, property.countType) || property.countType >= Type::f32)
      fail(fmt::format("'{}' is not a valid list length type", word));
    word = nextWord(rest);
  }
  if (!parseType(word, property.type)) fail(fmt::format("'{}' is not a type", word));
  property.name = nextWord(rest);
  if (property.name.empty()) fail("a property without a name");
  elements_.back().properties.push_back(property);
}

bool isIndices(const Property& property) {
  return property.isList && (property.name == "vertex_indices" || property.name == "vertex_index");
}

/// A surface that would be skipped like any unknown element is no empty mesh.
void PlyReader::checkFaces() {
  const Element *faces = nullptr, *strips = nullptr;
  for (const Element& element : elements_) {
    if (element.name == "face" && element.count > 0) faces = &element;
    if (element.name == "tristrips" && element.count > 0) strips = &element;
  }
  if (faces && std::ranges::none_of(faces->properties, isIndices)) {
    line_ = faces->line;
    fail("the faces lack the list 'vertex_indices'");
  }
  if (!strips) return;
  if (!faces) {
    line_ = strips->line;
    fail("triangle strips ('tristrips') are unsupported (expected faces)");
  }
  mesh_.scene.notes.push_back(fmt::format("{}:{}: ignored unsupported triangle strips", file_, strips->line));
}

void PlyReader::readHeader() {
  if (trim(takeLine()) != "ply") fail("does not begin with 'ply': this is not a PLY file");
  bool hasFormat = false, binary = false;
  for (;;) {
    std::string_view rest = takeLine();
    const std::string_view key = nextWord(rest);
    if (key == "end_header") break;
    if (key.empty() || key == "comment" || key == "obj_info") continue;
    if (key == "format") {
      const std::string_view format = nextWord(rest);
      binary = format == "binary_little_endian" || format == "binary_big_endian";
      if (!binary && format != "ascii") fail(fmt::format("unsupported PLY format '{}'", format));
      swap_ = binary && (format == "binary_big_endian") != (std::endian::native == std::endian::big);
      const std::string_view version = nextWord(rest);
      if (version != "1.0") fail(fmt::format("unsupported PLY version '{}' (expected 1.0)", version));
      hasFormat = true;
    } else if (key == "element") {
      const std::string name(nextWord(rest));
      int64_t count = 0;
      if (!parseInteger(nextWord(rest), count) || count < 0) fail("an element needs a name and a count");
      for (const Element& other : elements_)
        if (other.name == name) fail(fmt::format("duplicate element '{}'", name));
      elements_.push_back({name, static_cast<uint64_t>(count), {}, line_});
    } else if (key == "property") {
      readProperty(rest);
    } else {
      fail(fmt::format("unknown PLY header keyword '{}'", key.substr(0, 40)));
    }
  }
  if (!hasFormat) fail("the header names no format");
  checkFaces();
  binary_ = binary;
  ++line_;  // The line of what follows.
}

/// Before anything is allocated: what the header promises must fit into what is left of the file.
void PlyReader::checkSize(const Element& element) const {
  std::size_t minBytes = 0;
  for (const Property& p : element.properties) minBytes += binary_ ? sizeOf(p.isList ? p.countType : p.type) : 2;
  if (element.count > 0xfffffffeu || (element.count > 0 && element.count > (rest_.size() + 1) / minBytes))
    fail(fmt::format("truncated: the header declares {} of element '{}', which do not fit into the remaining {} bytes",
                     element.count, element.name, rest_.size()));
}

std::string_view PlyReader::takeWord() {
  std::size_t begin = 0;
  while (begin < rest_.size() && std::string_view(" \t\r\n").find(rest_[begin]) != std::string_view::npos)
    line_ += rest_[begin++] == '\n';
  rest_.remove_prefix(begin);
  const std::string_view word = nextWord(rest_);
  if (word.empty()) fail("the file ends too early");
  return word;
}

template <class T>
T PlyReader::raw() {
  if (rest_.size() < sizeof(T)) fail("the file ends too early");
  char bytes[sizeof(T)];
  std::memcpy(bytes, rest_.data(), sizeof(T));
  if (swap_) std::reverse(bytes, bytes + sizeof(T));
  rest_.remove_prefix(sizeof(T));
  return std::bit_cast<T>(bytes);
}

double PlyReader::number(Type type) {
  if (!binary_) {
    const std::string_view word = takeWord();
    double value;
    if (!parseNumber(word, value)) fail(fmt::format("'{}' is not a number", word.substr(0, 40)));
    return value;
  }
  switch (type) {
    case Type::i8:
      return raw<int8_t>();
    case Type::u8:
      return raw<uint8_t>();
    case Type::i16:
      return raw<int16_t>();
    case Type::u16:
      return raw<uint16_t>();
    case Type::i32:
      return raw<int32_t>();
    case Type::u32:
      return raw<uint32_t>();
    case Type::f32:
      return raw<float>();
    case Type::f64:
      return raw<double>();
  }
  return 0;
}

uint32_t PlyReader::listSize(const Property& property) {
  const double size = number(property.countType);
  const std::size_t minBytes = binary_ ? sizeOf(property.type) : 2;
  if (!(size >= 0) || size != std::floor(size)) fail(fmt::format("invalid list length {}", size));
  if (size > static_cast<double>((rest_.size() + 1) / minBytes))
    fail(fmt::format("truncated: a list of {} values", size));
  return static_cast<uint32_t>(size);
}

void PlyReader::skip(const Property& property) {
  for (uint32_t n = property.isList ? listSize(property) : 1; n > 0; --n) number(property.type);
}

void PlyReader::readVertices(const Element& element) {
  // x y z u v; where each is found among the properties.
  static constexpr std::string_view names[5][4] = {
      {"x"}, {"y"}, {"z"}, {"u", "s", "texture_u", "texture_s"}, {"v", "t", "texture_v", "texture_t"}};
  std::vector<int> target(element.properties.size(), -1);
  bool has[5] = {};
  for (std::size_t p = 0; p < target.size(); ++p)
    for (int axis = 0; axis < 5; ++axis)
      for (const std::string_view name : names[axis])
        if (!has[axis] && !element.properties[p].isList && !name.empty() && element.properties[p].name == name)
          target[p] = axis, has[axis] = true;
  if (!has[0] || !has[1] || !has[2]) fail("the vertices lack x, y or z");
  const bool hasUv = has[3] && has[4];

  Scene& scene = mesh_.scene;
  scene.positions.reserve(element.count);
  if (hasUv) scene.uvs.reserve(element.count);
  for (uint64_t i = 0; i < element.count; ++i) {
    double value[5] = {};
    for (std::size_t p = 0; p < target.size(); ++p)
      if (target[p] >= 0)
        value[target[p]] = number(element.properties[p].type);
      else
        skip(element.properties[p]);
    scene.positions.push_back({toCoordinate(value[0]), toCoordinate(value[1]), toCoordinate(value[2])});
    const bool finite = std::abs(value[3]) < 1e30 && std::abs(value[4]) < 1e30;
    if (hasUv) scene.uvs.push_back(finite ? vec2(value[3], value[4]) : vec2(0));
  }
}

void PlyReader::addFace() {
  for (const int64_t index : polygon_)
    if (index < 0 || static_cast<uint64_t>(index) >= vertexCount_)
      fail(fmt::format("vertex index {} is out of range: the file has {} vertices, from 0", index, vertexCount_));
  if (polygon_.size() < 3) {
    ++shortFaces_;
    return;
  }
  // The vertices may come after the faces; then their places are not known yet, and a fan must do.
  cut_.clear();
  if (mesh_.scene.positions.empty()) {
    for (uint32_t i = 2; i < polygon_.size(); ++i) cut_.push_back({0, i - 1, i});
  } else {
    corners_.clear();
    for (const int64_t index : polygon_) corners_.push_back(mesh_.scene.positions[index]);
    triangulate(corners_, cut_);
  }
  for (const uvec3& t : cut_) mesh_.scene.triangles.push_back({polygon_[t.x], polygon_[t.y], polygon_[t.z]});
}

void PlyReader::readFaces(const Element& element) {
  mesh_.scene.triangles.reserve(element.count);
  for (uint64_t i = 0; i < element.count; ++i)
    for (const Property& property : element.properties) {
      if (!isIndices(property)) {
        skip(property);
        continue;
      }
      polygon_.resize(listSize(property));
      for (int64_t& index : polygon_) {
        const double value = number(property.type);
        index = value >= 0 && value < 4294967296.0 && value == std::floor(value) ? static_cast<int64_t>(value) : -1;
      }
      addFace();
    }
}

Mesh PlyReader::read() {
  readHeader();
  bool hasVertices = false;
  for (const Element& element : elements_)
    if (element.name == "vertex") vertexCount_ = element.count, hasVertices = true;
  if (!hasVertices) fail("no element 'vertex'");
  for (const Element& element : elements_) {
    if (element.properties.empty() && element.name != "vertex") continue;
    if (!element.properties.empty()) checkSize(element);
    if (element.name == "vertex") {
      readVertices(element);
    } else if (element.name == "face") {
      readFaces(element);
    } else {
      for (uint64_t i = 0; i < element.count; ++i)
        for (const Property& property : element.properties) skip(property);
    }
  }
  Scene& scene = mesh_.scene;
  if (!scene.uvs.empty()) scene.uvTriangles = scene.triangles;
  scene.materials = {greyMaterial("default")};
  scene.materialOf.assign(scene.triangles.size(), 0);
  if (shortFaces_)
    scene.notes.push_back(fmt::format("{}: ignored {} faces with fewer than three corners", file_, shortFaces_));
  if (!binary_) noteOpenEnd(file_, text_, scene.notes);
  return std::move(mesh_);
}

}  // namespace

Mesh loadPly(const std::string& file) {
  const std::string text = readFile(file);
  return PlyReader(file, text).read();
}

}  // namespace copse
