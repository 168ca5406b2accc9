// PLY: the order of elements, line ends, byte order marks, and counts that the lines do not bear out.
#include <bit>
#include <cstring>

#include "tests/support/catch.h"
#include "tests/support/scene_files.h"

using namespace copse;
using namespace copse::test;

namespace copse::test {
std::string binaryPyramid(bool big);
}

namespace {

const std::string xyz = "property float x\nproperty float y\nproperty float z\n";
const std::string indices = "property list uchar int vertex_indices\n";

std::string header(int vertices, int faces, const std::string& more = "") {
  return "ply\nformat ascii 1.0\nelement vertex " + std::to_string(vertices) + "\n" + xyz + more + "element face " +
         std::to_string(faces) + "\n" + indices + "end_header\n";
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size())
    text.replace(at, from.size(), to);
  return text;
}

struct Loader {
  SceneFolder folder;
  Scene load(const std::string& text) const { return loadScene(folder.write("a.ply", text)); }
  std::string error(const std::string& text) const { return errorOf(folder.write("a.ply", text)); }
};

}  // namespace

TEST_CASE("faces before their vertices are cut as those after them") {
  const Loader loader;
  const std::string vertices = "2 -2 0\n0 4 0\n-2 -2 0\n-0.2 0 0\n0.2 0 0\n", face = "5 4 0 1 2 3\n3 0 1 2\n";
  const Scene last = loader.load(header(5, 2) + vertices + face);
  const Scene first = loader.load("ply\nformat ascii 1.0\nelement face 2\n" + indices + "element vertex 5\n" + xyz +
                                  "end_header\n" + face + vertices);
  CHECK(first.triangles == last.triangles);
  CHECK(first.positions == last.positions);
  CHECK(doubleArea(first) == Approx(2 * (7.6 + 12)));
}

TEST_CASE("a line of a text PLY that has more or fewer values than its element is an error") {
  const Loader loader;
  const std::string square = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n", faces = "3 0 1 2\n3 0 2 3\n";
  CHECK_THAT(loader.error(header(4, 2) + replaced(square, " 0\n", " 0 3\n") + faces),
             Equals("a.ply:10: expected 3 values for element 'vertex', got 4"));
  CHECK_THAT(loader.error(header(4, 2, "property uchar red\nproperty uchar green\nproperty uchar blue\n") +
                          replaced(square, " 0\n", " 0 9 8 7 255\n") + faces),
             Equals("a.ply:13: expected 6 values for element 'vertex', got 7"));
  CHECK_THAT(loader.error(header(4, 2) + replaced(square, "1 1 0", "1 1") + faces),
             Equals("a.ply:12: expected 3 values for element 'vertex', got 2"));
  CHECK_THAT(loader.error(header(4, 2) + square + "3 0 1 2 255 0 0\n3 0 2 3 255 0 0\n"),
             Equals("a.ply:14: expected 4 values for element 'face', got 7"));
  CHECK_THAT(loader.error(header(4, 2) + square + "4 0 1 2\n3 0 2 3\n"),
             Equals("a.ply:14: expected 5 values for element 'face', got 4"));
  // Too few vertices are declared, so that the fourth is taken for a face without corners.
  CHECK_THAT(loader.error(header(3, 2) + square + faces),
             Equals("a.ply:13: expected 1 values for element 'face', got 3"));
  CHECK_THAT(loader.error(header(5, 2) + square + faces),
             Equals("a.ply:14: expected 3 values for element 'vertex', got 4"));
  CHECK_THAT(loader.error(header(4, 3) + square + faces), StartsWith("a.ply:16: the file ends too early"));
  // All words fit by chance, but there are as many lines as elements.
  CHECK_THAT(loader.error(header(3, 1) + "0 0 0 1\n0 0\n0 1 0\n3 0 1 2\n"),
             Equals("a.ply:10: expected 3 values for element 'vertex', got 4"));
}

TEST_CASE("a text PLY may have blank lines, blanks at line ends, and lists over several lines") {
  const Loader loader;
  const Scene plain = loader.load(header(4, 1) + "0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n");
  CHECK(plain.triangles.size() == 2);
  CHECK_FALSE(hasNote(plain, "word by word"));
  const Scene blank = loader.load(header(4, 1) + "\n 0 0 0 \n1 0 0\t\n\n1 1 0\n0 1 0\n4 0 1 2 3  \n\n \n");
  CHECK(blank.triangles == plain.triangles);
  CHECK_FALSE(hasNote(blank, "word by word"));
  for (const std::string data : {"0 0 0 1 0 0 1 1 0 0 1 0\n4 0 1 2 3\n", "0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1\n2 3\n"}) {
    const Scene scene = loader.load(header(4, 1) + data);
    CHECK(scene.triangles == plain.triangles);
    CHECK(scene.positions == plain.positions);
    CHECK(hasNote(scene, "read word by word: lines do not hold one element each"));
  }
}

TEST_CASE("what follows a PLY's last element is noted, and an error where nothing else is there") {
  const Loader loader;
  const std::string square = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n", faces = "3 0 1 2\n3 0 2 3\n";
  const Scene text = loader.load(header(4, 1) + square + faces);
  CHECK(text.triangles.size() == 1);
  CHECK(hasNote(text, "a.ply:15: ignored all after the last element that the header declares"));
  CHECK_THAT(loader.error(header(4, 0) + square + faces), StartsWith("a.ply:14: the file goes on after the elements"));
  CHECK_FALSE(hasNote(loader.load(header(4, 2) + square + faces + " \n\x1a"), "ignored all"));
  const std::string binary = binaryPyramid(false);
  CHECK(hasNote(loader.load(binary + "more"), "a.ply: ignored 4 bytes after the last element"));
  CHECK_FALSE(hasNote(loader.load(binary + std::string(3, '\0')), "after the last element"));
}

TEST_CASE("line ends and a byte order mark make no difference to a PLY in text") {
  const Loader loader;
  const std::string text = bytesOf(sceneData("pyramid.ply"));
  const Scene plain = loader.load(text);
  for (const std::string end : {"\n", "\r\n", "\r"})
    for (const std::string mark : {"", "\xef\xbb\xbf"}) {
      const Scene scene = loader.load(mark + replaced(text, "\n", end));
      CHECK(scene.positions == plain.positions);
      CHECK(scene.triangles == plain.triangles);
      CHECK_THAT(loader.error(mark + replaced(replaced(text, "0 3 3 4 0", "0 3 3 four 0"), "\n", end)),
                 Equals("a.ply:28: 'four' is not a number"));
    }
}

TEST_CASE("line ends and a byte order mark before binary data, and data that begin like line ends") {
  const Loader loader;
  for (const bool big : {false, true}) {
    const std::string head = std::string("ply\nformat binary_") + (big ? "big" : "little") +
                             "_endian 1.0\nelement material 1\nproperty uchar a\nproperty uchar b\nelement vertex 3\n" +
                             xyz + "element face 1\n" + indices + "end_header\n";
    const float places[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    const uint32_t corners[3] = {0, 1, 2};
    std::string data;
    const auto put = [&](uint32_t bits) {
      for (int k = 0; k < 4; ++k) data += static_cast<char>(bits >> 8 * (big ? 3 - k : k) & 255);
    };
    for (const float value : places) put(std::bit_cast<uint32_t>(value));
    data += '\3';
    for (const uint32_t corner : corners) put(corner);
    for (const std::string end : {"\n", "\r\n", "\r"})
      for (const std::string mark : {"", "\xef\xbb\xbf"})
        for (const std::string start : {"\n\n", "\r\n", "\n\r", "\r\r", "  ", "\t\n"}) {
          INFO(big << end.size() << mark.size());
          const Scene scene = loader.load(mark + replaced(head, "\n", end) + start + data);
          REQUIRE(scene.triangles == std::vector<uvec3>{{0, 1, 2}});
          CHECK(scene.positions.at(1) == vec3(1, 0, 0));
          CHECK_FALSE(hasNote(scene, "after the last element"));
        }
  }
}

TEST_CASE("lists of any type, in any element and place, are skipped") {
  const Loader loader;
  for (const std::string type : {"char", "uchar", "short", "ushort", "int", "uint", "float", "double"}) {
    const Scene scene =
        loader.load("ply\nformat ascii 1.0\nelement before 2\nproperty list int " + type +
                    " a\nelement vertex 3\nproperty list uchar " + type + " near\n" + xyz +
                    "element face 1\nproperty list uint " + type + " uv\nproperty list uchar " + type +
                    " vertex_index\nproperty list uchar int vertex_indices\nelement after 1\nproperty " + type +
                    " w\nend_header\n0\n2 5 6\n0 0 0 0\n1 7 1 0 0\n2 7 8 0 1 0\n2 1 1 3 0 1 2 3 2 1 0\n9\n");
    INFO(type);
    CHECK(scene.triangles == std::vector<uvec3>{{0, 1, 2}});
    CHECK(scene.positions.at(2) == vec3(0, 1, 0));
  }
}
