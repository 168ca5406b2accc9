// What a PLY's header declares: its elements, their properties, and how the data after it are written.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace copse {

enum class PlyType { i8, u8, i16, u16, i32, u32, f32, f64 };
/// In bytes.
std::size_t sizeOf(PlyType type);

struct PlyProperty {
  std::string name;
  PlyType type;
  bool isList = false;
  PlyType countType = PlyType::u8;  ///< Of a list's length.

  bool isIndices() const { return isList && (name == "vertex_indices" || name == "vertex_index"); }
  /// Texture coordinates of a face's corners, u and v of each, as MeshLab writes them.
  bool isTextureCorners() const { return isList && (name == "texcoord" || name == "texcoords"); }
  /// Which of the textures they are of.
  bool isTextureNumber() const { return !isList && name == "texnumber"; }
};

struct PlyElement {
  std::string name;
  uint64_t count;
  std::vector<PlyProperty> properties;
  int line;  ///< In the header, from 1.
};

struct PlyHeader {
  bool isBinary = false;
  bool isSwapped = false;  ///< Binary of the byte order that this machine does not have.
  std::vector<PlyElement> elements;
  std::vector<std::string> textures;  ///< Of lines "comment TextureFile NAME".
  std::size_t size = 0;               ///< In bytes; the data follow.
  int lines = 0;
};

/// `text` is a whole PLY. Line ends may be LF, CRLF or CR; a byte order mark may come first. Throws InputError
/// "FILE:LINE: what", also where a surface would be skipped like any element that is not known.
PlyHeader readPlyHeader(const std::string& file, std::string_view text, std::vector<std::string>& notes);

}  // namespace copse
