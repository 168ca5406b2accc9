// OBJ and MTL: what is read, what is noted, and what is refused with its line.
#include <fmt/format.h>

#include <cmath>

#include "tests/support/catch.h"
#include "tests/support/scene_files.h"

using namespace copse;
using namespace copse::test;

namespace {

const std::string triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";

Scene loadText(const std::string& text) {
  const SceneFolder folder;
  return loadScene(folder.write("a.obj", text));
}

std::string errorOfText(const std::string& text) {
  const SceneFolder folder;
  return errorOf(folder.write("a.obj", text));
}

bool sameGeometry(const Scene& a, const Scene& b) {
  return a.positions == b.positions && a.triangles == b.triangles && a.materialOf == b.materialOf && a.uvs == b.uvs &&
         a.uvTriangles == b.uvTriangles;
}

}  // namespace

TEST_CASE("an OBJ with tabs, quads, negative indices, a continued line and names with blanks is read") {
  const Scene scene = loadScene(sceneData("room.obj"));
  REQUIRE(scene.name == "room");
  REQUIRE(scene.triangles.size() == 2 + 2 + 3 + 2);
  REQUIRE(scene.positions.size() == 17);
  REQUIRE(scene.bounds().hi == vec3(2, 2, 1));
  CHECK(doubleArea(scene) == Approx(2 * (4 + 0.25 + 2.5 + 1)));
  REQUIRE(scene.materials.size() == 3);
  CHECK(scene.materials[scene.materialOf[0]].name == "white wall");
  for (int c = 0; c < 3; ++c) CHECK(scene.materials[scene.materialOf[0]].kd[c] == Approx(0.8f - 0.1f * float(c)));
  CHECK(scene.materials[scene.materialOf[2]].ke == vec3(10, 9, 8));
  CHECK(scene.materials[scene.materialOf[2]].kd == vec3(0.5f));
  CHECK(scene.materials[scene.materialOf[8]].name == "white wall");
  CHECK(scene.emits(2));
  CHECK(scene.emitterCount() == 3);  // With the sky of a bare mesh.
}

TEST_CASE("a texture's file is beside its MTL, with slashes, blanks, and scaled and moved by its options") {
  const Scene scene = loadScene(sceneData("room.obj"));
  REQUIRE(scene.textures.size() == 1);
  CHECK(scene.textures[0].file == sceneData("maps/tiles one.png"));
  CHECK(scene.textures[0].texels == nullptr);
  CHECK(scene.materials[scene.materialOf[4]].texture == 0);
  CHECK_FALSE(hasNote(scene, "texture option"));
  REQUIRE(scene.uvTriangles.size() == scene.triangles.size());
  for (std::size_t i = 4; i < 7; ++i)
    for (int k = 0; k < 3; ++k) {
      const vec3 p = scene.positions[scene.triangles[i][k]];
      CHECK(scene.uvs[scene.uvTriangles[i][k]] == vec2((p.x + 1) + 0.5f, p.y));  // -s 2 2 -o 0.5
    }
  CHECK(scene.uvs[scene.uvTriangles[0].x] == vec2(0, 0));
}

TEST_CASE("line ends of Windows and of old Macs, and no line end at last, make no difference") {
  const std::string text = bytesOf(sceneData("room.obj"));
  const auto withEnds = [&](const std::string& end) {
    std::string changed;
    for (const char c : text) changed += c == '\n' ? end : std::string(1, c);
    return changed;
  };
  const Scene unixEnds = loadText(text);
  CHECK(sameGeometry(unixEnds, loadText(withEnds("\r\n"))));
  CHECK(sameGeometry(unixEnds, loadText(withEnds("\r"))));
  CHECK(sameGeometry(unixEnds, loadText(text.substr(0, text.size() - 1))));
}

TEST_CASE("0, 1, 2 and 3 triangles load") {
  const std::string corners = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n";
  const std::string faces[] = {"f 1 2 3\n", "f 1 2 4\n", "f 2 3 4\n"};
  std::string text = corners;
  for (std::size_t n = 0; n <= 3; ++n) {
    const Scene scene = loadText(text);
    CHECK(scene.triangles.size() == n);
    CHECK(scene.cameras.size() == 1);
    CHECK(hasNote(scene, "no triangles") == (n == 0));
    if (n < 3) text += faces[n];
  }
}

TEST_CASE("an n-gon makes n - 2 triangles that cover it, concave ones too") {
  const Scene arrow = loadText("v 0 0 0\nv 2 -2 0\nv 0 4 0\nv -2 -2 0\nf 1 2 3 4\n");  // Reflex at its first corner.
  CHECK(arrow.triangles.size() == 2);
  CHECK(doubleArea(arrow) == Approx(16));
  const Scene quad = loadText("v 2 -2 0\nv 0 4 0\nv -2 -2 0\nv 0 0 0\nf 1 2 3 4\n");
  CHECK(doubleArea(quad) == Approx(16));

  std::string comb = "v 0 -1 0\n";  // Ten teeth of area 1 over a bar of area 20, in a tilted plane.
  std::string face = "f 1";
  int corner = 1;
  const auto add = [&](double x, double y) {
    comb += "v " + std::to_string(x) + " " + std::to_string(y) + " " + std::to_string(x + y) + "\n";
    face += " " + std::to_string(++corner);
  };
  comb = "v 0 -1 -1\n";
  add(20, -1), add(20, 0);
  for (int tooth = 9; tooth >= 0; --tooth) add(2 * tooth + 1, 1), add(2 * tooth, 0);
  const Scene teeth = loadText(comb + face + "\n");
  CHECK(teeth.triangles.size() == 23 - 2);
  CHECK(doubleArea(teeth) == Approx(2 * 30 * std::sqrt(3.0)));
}

TEST_CASE("degenerate polygons give n - 2 triangles as well") {
  CHECK(loadText("v 0 0 0\nv 1 0 0\nv 2 0 0\nv 3 0 0\nv 4 0 0\nf 1 2 3 4 5\n").triangles.size() == 3);
  CHECK(loadText("v 1 1 1\nf 1 1 1 1 1 1\n").triangles.size() == 4);
  CHECK(loadText("v 0 0 0\nv 1 1 0\nv 1 0 0\nv 0 1 0\nf 1 2 3 4\n").triangles.size() == 2);
  CHECK(loadText("v 0 0 0\nv 2 0 0\nv 2 0 0\nv 2 2 0\nv 1 0 0\nv 0 2 0\nf 1 2 3 4 5 6\n").triangles.size() == 4);
}

TEST_CASE("a concave face with very many corners takes bounded work") {
  std::string text, face = "f";
  constexpr int corners = 40'000;
  for (int i = 0; i < corners; ++i) {
    const double angle = 2 * M_PI * i / corners, radius = i % 2 ? 1 : 0.3;
    text += "v " + std::to_string(radius * std::cos(angle)) + " " + std::to_string(radius * std::sin(angle)) + " 0\n";
    face += " " + std::to_string(i + 1);
  }
  CHECK(loadText(text + face + "\n").triangles.size() == corners - 2);
}

TEST_CASE("triangles with a vertex that is not finite are dropped and counted, those of no area stay") {
  for (const std::string bad : {"nan 0 0", "0 -inf 0", "0 NaN 0", "-nan(ind) 0 0", "1.#QNAN 0 0", "0 0 1e999"}) {
    const Scene scene =
        loadText("v " + bad + "\n" + "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 2 3 4\nf 1 2 3\nf 1 3 4\nf 4 1 3\nf 2 2 3\n");
    INFO(bad);
    CHECK(scene.triangles.size() == 2);
    CHECK(scene.positions.size() == 3);
    CHECK(hasNote(scene, "dropped 3 triangles with a vertex that is not finite"));
  }
  const Scene scene = loadText(triangle);
  CHECK_FALSE(hasNote(scene, "dropped"));
}

TEST_CASE("faces may come before their vertices, and vertex colours and weights are not read") {
  const Scene scene = loadText("f 1 2 3\nv 0 0 0 0.1 0.2 0.3\nv 1 0 0 1\nv 0 1 0 red\n");
  CHECK(scene.triangles == std::vector<uvec3>{{0, 1, 2}});
}

TEST_CASE("a missing MTL and a material that it lacks are grey and noted") {
  const Scene missing = loadText("mtllib no.mtl\n" + ("usemtl a\n" + triangle));
  CHECK(hasNote(missing, "no.mtl; its materials are grey"));
  CHECK(missing.materials.at(0).name == "a");
  CHECK(missing.materials.at(0).kd == vec3(0.6f));
  const SceneFolder folder;
  folder.write("my own.mtl", "newmtl b\nKd 1 0 0\n");
  const Scene lacking =
      loadScene(folder.write("a.obj", "mtllib my own.mtl\nusemtl a\n" + triangle + "usemtl b\nf 1 3 2\n"));
  CHECK(hasNote(lacking, "no library has the material 'a'"));
  CHECK(lacking.materials.at(lacking.materialOf.at(1)).kd == vec3(1, 0, 0));
}

TEST_CASE("colours out of range are clamped and noted") {
  const SceneFolder folder;
  folder.write("a.obj", "mtllib a.mtl\nusemtl m\n" + triangle);
  folder.write("a.mtl", "newmtl m\nKd 1.5 -1 0.5\nKe -1 2 3\n");
  const Scene scene = loadScene(folder.file("a.obj"));
  CHECK(scene.materials.at(0).kd == vec3(1, 0, 0.5f));
  CHECK(scene.materials.at(0).ke == vec3(0, 2, 3));
  CHECK(hasNote(scene, "a.mtl:2: clamped Kd of 'm' to 0 … 1"));
  CHECK(hasNote(scene, "a.mtl:3: clamped Ke of 'm'"));
}

TEST_CASE("faces of fewer than three corners are left out and counted") {
  const Scene scene = loadText(triangle + "f 1 2\nf 3\nf\nf 1 2 # 3\nf 3 2 1\n");
  CHECK(scene.triangles.size() == 2);
  CHECK(hasNote(scene, "a.obj: ignored 4 faces with fewer than three corners"));
  CHECK_THAT(errorOfText(triangle + "f 1 x\n"), StartsWith("a.obj:5: invalid corner 'x'"));
  // Where the file ends within it, it was cut.
  CHECK_THAT(errorOfText(triangle + "f 1 2"), Equals("a.obj:5: face: expected at least three corners, got 2"));
}

TEST_CASE("a broken line of an OBJ is an error with its line") {
  CHECK_THAT(errorOfText("# a\nv 0 0\n"), Equals("a.obj:2: vertex: expected three numbers, got 2"));
  CHECK_THAT(errorOfText("v 0 0 zero\n"), Equals("a.obj:1: 'zero' is not a number"));
  CHECK_THAT(errorOfText("v 0 0 1x\n"), Equals("a.obj:1: '1x' is not a number"));
  CHECK_THAT(errorOfText("v\n"), StartsWith("a.obj:1: vertex: expected three numbers"));
  CHECK_THAT(errorOfText("v 0 0 +-1\n"), Equals("a.obj:1: '+-1' is not a number"));
  CHECK_THAT(errorOfText(triangle + "f 1 2 +-3\n"), StartsWith("a.obj:5: invalid corner '+-3'"));
  CHECK_THAT(errorOfText(triangle + "f 1\v2 3 1\n"), StartsWith("a.obj:5: "));
  CHECK_THAT(errorOfText(triangle + "f 1 2 3/x\n"), StartsWith("a.obj:5: invalid corner '3/x'"));
  CHECK_THAT(errorOfText(triangle + "f 1 2 3/1/1/1\n"), StartsWith("a.obj:5: invalid corner '3/1/1/1'"));
  CHECK_THAT(errorOfText(triangle + "vt\n"), StartsWith("a.obj:5: texture coordinates"));
  CHECK_THAT(errorOfText(triangle + "v 0 0 \\\n 0\r\nv 1\r\n"), StartsWith("a.obj:7: vertex"));
  CHECK_THAT(errorOfText(std::string("v 0 0 0\nv \0 0 0\n", 16)), StartsWith("a.obj:2: a NUL byte"));
}

TEST_CASE("an index out of range is an error with its line") {
  CHECK_THAT(errorOfText(triangle + "f 1 2 0\n"), StartsWith("a.obj:5: index 0 in '0'"));
  CHECK_THAT(errorOfText(triangle + "f 1 2 4\nf 1 2 9\n"),
             Equals("a.obj:5: vertex index 4 is out of range: the file has 3"));
  CHECK_THAT(errorOfText("f 1 2 3\nf 1 2 5\nf 1 2 4\n" + triangle), StartsWith("a.obj:2: vertex index 5 is out"));
  CHECK_THAT(errorOfText(triangle + "f -1 -2 -4\n"), StartsWith("a.obj:5: vertex index -4 reaches back"));
  CHECK_THAT(errorOfText("f -1 -1 -1\n" + triangle), StartsWith("a.obj:1: vertex index -1 reaches back"));
  CHECK_THAT(errorOfText(triangle + "f 1 2 4294967297\n"), StartsWith("a.obj:5: index 4294967297 is out of range"));
  CHECK_THAT(errorOfText(triangle + "f 1 2 99999999999999999999\n"),
             StartsWith("a.obj:5: invalid corner '99999999999999999999'"));
  CHECK_THAT(errorOfText(triangle + "f 1 2 -9223372036854775808\n"), Contains("is out of range"));
}

TEST_CASE("an index of a normal or a texture coordinate that nothing reads is a note") {
  const auto noteOf = [](const std::string& faces, const std::string& note) {
    const Scene scene = loadText("v 0 0 0\nv 1 0 0\nv 0 1 0\n" + faces);
    INFO(faces);
    CHECK(scene.triangles == std::vector<uvec3>{{0, 1, 2}});
    CHECK(hasNote(scene, note));
    return scene;
  };
  noteOf("vt 0 0\nvn 0 0 1\nf 1/1/0 2/1/1 3/1/1\n", "a.obj: ignored 1 normal indices that are 0 or no number");
  noteOf("vn 0 0 1\nf 1//x 2//1.5 3//0\n", "ignored 3 normal indices that are 0 or no number");
  noteOf("vn 0 0 1\nf 1//1 2//7 3//1\n", "ignored normal indices out of range, up to 7: the file has 1");
  noteOf("f 1//-1 2//-2 3//99999999999999999999\n", "ignored 1 normal indices that are 0 or no number");
  noteOf("f 1//-1 2//-2 3//-9223372036854775808\n", "ignored normal indices out of range");
  noteOf("vn 0 0 1\nf 1/0/1 2/0/1 3/0/1\n", "ignored 3 texture coordinate indices of 0");
  noteOf("vn 0 0 1\nvn 0 0 1\nvn 0 0 1\nf 1/1 2/2 3/3\n",
         "ignored 3 texture coordinate indices out of range: the file has 0");
  noteOf("f 1/-1 2/-2 3/-3\n", "ignored 3 texture coordinate indices out of range");
  const Scene some = noteOf("vt 0.5 0.5\nf 1/1 2/2 3/0\n", "ignored 1 texture coordinate indices out of range");
  REQUIRE(some.uvTriangles.size() == 1);
  CHECK(some.uvs.at(some.uvTriangles[0].x) == vec2(0.5f));
  CHECK(some.uvs.at(some.uvTriangles[0].y) == vec2(0));
  CHECK(some.uvs.at(some.uvTriangles[0].z) == vec2(0));
  const Scene good = loadText("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1/1/1 2/1/1 3/-1/-1\nvt 0 0\nvn 0 0 1\nf 1 2 3\n");
  CHECK(hasNote(good, "ignored 1 texture coordinate indices"));
  CHECK_FALSE(hasNote(good, "ignored normal"));
}

TEST_CASE("a # within a word begins no comment, so that a face keeps its corners") {
  const Scene scene = loadText("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 9 9 9\nf 1/1/1#x 2 3\nf 4 2 1 # f 3\n");
  CHECK(scene.triangles == std::vector<uvec3>{{0, 1, 2}, {3, 1, 0}});
  CHECK(hasNote(scene, "ignored 1 normal indices that are 0 or no number"));
}

TEST_CASE("an index of a texture coordinate that a texture is looked up by is an error where it is out of range") {
  const SceneFolder folder;
  folder.write("a.mtl", "newmtl m\nmap_Kd a.png\n");
  const auto error = [&](const std::string& faces) {
    return errorOf(folder.write("a.obj", "mtllib a.mtl\nusemtl m\n" + triangle + faces));
  };
  CHECK_THAT(error("vt 0 0\nf 1/1 2/1 3/2\n"), StartsWith("a.obj:8: texture coordinate index 2 is out of range"));
  CHECK_THAT(error("vt 0 0\nf 1/1 2/1 3/-2\n"), StartsWith("a.obj:8: texture coordinate index -2 reaches back"));
  CHECK_THAT(error("f 1/1 2/1 3/2\n"), Equals(""));
}

TEST_CASE("a face that crosses itself is noted") {
  const std::string corners = "v 0 0 0\nv 3 3 0\nv 3 0 0\nv 0 2 0\nv -1 1 0\n";
  CHECK(
      hasNote(loadText(corners + "f 1 2 3 4\n"), "a.obj: cut 1 face that crosses itself into triangles that overlap"));
  CHECK(hasNote(loadText(corners + "f 1 2 3 4\nf 1 2 3 4 5\n"), "a.obj: cut 2 faces that cross themselves"));
  CHECK_FALSE(hasNote(loadText(corners + "f 1 3 2 4\n"), "cross"));
}

TEST_CASE("what is not there, not a file, empty or no mesh is an error") {
  const SceneFolder folder;
  CHECK_THAT(errorOf(folder.file("a.obj")), Equals("a.obj: no such file"));
  std::filesystem::create_directory(folder.file("b.obj"));
  CHECK_THAT(errorOf(folder.file("b.obj")), Equals("b.obj: is a directory, not a file"));
  CHECK_THAT(errorOf(folder.write("c.obj", "")), Equals("c.obj: the file is empty"));
  CHECK_THAT(errorOf(folder.write("d.obj", "hello\n")), StartsWith("d.obj: no vertices"));
  CHECK_THAT(errorOf(folder.write("e.stl", "solid")),
             StartsWith("e.stl: unsupported scene format '.stl' (expected .toml, .obj or .ply)"));
  CHECK_THAT(errorOf("/dev/null/x.obj"), Contains("no such file"));
}

TEST_CASE("a bare mesh gets a camera that frames it and a white sky, and says so") {
  const Scene scene = loadText("v 10 0 0\nv 14 0 0\nv 10 3 0\nf 1 2 3\n");
  REQUIRE(scene.sky);
  CHECK(scene.sky->radiance == vec3(1));
  CHECK(hasNote(scene, "white sky"));
  CHECK(hasNote(scene, "using a camera that frames the scene"));
  REQUIRE(scene.cameras.size() == 1);
  const Camera& camera = scene.cameras[0];
  CHECK(camera.at == vec3(12, 1.5f, 0));
  // Every corner within the cone of the field of view.
  const vec3 forward = glm::normalize(camera.at - camera.eye);
  for (const vec3& p : scene.positions)
    CHECK(glm::dot(glm::normalize(p - camera.eye), forward) > std::cos(camera.vfov / 2 * M_PI / 180));
  const Camera far = loadText("v 1e9 0 0\nf 1 1 1\n").cameras.at(0);
  CHECK(far.eye != far.at);
}

TEST_CASE("a bare mesh is framed wherever it is and however small") {
  const auto text = [](double x, double y, double z, double size) {
    std::string all;
    for (const int corner : {0, 1, 2})
      all += fmt::format("v {} {} {}\n", x + (corner == 1 ? size : 0), y + (corner == 2 ? size : 0), z);
    return all + "f 1 2 3\n";
  };
  const auto distanceOf = [](const Scene& scene) {
    return glm::distance(glm::dvec3(scene.cameras.at(0).eye), glm::dvec3(scene.cameras.at(0).at));
  };
  const double expected = std::sqrt(0.5) / std::sin(M_PI / 8);  // For legs of 1.
  const double cases[][4] = {{500'000, 200, 4'649'776, 100},
                             {1e4, 1e4, 1e4, 1},
                             {0, 0, 0, 1e-10},
                             {1e-7, 0, 0, 1e-10},
                             {0, 0, 0, 1e11},
                             {1e6, 0, 0, 1},
                             {1e6, 0, 0, 1e-6}};
  for (const auto& c : cases) {
    const Scene scene = loadText(text(c[0], c[1], c[2], c[3]));
    INFO(c[0] << " " << c[1] << " " << c[2] << " size " << c[3]);
    CHECK(distanceOf(scene) / c[3] == Approx(expected).epsilon(0.02));
  }
  const Scene point = loadText("v 0 0 0\nf 1 1 1\n");
  CHECK(distanceOf(point) > 0);
}

TEST_CASE("a byte order mark before an OBJ, an MTL, instances or a TOML is skipped") {
  const std::string mark = "\xef\xbb\xbf";
  const SceneFolder folder;
  folder.write("a.mtl", mark + "newmtl m\nKd 1 0 0\n");
  folder.write("a.obj", mark + "v 0 0 0\nv 1 0 0\nv 0 1 0\nmtllib a.mtl\no one\nusemtl m\nf 1 2 3\n");
  folder.write("i.txt", mark + "one - 1 0 0 5 0 1 0 0 0 0 1 0\n");
  const Scene bare = loadScene(folder.file("a.obj"));
  CHECK(bare.triangles.size() == 1);
  CHECK(bare.materials.at(0).kd == vec3(1, 0, 0));
  const Scene placed = loadScene(folder.write("s.toml", mark + "[[mesh]]\nfile = 'a.obj'\ninstances = 'i.txt'\n"));
  CHECK(placed.bounds().hi.x == 6);
}

TEST_CASE("an OBJ whose last line has no end loads with a note") {
  CHECK(hasNote(loadText("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3"), "a.obj: the last line has no end"));
  for (const std::string end : {"\n", "\r\n", "\r", "\n \t"})
    CHECK_FALSE(hasNote(loadText("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3" + end), "no end"));
}

TEST_CASE("triangles beyond 1e12 are dropped as too far away, before and after they are placed") {
  for (const std::string far : {"1.01e12 0 0", "0 -1e18 0", "0 0 1e30", "1e60 0 0", "9e11 9e11 0"}) {
    const Scene scene = loadText("v " + far + "\nv 1 0 0\nv 0 1 0\nv 0 0 0\nv nan 0 0\nf 1 2 3\nf 2 3 4\nf 1 5 2\n");
    INFO(far);
    CHECK(scene.triangles.size() == 1);
    CHECK(hasNote(scene, "dropped 1 triangle with a vertex that is farther than 1e+12 from the origin"));
    CHECK(hasNote(scene, "dropped 1 triangle with a vertex that is not finite"));
  }
  CHECK(loadText("v 1e12 0 0\nv 0 0 0\nv 0 1e12 0\nf 1 2 3\n").triangles.size() == 1);
  const SceneFolder folder;
  folder.write("a.obj", "v 1e10 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
  for (const std::string scale : {"1e3", "1e30", "-1e29"}) {
    const Scene scene = loadScene(folder.write("s.toml", "[[mesh]]\nfile = 'a.obj'\nscale = " + scale + "\n"));
    INFO(scale);
    CHECK(scene.triangles.empty());
    CHECK(hasNote(scene, "farther than 1e+12"));
    CHECK_FALSE(hasNote(scene, "not finite"));
  }
  folder.write("i.txt", "ALL - 1e30 0 0 0 0 1 0 0 0 0 1 0\n");
  CHECK(hasNote(loadScene(folder.write("s.toml", "[[mesh]]\nfile = 'a.obj'\ninstances = 'i.txt'\n")), "farther than"));
  folder.write("a.obj", "v 1e20 0 0\nv 0 0 0\nv 0 1e20 0\nf 1 2 3\n");
  const std::string shrunk = "[[mesh]]\nfile = 'a.obj'\nscale = 1e-20\n";
  CHECK(loadScene(folder.write("s.toml", shrunk)).triangles.size() == 1);
}

TEST_CASE("any line of an OBJ but a comment goes on after a backslash") {
  const SceneFolder folder;
  folder.write("a.mtl", "newmtl red\nKd 1 \\\n0 0\n");
  folder.write("b.mtl", "newmtl blue\nKd 0 0 1\n");
  const Scene scene =
      loadScene(folder.write("a.obj",
                             "mtllib a.mtl \\\nb.mtl\nv 0 0 \\\n0\n"
                             "v 1 0 0\nv 0 1 0 # C:\\\nv 0 0 1\n# C:\\\nusemtl \\\r\nblue\nf 1 2 \\\n\t3\n"
                             "usemtl red\nf 1 2 \\\n3 \\\n4\n"));
  REQUIRE(scene.triangles.size() == 3);
  REQUIRE(scene.positions.size() == 4);
  CHECK(scene.materials.at(scene.materialOf[0]).kd == vec3(0, 0, 1));
  CHECK(scene.materials.at(scene.materialOf[1]).kd == vec3(1, 0, 0));
}
