// Stanford PLY (Greg Turk, 1994): text and binary of both byte orders. Vertices with x y z and perhaps texture
// coordinates, faces as lists of vertex indices; every other element and property is skipped. One pass over the file.
// Text is read word by word, as lists may go over several lines; but where an element does not fill its line, all else
// must fit, or words were taken for what they are not.
#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

#include "builder/base/error.h"
#include "builder/base/files.h"
#include "builder/base/text.h"
#include "tracer/scene/io/mesh.h"
#include "tracer/scene/io/origin.h"
#include "tracer/scene/io/ply_header.h"
#include "tracer/scene/io/ply_textures.h"
#include "tracer/scene/io/polygon.h"

namespace copse {
namespace {

constexpr std::string_view blanks = " \t\r\n";

class PlyReader {
 public:
  PlyReader(const std::string& file, const std::string& text)
      : file_(file), text_(text), header_(readPlyHeader(file, text, mesh_.scene.notes)), binary_(header_.isBinary) {
    rest_ = text_.substr(header_.size);
    textures_.files = header_.textures;
    line_ = header_.lines + 1;
  }
  Mesh read();

 private:
  [[noreturn]] void fail(const std::string& what) const {
    if (!misfit_.empty()) throw InputError(misfit_);
    if (!binary_) throw InputError(fmt::format("{}:{}: {}", file_, line_, what));
    throw InputError(fmt::format("{}: at byte {}: {}", file_, text_.size() - rest_.size(), what));
  }

  void skipBlanks();
  std::string_view takeWord();
  void checkSize(const PlyElement& element) const;
  double number(PlyType type);
  template <class T>
  T raw();
  void skip(const PlyProperty& property);
  uint32_t listSize(const PlyProperty& property);
  template <class ReadOne>
  void readElements(const PlyElement& element, const ReadOne& readOne);
  void checkLine(const PlyElement& element, const char* begin);
  void readVertices(const PlyElement& element);
  void readFaces(const PlyElement& element);
  void takeFace();
  void addTriangles(std::span<const uint32_t> face);
  void checkEnd();
  void remarkColours(const PlyElement& element);
  void noteCoarse();

  std::string file_;
  std::string_view text_, rest_;
  Mesh mesh_;
  PlyHeader header_;
  int line_ = 0;
  bool binary_;
  bool hasPositions_ = false;
  bool hasFloats_ = false;  ///< Positions are floats in the file.
  std::vector<uint32_t> face_;
  std::vector<uint32_t> waiting_;  ///< Faces before their vertices: the number of corners, then their indices.
  glm::dvec3 origin_{0};           ///< Of the corners of a polygon, which are floats.
  std::vector<vec3> corners_;
  std::vector<uvec3> cut_;
  PlyTextures textures_;
  uint64_t vertexCount_ = 0;
  std::size_t shortFaces_ = 0, crossingFaces_ = 0;
  std::string misfit_;  ///< What is wrong with the first line that does not hold one whole element.
  int misfitLine_ = 0;
};

/// Before anything is allocated: what the header promises must fit into what is left of the file.
void PlyReader::checkSize(const PlyElement& element) const {
  std::size_t minBytes = 0;
  for (const PlyProperty& p : element.properties) minBytes += binary_ ? sizeOf(p.isList ? p.countType : p.type) : 2;
  if (element.count > 0xfffffffeu || (element.count > 0 && element.count > (rest_.size() + 1) / minBytes))
    fail(fmt::format("truncated: the header declares {} of element '{}', which do not fit into the remaining {} bytes",
                     element.count, element.name, rest_.size()));
}

void PlyReader::skipBlanks() {
  const auto isBlank = [](char c) { return c == ' ' || c == '\n' || c == '\r' || c == '\t'; };
  std::size_t begin = 0;
  for (; begin < rest_.size() && isBlank(rest_[begin]); ++begin)
    line_ += rest_[begin] == '\n' || (rest_[begin] == '\r' && rest_.substr(begin + 1, 1) != "\n");
  rest_.remove_prefix(begin);
}

std::string_view PlyReader::takeWord() {
  skipBlanks();
  const std::string_view word = nextWord(rest_);
  if (word.empty()) fail("the file ends too early");
  return word;
}

template <class T>
T PlyReader::raw() {
  if (rest_.size() < sizeof(T)) fail("the file ends too early");
  char bytes[sizeof(T)];
  std::memcpy(bytes, rest_.data(), sizeof(T));
  if (header_.isSwapped) std::reverse(bytes, bytes + sizeof(T));
  rest_.remove_prefix(sizeof(T));
  return std::bit_cast<T>(bytes);
}

double PlyReader::number(PlyType type) {
  if (!binary_) {
    const std::string_view word = takeWord();
    double value;
    if (!parseNumber(word, value)) fail(fmt::format("'{}' is not a number", word.substr(0, 40)));
    return value;
  }
  switch (type) {
    case PlyType::i8:
      return raw<int8_t>();
    case PlyType::u8:
      return raw<uint8_t>();
    case PlyType::i16:
      return raw<int16_t>();
    case PlyType::u16:
      return raw<uint16_t>();
    case PlyType::i32:
      return raw<int32_t>();
    case PlyType::u32:
      return raw<uint32_t>();
    case PlyType::f32:
      return raw<float>();
    case PlyType::f64:
      return raw<double>();
  }
  return 0;
}

uint32_t PlyReader::listSize(const PlyProperty& property) {
  const double size = number(property.countType);
  const std::size_t minBytes = binary_ ? sizeOf(property.type) : 2;
  if (!(size >= 0) || size != std::floor(size)) fail(fmt::format("invalid list length {}", size));
  if (size > static_cast<double>((rest_.size() + 1) / minBytes))
    fail(fmt::format("truncated: a list of {} values", size));
  return static_cast<uint32_t>(size);
}

void PlyReader::skip(const PlyProperty& property) {
  for (uint32_t n = property.isList ? listSize(property) : 1; n > 0; --n) number(property.type);
}

template <class ReadOne>
void PlyReader::readElements(const PlyElement& element, const ReadOne& readOne) {
  for (uint64_t i = 0; i < element.count; ++i) {
    if (!binary_) skipBlanks();
    const char* begin = rest_.data();
    const int line = line_;
    readOne();
    if (binary_ || !misfit_.empty()) continue;
    if (line_ == line && rest_.starts_with('\n')) continue;
    const std::size_t blank = std::min(rest_.find_first_not_of(" \t"), rest_.size());
    if (line_ == line && (blank == rest_.size() || rest_[blank] == '\n' || rest_[blank] == '\r')) continue;
    misfitLine_ = line;
    checkLine(element, begin);
  }
}

void PlyReader::checkLine(const PlyElement& element, const char* begin) {
  const auto words = [](std::string_view text) {
    std::size_t count = 0;
    while (!nextWord(text).empty()) ++count;
    return count;
  };
  const std::string_view whole = text_.substr(begin - text_.data());
  misfit_ =
      fmt::format("{}:{}: expected {} values for element '{}', got {}", file_, misfitLine_,
                  words({begin, rest_.data()}), element.name, words(whole.substr(0, whole.find_first_of("\r\n"))));
}

void PlyReader::readVertices(const PlyElement& element) {
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
  for (std::size_t p = 0; p < target.size(); ++p)
    hasFloats_ |= binary_ && target[p] >= 0 && target[p] < 3 && element.properties[p].type == PlyType::f32;

  Scene& scene = mesh_.scene;
  scene.exactPositions.reserve(element.count);
  if (hasUv) scene.uvs.reserve(element.count);
  readElements(element, [&] {
    double value[5] = {};
    for (std::size_t p = 0; p < target.size(); ++p)
      if (target[p] >= 0)
        value[target[p]] = number(element.properties[p].type);
      else
        skip(element.properties[p]);
    scene.exactPositions.push_back({value[0], value[1], value[2]});
    const bool finite = std::abs(value[3]) < 1e30 && std::abs(value[4]) < 1e30;
    if (hasUv) scene.uvs.push_back(finite ? vec2(value[3], value[4]) : vec2(0));
  });
  hasPositions_ = true;
  origin_ = originOf(scene.exactPositions);
}

void PlyReader::addTriangles(std::span<const uint32_t> face) {
  cut_.clear();
  corners_.clear();
  for (const uint32_t index : face) corners_.push_back(toCoordinates(mesh_.scene.exactPositions[index] - origin_));
  crossingFaces_ += !triangulate(corners_, cut_);
  for (const uvec3& t : cut_) mesh_.scene.triangles.push_back({face[t.x], face[t.y], face[t.z]});
  textures_.addTriangles(cut_, mesh_.scene);
}

void PlyReader::takeFace() {
  if (face_.size() < 3) {
    ++shortFaces_;
    return;
  }
  textures_.takeFace(face_.size(), mesh_.scene);
  if (hasPositions_) {
    addTriangles(face_);
  } else {
    waiting_.push_back(static_cast<uint32_t>(face_.size()));
    waiting_.insert(waiting_.end(), face_.begin(), face_.end());
  }
}

void PlyReader::readFaces(const PlyElement& element) {
  mesh_.scene.triangles.reserve(element.count);
  const auto indices = std::ranges::find_if(element.properties, &PlyProperty::isIndices);
  textures_.hasCorners = std::ranges::any_of(element.properties, &PlyProperty::isTextureCorners);
  textures_.hasNumbers = std::ranges::any_of(element.properties, &PlyProperty::isTextureNumber);
  readElements(element, [&] {
    for (const PlyProperty& property : element.properties) {
      if (&property == &*indices) {
        face_.resize(listSize(property));
        for (uint32_t& index : face_) {
          const double value = number(property.type);
          if (!(value >= 0 && value < static_cast<double>(vertexCount_)) || value != std::floor(value))
            fail(fmt::format("vertex index {} is out of range: the file has {} vertices, from 0", value, vertexCount_));
          index = static_cast<uint32_t>(value);
        }
      } else if (property.isTextureCorners()) {
        textures_.corners.resize(listSize(property));
        for (float& coordinate : textures_.corners) coordinate = toCoordinate(number(property.type));
      } else if (property.isTextureNumber()) {
        textures_.number = number(property.type);
      } else {
        skip(property);
      }
    }
    takeFace();
  });
}

/// Surfaces have one colour or a texture.
void PlyReader::remarkColours(const PlyElement& element) {
  const auto isRed = [](const PlyProperty& p) { return p.name == "red" || p.name == "r" || p.name == "diffuse_red"; };
  if (element.count == 0 || std::ranges::none_of(element.properties, isRed)) return;
  const char* what = element.name == "face" ? "faces" : "vertices";
  mesh_.scene.remarks.push_back({fmt::format("colours of {}", what),
                                 fmt::format("{}: ignored the colours of {} {}", file_, element.count, what)});
}

/// Floats far from 0 are as coarse in the file as they would be here.
void PlyReader::noteCoarse() {
  const Scene& scene = mesh_.scene;
  if (!hasFloats_ || origin_ == glm::dvec3(0) || scene.triangles.empty()) return;
  double edges = 0;
  for (const uvec3& t : scene.triangles)
    for (int k = 0; k < 3; ++k)
      edges += glm::distance(scene.exactPositions[t[k]], scene.exactPositions[t[(k + 1) % 3]]);
  const double mean = edges / (3.0 * static_cast<double>(scene.triangles.size()));
  const glm::dvec3 away = glm::abs(origin_);
  const double step = std::exp2(std::floor(std::log2(std::max({away.x, away.y, away.z}))) - 23);
  if (step * 64 > mean)
    mesh_.scene.notes.push_back(
        fmt::format("{}: coordinates are 32-bit floats, which step by {:g} so far from 0: coarse for edges of {:.3g}",
                    file_, step, mean));
}

/// What the file goes on with after its last element, and lines that did not hold one element each.
void PlyReader::checkEnd() {
  Scene& scene = mesh_.scene;
  using namespace std::string_view_literals;
  const std::size_t found = rest_.find_first_not_of(" \t\r\n\x1a\0"sv);
  const bool goesOn = found != std::string_view::npos;
  uint64_t lines = 0, elements = 0;
  if (!misfit_.empty()) {
    for (const PlyElement& element : header_.elements) elements += element.properties.empty() ? 0 : element.count;
    for (std::string_view data = text_.substr(header_.size); !data.empty(); ++lines) {
      data.remove_prefix(std::min(data.find_first_not_of(blanks), data.size()));
      if (data.empty()) break;
      data.remove_prefix(std::min(data.find_first_of("\r\n"), data.size()));
    }
    if (goesOn || shortFaces_ || lines == elements) throw InputError(misfit_);
    scene.notes.push_back(
        fmt::format("{}:{}: read word by word: lines do not hold one element each", file_, misfitLine_));
  }
  if (!goesOn) return;
  if (!binary_) skipBlanks();
  if (scene.triangles.empty())
    fail("the file goes on after the elements that its header declares, which have no triangles");
  scene.notes.push_back(
      binary_ ? fmt::format("{}: ignored {} bytes after the last element that the header declares", file_, rest_.size())
              : fmt::format("{}:{}: ignored all after the last element that the header declares", file_, line_));
}

Mesh PlyReader::read() {
  bool hasVertices = false;
  for (const PlyElement& element : header_.elements)
    if (element.name == "vertex") vertexCount_ = element.count, hasVertices = true;
  if (!hasVertices) fail("no element 'vertex'");
  for (const PlyElement& element : header_.elements) {
    if (element.properties.empty() && element.name != "vertex") continue;
    if (!element.properties.empty()) checkSize(element);
    if (element.name == "vertex" || element.name == "face") remarkColours(element);
    if (element.name == "vertex") {
      readVertices(element);
    } else if (element.name == "face") {
      readFaces(element);
    } else {
      readElements(element, [&] {
        for (const PlyProperty& property : element.properties) skip(property);
      });
    }
  }
  for (std::size_t i = 0; i < waiting_.size(); i += 1 + waiting_[i])
    addTriangles(std::span(waiting_).subspan(i + 1, waiting_[i]));
  checkEnd();
  noteCoarse();
  Scene& scene = mesh_.scene;
  textures_.finish(file_, scene);
  if (shortFaces_)
    scene.notes.push_back(fmt::format("{}: ignored {} faces with fewer than three corners", file_, shortFaces_));
  noteCrossingFaces(file_, crossingFaces_, scene.notes);
  if (!binary_) noteOpenEnd(file_, text_, scene.notes);
  return std::move(mesh_);
}

}  // namespace

Mesh loadPly(const std::string& file) {
  const std::string text = readFile(file);
  return PlyReader(file, text).read();
}

}  // namespace copse
