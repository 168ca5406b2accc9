// "OpenEXR File Layout": a magic number and flags, then for each part attributes of name, type, size and value until an
// empty name; several parts end with an empty header.
#include "tracer/image/exr_header.h"

#include <fmt/format.h>

#include <cstdint>
#include <filesystem>
#include <fstream>

#include "builder/base/error.h"

namespace copse {

namespace {

constexpr uint32_t magic = 20000630, severalParts = 0x1000;

/// Little-endian; 0 at the end of the file.
uint32_t number(std::istream& stream) {
  unsigned char bytes[4] = {};
  stream.read(reinterpret_cast<char*>(bytes), 4);
  return bytes[0] | bytes[1] << 8 | bytes[2] << 16 | static_cast<uint32_t>(bytes[3]) << 24;
}

/// Up to the byte 0.
std::string word(std::istream& stream) {
  constexpr int most = 255;
  std::string text;
  for (int c; (c = stream.get()) > 0 && text.size() <= most;) text += static_cast<char>(c);
  return text;
}

struct FixedType {
  const char* name;
  uint64_t bytes;
};
constexpr FixedType fixedTypes[] = {{"box2i", 16},
                                    {"box2f", 16},
                                    {"chromaticities", 32},
                                    {"compression", 1},
                                    {"deepImageState", 1},
                                    {"double", 8},
                                    {"envmap", 1},
                                    {"float", 4},
                                    {"int", 4},
                                    {"keycode", 28},
                                    {"lineOrder", 1},
                                    {"m33f", 36},
                                    {"m33d", 72},
                                    {"m44f", 64},
                                    {"m44d", 128},
                                    {"rational", 8},
                                    {"tiledesc", 9},
                                    {"timecode", 8},
                                    {"v2i", 8},
                                    {"v2f", 8},
                                    {"v2d", 16},
                                    {"v3i", 12},
                                    {"v3f", 12},
                                    {"v3d", 24}};

/// How many bytes of a value OpenEXR reads, which for many types is not the size that the header gives; `end` at the
/// end of the file. Moves the stream.
uint64_t bytesRead(std::istream& stream, const std::string& type, uint64_t size) {
  constexpr uint64_t end = UINT64_MAX;
  for (const FixedType& fixed : fixedTypes)
    if (type == fixed.name) return fixed.bytes;
  if (type == "preview") {
    const uint64_t width = number(stream), height = number(stream);
    return width < INT32_MAX / 8 && height < INT32_MAX / 8 ? 8 + 4 * width * height : end;
  }
  uint64_t bytes = 0;
  if (type == "chlist") {
    for (std::string name; stream; bytes += name.size() + 17) {
      if ((name = word(stream)).empty()) return bytes + 1;
      stream.seekg(16, std::ios::cur);
    }
    return end;
  }
  if (type != "stringvector") return size;
  while (bytes < size && stream) {
    const uint64_t length = number(stream);
    if (length > size) return end;
    stream.seekg(static_cast<std::streamoff>(length), std::ios::cur);
    bytes += 4 + length;
  }
  return bytes;
}

}  // namespace

void checkExrHeader(const std::string& file) {
  std::error_code error;
  const uint64_t bytes = std::filesystem::file_size(file, error);
  std::ifstream stream(file, std::ios::binary);
  if (error || number(stream) != magic) return;
  const bool hasSeveral = number(stream) & severalParts;
  std::string last = "start";
  while (stream) {
    const std::string name = word(stream);
    if (name.empty() && (!hasSeveral || last.empty())) return;
    last = name;
    if (name.empty()) continue;
    const std::string type = word(stream);
    const uint64_t size = number(stream);
    if (!stream) return;
    const std::streampos begin = stream.tellg();
    if (size > bytes - static_cast<uint64_t>(begin))
      throw InputError(
          fmt::format("the attribute {} of its header is larger than the file: {} bytes of {}", name, size, bytes));
    if (bytesRead(stream, type, size) != size)
      throw InputError(
          fmt::format("the attribute {} of its header, a {}, is not of the size given: {}", name, type, size));
    stream.clear();
    stream.seekg(begin + static_cast<std::streamoff>(size));
  }
}

}  // namespace copse
