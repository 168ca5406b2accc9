// "OpenEXR File Layout": a magic number and flags, then for each part attributes of name, type, size and value until an
// empty name; several parts end with an empty header.
#include "tracer/image/exr_header.h"

#include <fmt/format.h>

#include <algorithm>
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

/// A preview's pixels are counted in its value, and not by the attribute's size.
uint64_t sizeOfPreview(std::istream& stream) {
  const std::streampos begin = stream.tellg();
  const uint64_t width = number(stream), height = number(stream);
  stream.clear();
  stream.seekg(begin);
  return width < UINT32_MAX / 8 && height < UINT32_MAX / 8 ? 8 + 4 * width * height : UINT64_MAX;
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
    const uint64_t needs = type == "preview" ? sizeOfPreview(stream) : size;
    const auto at = static_cast<uint64_t>(stream.tellg());
    if (size > bytes - at || needs > bytes - at)
      throw InputError(fmt::format("the attribute {} of its header is larger than the file: {} bytes of {}", name,
                                   std::max(size, needs), bytes));
    stream.seekg(static_cast<std::streamoff>(size), std::ios::cur);
  }
}

}  // namespace copse
