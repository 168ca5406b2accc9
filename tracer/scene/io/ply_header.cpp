// Line by line, up to end_header.
#include "tracer/scene/io/ply_header.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>

#include "builder/base/error.h"
#include "builder/base/text.h"

namespace copse {
namespace {

bool parseType(std::string_view word, PlyType& type) {
  using enum PlyType;
  static constexpr std::pair<std::string_view, PlyType> names[] = {
      {"char", i8},    {"int8", i8},     {"uchar", u8},   {"uint8", u8},   {"short", i16}, {"int16", i16},
      {"ushort", u16}, {"uint16", u16},  {"int", i32},    {"int32", i32},  {"uint", u32},  {"uint32", u32},
      {"float", f32},  {"float32", f32}, {"double", f64}, {"float64", f64}};
  for (const auto& [name, value] : names)
    if (word == name) return type = value, true;
  return false;
}

class HeaderReader {
 public:
  HeaderReader(const std::string& file, std::string_view text) : file_(file), rest_(withoutMark(text)) {}
  PlyHeader read(std::vector<std::string>& notes);
  std::size_t bytesLeft() const { return rest_.size(); }

 private:
  [[noreturn]] void fail(const std::string& what) const {
    throw InputError(fmt::format("{}:{}: {}", file_, header_.lines, what));
  }
  std::string_view takeLine();
  void readFormat(std::string_view rest);
  void readElement(std::string_view rest);
  void readProperty(std::string_view rest);
  void checkFaces(std::vector<std::string>& notes);

  std::string file_;
  std::string_view rest_;
  bool endsAreCr_ = false;
  PlyHeader header_;
};

/// In a header whose lines end with CR alone, an LF after end_header is the first byte of binary data.
std::string_view HeaderReader::takeLine() {
  if (rest_.empty()) fail("the file ends within its header");
  const std::size_t end = std::min(rest_.find_first_of("\r\n"), rest_.size());
  const std::string_view line = rest_.substr(0, end);
  const bool isCrlf = rest_.substr(end, 2) == "\r\n";
  if (header_.lines == 0) endsAreCr_ = rest_.substr(end, 1) == "\r" && !isCrlf;
  rest_.remove_prefix(std::min(end + 1 + (isCrlf && !endsAreCr_), rest_.size()));
  ++header_.lines;
  return line;
}

void HeaderReader::readFormat(std::string_view rest) {
  const std::string_view format = nextWord(rest);
  header_.isBinary = format == "binary_little_endian" || format == "binary_big_endian";
  if (!header_.isBinary && format != "ascii") fail(fmt::format("unsupported PLY format '{}'", format));
  const bool isBig = format == "binary_big_endian";
  header_.isSwapped = header_.isBinary && isBig != (std::endian::native == std::endian::big);
  const std::string_view version = nextWord(rest);
  if (version != "1.0") fail(fmt::format("unsupported PLY version '{}' (expected 1.0)", version));
}

void HeaderReader::readElement(std::string_view rest) {
  const std::string name(nextWord(rest));
  int64_t count = 0;
  if (!parseInteger(nextWord(rest), count) || count < 0) fail("an element needs a name and a count");
  for (const PlyElement& other : header_.elements)
    if (other.name == name) fail(fmt::format("duplicate element '{}'", name));
  header_.elements.push_back({name, static_cast<uint64_t>(count), {}, header_.lines});
}

void HeaderReader::readProperty(std::string_view rest) {
  if (header_.elements.empty()) fail("a property before the first element");
  PlyProperty property;
  std::string_view word = nextWord(rest);
  property.isList = word == "list";
  if (property.isList) {
    word = nextWord(rest);
    if (!parseType(word, property.countType) || property.countType >= PlyType::f32)
      fail(fmt::format("'{}' is not a valid list length type", word));
    word = nextWord(rest);
  }
  if (!parseType(word, property.type)) fail(fmt::format("'{}' is not a type", word));
  property.name = nextWord(rest);
  if (property.name.empty()) fail("a property without a name");
  header_.elements.back().properties.push_back(property);
}

/// A surface that would be skipped like any unknown element is no empty mesh.
void HeaderReader::checkFaces(std::vector<std::string>& notes) {
  const PlyElement *faces = nullptr, *strips = nullptr;
  for (const PlyElement& element : header_.elements) {
    if (element.name == "face" && element.count > 0) faces = &element;
    if (element.name == "tristrips" && element.count > 0) strips = &element;
  }
  const auto failAt = [&](int line, const std::string& what) {
    throw InputError(fmt::format("{}:{}: {}", file_, line, what));
  };
  if (faces && std::ranges::none_of(faces->properties, &PlyProperty::isIndices))
    failAt(faces->line, "the faces lack the list 'vertex_indices'");
  if (!strips) return;
  if (!faces) failAt(strips->line, "triangle strips ('tristrips') are unsupported (expected faces)");
  notes.push_back(fmt::format("{}:{}: ignored unsupported triangle strips", file_, strips->line));
}

PlyHeader HeaderReader::read(std::vector<std::string>& notes) {
  if (trim(takeLine()) != "ply") fail("does not begin with 'ply': this is not a PLY file");
  bool hasFormat = false;
  for (;;) {
    std::string_view rest = takeLine();
    const std::string_view key = nextWord(rest);
    if (key == "end_header") break;
    if (key == "comment" && nextWord(rest) == "TextureFile" && !trim(rest).empty())
      header_.textures.emplace_back(trim(rest));
    if (key.empty() || key == "comment" || key == "obj_info") continue;
    if (key == "format") {
      readFormat(rest);
      hasFormat = true;
    } else if (key == "element") {
      readElement(rest);
    } else if (key == "property") {
      readProperty(rest);
    } else {
      fail(fmt::format("unknown PLY header keyword '{}'", key.substr(0, 40)));
    }
  }
  if (!hasFormat) fail("the header names no format");
  checkFaces(notes);
  return std::move(header_);
}

}  // namespace

std::size_t sizeOf(PlyType type) {
  static constexpr std::size_t sizes[] = {1, 1, 2, 2, 4, 4, 4, 8};
  return sizes[static_cast<int>(type)];
}

PlyHeader readPlyHeader(const std::string& file, std::string_view text, std::vector<std::string>& notes) {
  HeaderReader reader(file, text);
  PlyHeader header = reader.read(notes);
  header.size = text.size() - reader.bytesLeft();
  return header;
}

}  // namespace copse
