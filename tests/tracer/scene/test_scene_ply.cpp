// PLY: text and binary of both byte orders give the same mesh; what is broken is refused.
#include <algorithm>
#include <bit>
#include <cstring>

#include "tests/support/catch.h"
#include "tests/support/scene_files.h"

using namespace copse;
using namespace copse::test;

namespace {

struct Bytes {
  bool big;
  std::string text;
  template <class T>
  Bytes& operator<<(T value) {
    char bytes[sizeof(T)];
    std::memcpy(bytes, &value, sizeof(T));
    if (big == (std::endian::native == std::endian::little)) std::reverse(bytes, bytes + sizeof(T));
    text.append(bytes, sizeof(T));
    return *this;
  }
};

}  // namespace

namespace copse::test {
/// The pyramid of tests/data in binary.
std::string binaryPyramid(bool big) {
  Bytes out{big, {}};
  out.text =
      std::string("ply\nformat binary_") + (big ? "big" : "little") +
      "_endian 1.0\nelement vertex 5\nproperty float64 x\nproperty float y\nproperty int16 z\nproperty uchar red\n"
      "property float u\nproperty float v\nelement edge 1\nproperty list uchar int ends\nproperty double weight\n"
      "element face 5\nproperty uchar flags\nproperty list int uint vertex_index\nend_header\n";
  const double vertices[5][5] = {
      {-1, 0, -1, 0, 0}, {1, 0, -1, 1, 0}, {1, 0, 1, 1, 1}, {-1, 0, 1, 0, 1}, {0, 1, 0, 0.5, 0.5}};
  for (const auto& v : vertices)
    out << v[0] << static_cast<float>(v[1]) << static_cast<int16_t>(v[2]) << uint8_t{255} << static_cast<float>(v[3])
        << static_cast<float>(v[4]);
  out << uint8_t{2} << int32_t{0} << int32_t{1} << 0.5;
  const std::vector<std::vector<uint32_t>> faces = {{0, 1, 2, 3}, {0, 4, 1}, {1, 4, 2}, {2, 4, 3}, {3, 4, 0}};
  for (const auto& face : faces) {
    out << uint8_t{0} << static_cast<int32_t>(face.size());
    for (const uint32_t index : face) out << index;
  }
  return out.text;
}
}  // namespace copse::test

TEST_CASE("PLY in text and in binary of both byte orders is the same mesh") {
  const SceneFolder folder;
  const Scene text = loadScene(sceneData("pyramid.ply"));
  CHECK(text.triangles.size() == 6);
  CHECK(text.bounds().hi == vec3(1, 1, 1));
  CHECK(text.uvs.at(4) == vec2(0.5f, 0.5f));
  CHECK(doubleArea(text) == Approx(2 * (4 + 4 * std::sqrt(2.0))));
  for (const bool big : {false, true}) {
    const Scene binary = loadScene(folder.write("b.ply", binaryPyramid(big)));
    CHECK(binary.positions == text.positions);
    CHECK(binary.triangles == text.triangles);
    CHECK(binary.uvs == text.uvs);
    CHECK(binary.uvTriangles == text.uvTriangles);
  }
}

TEST_CASE("a PLY that is cut anywhere is an error that says so") {
  const SceneFolder folder;
  const std::string text = bytesOf(sceneData("pyramid.ply"));
  for (const std::string& whole : {text, binaryPyramid(false), binaryPyramid(true)})
    for (std::size_t size = 0; size + 2 < whole.size(); ++size) {
      const std::string error = errorOf(folder.write("a.ply", whole.substr(0, size)));
      INFO(size);
      REQUIRE_THAT(error, StartsWith("a.ply:"));
    }
  CHECK_THAT(errorOf(folder.write("a.ply", text.substr(0, text.find("0 3 3 4 0")))),
             Equals("a.ply:28: the file ends too early"));
  const std::string binary = binaryPyramid(false);
  CHECK_THAT(errorOf(folder.write("a.ply", binary.substr(0, binary.size() - 1))),
             StartsWith("a.ply: at byte " + std::to_string(binary.size() - 4)));
}

TEST_CASE("broken PLY headers and values are errors with their line") {
  const SceneFolder folder;
  const std::string text = bytesOf(sceneData("pyramid.ply"));
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string changed = text;
    changed.replace(changed.find(from), from.size(), to);
    return errorOf(folder.write("a.ply", changed));
  };
  CHECK_THAT(with("ply", "plx"), StartsWith("a.ply:1: does not begin with 'ply'"));
  CHECK_THAT(with("ascii", "text"), Equals("a.ply:2: unsupported PLY format 'text'"));
  CHECK_THAT(with("ascii 1.0", "ascii 2.0"), StartsWith("a.ply:2: unsupported PLY version '2.0'"));
  CHECK_THAT(with("vertex_ind", "corner_ind"), Contains("the faces lack the list 'vertex_indices'"));
  CHECK_THAT(with("format ascii 1.0\n", ""), Contains("names no format"));
  CHECK_THAT(with("property float x", "property real x"), Equals("a.ply:5: 'real' is not a type"));
  CHECK_THAT(with("property float x", "property float w"), Contains("the vertices lack x, y or z"));
  CHECK_THAT(with("property list uchar int v", "property list float int v"),
             Contains("'float' is not a valid list length type"));
  CHECK_THAT(with("element edge 1", "element vertex 1"), Equals("a.ply:11: duplicate element 'vertex'"));
  CHECK_THAT(with("element vertex 5", "element vertex -5"), StartsWith("a.ply:4: an element needs a name and a count"));
  CHECK_THAT(with("element vertex 5", "element point 5"), Contains("no element 'vertex'"));
  CHECK_THAT(with("element face", "elements face"), Contains("unknown PLY header keyword 'elements'"));
  CHECK_THAT(with("0 3 3 4 0", "0 3 3 4 5"),
             Equals("a.ply:28: vertex index 5 is out of range: the file has 5 vertices, from 0"));
  CHECK_THAT(with("0 3 3 4 0", "0 3 3 4 -1"), StartsWith("a.ply:28: vertex index -1 is out of range"));
  CHECK_THAT(with("0 3 3 4 0", "0 -3 3 4 0"), Contains("invalid list length -3"));
  CHECK_THAT(with("0 3 3 4 0", "0 3 3 four 0"), Equals("a.ply:28: 'four' is not a number"));
  CHECK_THAT(with("0 3 3 4 0", "0 2 3 4"), Equals(""));
  CHECK(hasNote(loadScene(folder.file("a.ply")), "ignored 1 faces with fewer than three corners"));
}

TEST_CASE("absurd counts of a PLY allocate nothing") {
  const SceneFolder folder;
  for (const std::string count : {"4000000000", "9000000000000000000", "99999999999999999999"})
    for (const std::string format : {"ascii", "binary_little_endian"})
      for (const std::string element : {"vertex", "face"}) {
        const std::string header =
            "ply\nformat " + format + " 1.0\nelement vertex " + (element == "vertex" ? count : "0") +
            "\nproperty float x\nproperty float y\nproperty float z\nelement face " +
            (element == "face" ? count : "0") + "\nproperty list uchar int vertex_indices\nend_header\n";
        INFO(header);
        CHECK_THAT(errorOf(folder.write("a.ply", header + "0 0 0\n")), Contains("a.ply:"));
      }
  const std::string list =
      "ply\nformat binary_little_endian 1.0\nelement vertex 0\nproperty float x\nproperty float y\n"
      "property float z\nelement face 1\nproperty list uint int vertex_indices\nend_header\n";
  CHECK_THAT(errorOf(folder.write("a.ply", list + "\xff\xff\xff\xff")), Contains("a list of 4294967295 values"));
}

TEST_CASE("an empty PLY mesh loads, one with vertices that are not finite drops triangles") {
  const SceneFolder folder;
  const std::string header =
      "ply\r\nformat ascii 1.0\r\nelement face 2\r\nproperty list uchar int vertex_indices\r\n"
      "element vertex 4\r\nproperty float x\r\nproperty float y\r\nproperty float z\r\nend_header\r\n";
  const Scene scene = loadScene(folder.write("a.ply", header + "3 0 1 2\n3 1 2 3\n0 0 0\n1 0 0\n0 1 0\nnan 0 0\n"));
  CHECK(scene.triangles == std::vector<uvec3>{{0, 1, 2}});
  CHECK(hasNote(scene, "dropped 1 triangle with"));
  const Scene empty = loadScene(folder.write(
      "b.ply",
      "ply\nformat ascii 1.0\nelement vertex 0\nproperty float x\nproperty float y\nproperty float z\nend_header\n"));
  CHECK(empty.triangles.empty());
  CHECK(hasNote(empty, "no triangles"));
}

TEST_CASE("faces without corners and triangle strips are not taken for an empty mesh") {
  const SceneFolder folder;
  const std::string vertices =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n";
  const std::string values = "end_header\n0 0 0\n1 0 0\n0 1 0\n";
  const std::string strips = "element tristrips 1\nproperty list int int vertex_indices\n";
  const std::string faces = "element face 1\nproperty list uchar int vertex_indices\n";
  const auto error = [&](const std::string& text) { return errorOf(folder.write("a.ply", text)); };
  CHECK_THAT(error(vertices + "element face 1\nproperty uchar red\n" + values + "7\n"),
             Equals("a.ply:7: the faces lack the list 'vertex_indices'"));
  CHECK_THAT(error(vertices + "element face 1\n" + values), StartsWith("a.ply:7: the faces lack"));
  CHECK_THAT(error(vertices + "element face 0\n" + values), Equals(""));
  CHECK_THAT(error(vertices + strips + values + "3 0 1 2\n"), StartsWith("a.ply:7: triangle strips"));
  const Scene both = loadScene(folder.write("a.ply", vertices + faces + strips + values + "3 0 1 2\n3 0 1 2\n"));
  CHECK(both.triangles.size() == 1);
  CHECK(hasNote(both, "a.ply:9: ignored unsupported triangle strips"));
}

TEST_CASE("a text PLY whose last line has no end loads with a note, a binary one without") {
  const SceneFolder folder;
  const std::string text = bytesOf(sceneData("pyramid.ply"));
  CHECK(hasNote(loadScene(folder.write("a.ply", text.substr(0, text.size() - 1))), "a.ply: the last line has no end"));
  CHECK_FALSE(hasNote(loadScene(folder.write("a.ply", text)), "no end"));
  CHECK_FALSE(hasNote(loadScene(folder.write("a.ply", binaryPyramid(false))), "no end"));
}
