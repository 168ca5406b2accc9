// What materials become: keys of any case, what is not shown and said, textures' options, PLYs with textures, and
// materials that a scene gives.
#include <fmt/format.h>

#include "builder/base/text.h"
#include "tests/support/catch.h"
#include "tests/support/scene_files.h"

using namespace copse;
using namespace copse::test;

namespace {

const std::string corners = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\n";
const std::string face = "f 1/1 2/2 3/3\n";

/// A triangle of the material m, whose library is `mtl`.
struct Lit : SceneFolder {
  Lit() {
    write("tile.png", "later");
    write("a.obj", "mtllib a.mtl\n" + corners + "usemtl m\n" + face);
  }
  Scene load(const std::string& mtl) const {
    write("a.mtl", mtl);
    return loadScene(file("a.obj"));
  }
  /// Of a material that begins so.
  Scene loadKeys(const std::string& keys) const { return load("newmtl m\n" + keys + "\n"); }
};

std::size_t noteCount(const Scene& scene) { return scene.notes.size() - 2; }  // A bare mesh has a sky and a view.

vec2 uvOf(const Scene& scene, std::size_t triangle, int corner) {
  return scene.uvs.at(scene.uvTriangles.at(triangle)[corner]);
}

}  // namespace

TEST_CASE("the case of MTL keys and of mtllib and usemtl makes no difference") {
  const Lit folder;
  for (const std::string mtl :
       {"newmtl m\nKd 0 0 1\nKe 1 2 3\nmap_Kd tile.png\n", "NEWMTL m\nKD 0 0 1\nKE 1 2 3\nMAP_KD tile.png\n",
        "Newmtl m\nkd 0 0 1\nke 1 2 3\nmap_KD tile.png\n", "newMtl m\n\tkD\t0 0 1\nkE 1 2 3\nmap_kd tile.png\n"}) {
    const Scene scene = folder.load(mtl);
    INFO(mtl);
    CHECK(noteCount(scene) == 0);
    CHECK(scene.materials.at(0).kd == vec3(0, 0, 1));
    CHECK(scene.materials[0].ke == vec3(1, 2, 3));
    CHECK(scene.textures.at(0).file == folder.file("tile.png"));
  }
  const Scene upper = loadScene(folder.write("b.obj", corners + "MTLLIB a.mtl\nUseMtl m\n" + face));
  CHECK(upper.materials.at(0).kd == vec3(0, 0, 1));
}

TEST_CASE("a line of a library that means nothing is a note, and the material keeps what it has") {
  const Lit folder;
  const auto check = [&](const std::string& mtl, const std::string& note, vec3 kd = vec3(0.6f)) {
    const Scene scene = folder.load(mtl);
    INFO(mtl);
    CHECK(scene.triangles.size() == 1);
    CHECK(noteCount(scene) == 1);
    CHECK(hasNote(scene, note));
    CHECK(scene.materials.at(0).kd == kd);
  };
  check("newmtl m\nKd 1 two 3\n", "a.mtl:2: ignored Kd of 'm': 'two' is not a number");
  check("newmtl m\n\nKd 1 1\n", "a.mtl:3: ignored Kd of 'm': expected three numbers, got 2");
  check("newmtl m\nKd\n", "a.mtl:2: ignored Kd of 'm': expected three numbers, got 0");
  check("newmtl m\nKd 1 0 0\nKd -nan(ind) 1 1\n", "a.mtl:3: ignored Kd of 'm': colour '-nan(ind)' is not finite",
        {1, 0, 0});
  check("newmtl m\nKe inf 0 0\n", "a.mtl:2: ignored Ke of 'm': colour 'inf' is not finite");
  check("newmtl m\nKd spectral a.rfl\n", "a.mtl:2: ignored Kd of 'm': 'spectral' is not supported");
  check("Kd 1 1 1\nnewmtl m\n", "a.mtl:1: ignored Kd before the first newmtl");
  check("newmtl m\nKd 1 0 0\nnewmtl \nKd 0 0 1\n", "a.mtl:3: newmtl without a name", {1, 0, 0});
  check("newmtl m\nmap_Kd \n", "a.mtl:2: ignored map_Kd of 'm': it names no file");
  check("newmtl m\nmap_Kd -s 1 1 1\n", "a.mtl:2: ignored map_Kd of 'm': it names no file");
  check("hello\nnewmtl m\nKd 1 0 0\nMaterial Count: 1\n", "a.mtl:1: ignored unknown MTL keyword 'hello' (2 in all)",
        {1, 0, 0});
  check("newmtl m\nd half\n", "a.mtl:2: ignored d of 'm': expected a number, got 'half'");
  check("", "a.mtl: the file is empty; the materials that it lacks are grey");
  check(std::string("newmtl m\nKd 1 0 0\n\0\1\2\n", 22), "a.mtl:3: a NUL byte", {1, 0, 0});
  CHECK(noteCount(folder.load("# hello\n  # d 0\nnewmtl m # d 0\nKd 1 0 0 # d 0\n#\n\n")) == 1);  // "m # d 0" for m.
}

TEST_CASE("what is wrong with a material that nothing uses is no one's concern") {
  const Lit folder;
  CHECK(noteCount(folder.load("newmtl n\nKd nan nan nan\nmap_d a.png\nd 0.5\nKs 1 1 1\nnewmtl m\nKd 1 0 0\n")) == 0);
}

TEST_CASE("opacity, emission maps, highlights and relief are said once a scene to be ignored, with their number") {
  const Lit folder;
  const auto check = [&](const std::string& keys, const std::string& note) {
    const Scene scene = folder.loadKeys(keys);
    INFO(keys);
    CHECK(noteCount(scene) == 1);
    CHECK(hasNote(scene, note));
    return scene;
  };
  check("map_d tile.png", "a.mtl:2: ignored map_d of 'm', which is opaque");
  check("map_opacity tile.png", "ignored map_opacity of 'm', which is opaque");
  check("d 0", "ignored d 0 of 'm', which is opaque");
  check("d -halo 0.5", "ignored d 0.5 of 'm', which is opaque");
  check("D 0.0\nTr 1.0", "ignored d 0 of 'm', which is opaque");
  check("Tr 0.25", "ignored Tr 0.25 of 'm', which is opaque");
  check("Ks 0.5 0.5 0.5\nmap_Bump tile.png\nNs 10", "a.mtl:3: ignored map_Bump, Ks of 'm': surfaces are diffuse");
  check("Ks 0.5 0.5 0.5\nillum 7", "ignored Ks, illum 7 of 'm': surfaces are diffuse");
  check("Pm 1\nPr 0.1\nnorm tile.png", "a.mtl:2: ignored Pm, norm of 'm': surfaces are diffuse");
  const Scene lamp = check("Ke 1 1 1\nmap_Ke tile.png", "a.mtl:3: ignored map_Ke of 'm', which does not shine");
  CHECK_FALSE(lamp.emits(0));
  CHECK_FALSE(check("map_emissive tile.png\nKe 1 1 1", "ignored map_emissive of 'm', which").emits(0));
  for (const std::string plain :
       {"d 1", "d 1.0\nTr 1.0", "Tr 0", "d 1\nTr 0\nTf 1 1 1\nNi 1.5\nNs 10\nillum 2\nKa 1 1 1", "Ks 0 0 0\nillum 2",
        "Ks 1 1 1\nillum 1", "Pm 0\nPr 0.5"})
    CHECK(noteCount(folder.loadKeys(plain)) == 0);

  folder.write("a.obj", "mtllib a.mtl\n" + corners + "usemtl m\n" + face + "usemtl n\n" + face + "usemtl o\n" + face);
  folder.write("a.mtl", "newmtl m\nmap_d a.png\nnewmtl n\nmap_d b.png\nd 0.5\nnewmtl o\nmap_d c.png\n");
  const Scene scene = loadScene(folder.write("s.toml", "[[mesh]]\nfile = 'a.obj'\n[[mesh]]\nfile = 'a.obj'\n"));
  CHECK(hasNote(scene, "a.mtl:2: ignored map_d of 'm', which is opaque (6 in all)"));
  CHECK(hasNote(scene, "a.mtl:5: ignored d 0.5 of 'n', which is opaque (2 in all)"));
  CHECK(scene.notes.size() == 3);  // With the view.
}

TEST_CASE("a texture is scaled and moved as -s and -o say, wherever they stand") {
  const Lit folder;
  for (const std::string line :
       {"map_Kd -s 4 2 1 -o 0.5 0.25 tile.png", "map_Kd -o 0.5 0.25 0 -s 4 2 1 tile.png",
        "map_Kd tile.png -s 4 2 1 -o 0.5 .25", "map_Kd -S 4. 2e0 -blendu on -O 0.5 0.25 \"tile.png\"",
        "map_Kd -clamp off -s 4 2 1 -o 0.5 0.25 -mm 0 1 tile.png # tiles"}) {
    const Scene scene = folder.loadKeys(line);
    INFO(line);
    CHECK(scene.textures.at(0).file == folder.file("tile.png"));
    CHECK(uvOf(scene, 0, 0) == vec2(0.5f, 0.25f));
    CHECK(uvOf(scene, 0, 1) == vec2(4.5f, 0.25f));
    CHECK(uvOf(scene, 0, 2) == vec2(0.5f, 2.25f));
    CHECK_FALSE(hasNote(scene, "option"));
  }
  CHECK(uvOf(folder.loadKeys("map_Kd -s 3 tile.png"), 0, 1) == vec2(3, 0));
  CHECK(uvOf(folder.loadKeys("map_Kd -s 3 tile.png"), 0, 2) == vec2(0, 1));
  folder.write("8 ball.png", "later");
  const Scene ball = folder.loadKeys("map_Kd -s 2 3 8 ball.png");
  CHECK(ball.textures.at(0).file == folder.file("8 ball.png"));
  CHECK(uvOf(ball, 0, 2) == vec2(0, 3));
  CHECK(uvOf(folder.loadKeys("map_Kd -s 2 8 ball.png"), 0, 2) == vec2(0, 1));
  folder.write("-s 2 2.png", "later");
  CHECK(folder.loadKeys("map_Kd -s 2 2.png").textures.at(0).file == folder.file("2.png"));  // An option, by the format.
}

TEST_CASE("two materials with one texture each place it their own way, though their triangles share corners") {
  const Lit folder;
  folder.write("a.obj", "mtllib a.mtl\n" + corners + "usemtl m\n" + face + "usemtl n\n" + face + "usemtl o\n" + face);
  const Scene scene = folder.load(
      "newmtl m\nmap_Kd tile.png\nnewmtl n\nmap_Kd -s 2 2 2 tile.png\nnewmtl o\nmap_Kd -o 0.5 0.5 tile.png\n");
  CHECK(uvOf(scene, 0, 1) == vec2(1, 0));
  CHECK(uvOf(scene, 1, 1) == vec2(2, 0));
  CHECK(uvOf(scene, 2, 1) == vec2(1.5f, 0.5f));
  CHECK(scene.textures.size() == 1);
}

TEST_CASE("a texture without texture coordinates is said not to be shown") {
  const Lit folder;
  folder.write("a.obj", "mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl m\nf 1 2 3\n");
  CHECK(
      hasNote(folder.loadKeys("map_Kd tile.png"), "'m' has a texture, but the mesh no texture coordinates; using Kd"));
}

TEST_CASE("other options of a texture are noted where they would change the picture") {
  const Lit folder;
  for (const std::string option : {"-clamp on", "-mm 0.5 2", "-t 1 1 1", "-texres 512", "-imfchan l", "-type sphere",
                                   "-boost 3", "-blendu off", "-bm 0.2", "-cc on", "-foo"}) {
    const Scene scene = folder.loadKeys("map_Kd " + option + " tile.png");
    INFO(option);
    CHECK(scene.textures.at(0).file == folder.file("tile.png"));
    CHECK(noteCount(scene) == 1);
    CHECK(hasNote(scene, "a.mtl:2: ignored unsupported texture option " + option + " of 'm'"));
  }
  CHECK(noteCount(folder.loadKeys("map_Kd -t 0 0 0 -bm 1.0 -boost 0 -blendv on -cc off tile.png")) == 0);
}

TEST_CASE("a scene's materials are those of a mesh that names none") {
  const SceneFolder folder;
  folder.write("bare.obj", corners + face);
  folder.write("blank.obj", corners + "usemtl\n" + face);
  folder.write("named.obj", corners + "usemtl lead\n" + face);
  folder.write("bare.ply",
               "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
               "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
  folder.write("gold.mtl", "newmtl gold\nKd 1 0.8 0\n");
  folder.write("two.mtl", "newmtl gold\nKd 1 0.8 0\nnewmtl lead\nKd 0.2 0.2 0.3\n");
  folder.write("i.txt", "ALL lead 1 0 0 0 0 1 0 0 0 0 1 0\n");
  const auto text = [&](const std::string& mesh, const std::string& keys) {
    return folder.write("s.toml", "[[mesh]]\nfile = '" + mesh + "'\n" + keys + "\n");
  };
  const auto kdOf = [](const Scene& scene) { return scene.materials.at(scene.materialOf.at(0)).kd; };
  for (const std::string mesh : {"bare.obj", "blank.obj", "bare.ply"}) {
    INFO(mesh);
    CHECK(kdOf(loadScene(text(mesh, "materials = 'gold.mtl'"))) == vec3(1, 0.8f, 0));
    CHECK(kdOf(loadScene(text(mesh, "materials = 'two.mtl'\nmaterial = 'lead'"))) == vec3(0.2f, 0.2f, 0.3f));
    const Scene undecided = loadScene(text(mesh, "materials = 'two.mtl'"));
    CHECK(kdOf(undecided) == vec3(0.6f));
    CHECK(hasNote(undecided, "s.toml:3: the mesh names no material"));
    const Scene placed = loadScene(text(mesh, "materials = 'two.mtl'\ninstances = 'i.txt'"));
    CHECK(kdOf(placed) == vec3(0.2f, 0.2f, 0.3f));
    CHECK_FALSE(hasNote(placed, "names no material"));
    CHECK_THAT(errorOf(text(mesh, "materials = 'two.mtl'\nmaterial = 'tin'")),
               Equals("s.toml:4: two.mtl has no material 'tin'"));
  }
  CHECK(kdOf(loadScene(text("named.obj", "materials = 'two.mtl'"))) == vec3(0.2f, 0.2f, 0.3f));
  CHECK(hasNote(loadScene(text("named.obj", "materials = 'two.mtl'\nmaterial = 'gold'")), "ignored 'material'"));
  CHECK_THAT(errorOf(text("bare.obj", "material = 'gold'")), Equals("s.toml:3: 'material' needs 'materials'"));
}

TEST_CASE("a PLY's TextureFile is its texture, by coordinates of vertices or of faces' corners") {
  const SceneFolder folder;
  folder.write("skin.png", "later");
  folder.write("Hair.PNG", "later");
  const auto load = [&](const std::string& comments, const std::string& vertex, const std::string& faces,
                        const std::string& values) {
    return loadScene(folder.write(
        "a.ply", "ply\nformat ascii 1.0\n" + comments +
                     "element vertex 4\nproperty float x\nproperty float y\nproperty float z\n" + vertex +
                     "element face 2\nproperty list uchar int vertex_indices\n" + faces + "end_header\n" + values));
  };
  const std::string skin = "comment TextureFile skin.png\n", plain = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n";
  const Scene byVertex = load(skin, "property float s\nproperty float t\n", "",
                              "0 0 0 0 0\n1 0 0 0.5 0\n1 1 0 0.5 1\n0 1 0 0 1\n3 0 1 2\n3 0 2 3\n");
  CHECK(byVertex.textures.at(0).file == folder.file("skin.png"));
  CHECK(byVertex.materials.at(byVertex.materialOf.at(1)).texture == 0);
  CHECK(uvOf(byVertex, 1, 1) == vec2(0.5f, 1));
  CHECK(noteCount(byVertex) == 0);

  const std::string wedges = "property list uchar float texcoord\n";
  const Scene byCorner = load(skin, "", wedges, plain + "4 0 1 2 3 8 0 0 1 0 1 1 0 0.5\n3 0 1 2 6 .1 .2 .3 .4 .5 .6\n");
  REQUIRE(byCorner.triangles.size() == 3);
  CHECK(byCorner.materials.at(0).texture == 0);
  for (std::size_t i = 0; i < 2; ++i)
    for (int k = 0; k < 3; ++k) {
      const vec3 p = byCorner.positions[byCorner.triangles[i][k]];
      CHECK(uvOf(byCorner, i, k) == (p == vec3(0, 1, 0) ? vec2(0, 0.5f) : vec2(p.x, p.y)));
    }
  CHECK(uvOf(byCorner, 2, 2) == vec2(0.5f, 0.6f));
  CHECK(noteCount(byCorner) == 0);

  const Scene two = load(skin + "comment TextureFile hair.png\n", "", wedges + "property int texnumber\n",
                         plain + "3 0 1 2 6 0 0 1 0 1 1 1\n3 0 2 3 6 0 0 1 1 0 1 -1\n");
  CHECK(two.materials.at(two.materialOf.at(0)).name == "hair.png");
  CHECK(two.textures.at(0).file == folder.file("Hair.PNG"));
  CHECK(two.materials.at(two.materialOf.at(1)).texture == -1);
  CHECK(hasNote(two, "Hair.PNG"));

  const Scene facesFirst = loadScene(folder.write(
      "b.ply", "ply\nformat ascii 1.0\n" + skin + "element face 2\nproperty list uchar int vertex_indices\n" + wedges +
                   "element vertex 4\nproperty float x\nproperty float y\nproperty float z\nend_header\n" +
                   "4 0 1 2 3 8 0 0 1 0 1 1 0 0.5\n3 0 1 2 6 .1 .2 .3 .4 .5 .6\n" + plain));
  CHECK(facesFirst.triangles == byCorner.triangles);
  CHECK(facesFirst.uvTriangles == byCorner.uvTriangles);
  CHECK(facesFirst.uvs == byCorner.uvs);

  const Scene none = load(skin, "", "", plain + "3 0 1 2\n3 0 2 3\n");
  CHECK(none.materials.at(0).texture == -1);
  CHECK(hasNote(none, "a.ply: ignored texture skin.png: the mesh has no texture coordinates"));
  const Scene broken = load(skin, "", wedges, plain + "3 0 1 2 6 0 0 1 0 1 1\n3 0 2 3 4 0 0 1 1\n");
  CHECK(uvOf(broken, 1, 2) == vec2(0, 0));
  CHECK(hasNote(broken, "ignored the texture coordinates of 1 faces"));
}

TEST_CASE("colours of vertices and faces are said to be ignored") {
  const SceneFolder folder;
  CHECK(hasNote(loadScene(folder.write("a.obj", "v 0 0 0 1 0 0\nv 1 0 0 1 0 0\nv 0 1 0 1 0 0\nf 1 2 3\n")),
                "a.obj: ignored the colours of 3 vertices"));
  const std::string rgb = "property uchar red\nproperty uchar green\nproperty uchar blue\n";
  const auto ply = [&](const std::string& vertex, const std::string& faces, const std::string& values) {
    return loadScene(folder.write(
        "a.ply", "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n" +
                     vertex + "element face 1\nproperty list uchar int vertex_indices\n" + faces + "end_header\n" +
                     values));
  };
  CHECK(hasNote(ply(rgb, "", "0 0 0 9 9 9\n1 0 0 9 9 9\n0 1 0 9 9 9\n3 0 1 2\n"), "ignored the colours of 3 vertices"));
  CHECK(hasNote(ply("", rgb, "0 0 0\n1 0 0\n0 1 0\n3 0 1 2 9 9 9\n"), "a.ply: ignored the colours of 1 faces"));
}

TEST_CASE("numbers without an exponent, of Fortran and of C are read in meshes and libraries") {
  for (const auto& [word, expected] : {std::pair<std::string, double>{"1.5e", 1.5},
                                       {"1.5E+", 1.5},
                                       {"-2e-", -2},
                                       {"1.5d+1", 15},
                                       {"1.5D0", 1.5},
                                       {"1.5f", 1.5},
                                       {"0x1.8p1", 3},
                                       {"-0X10", -16},
                                       {"+.5", 0.5},
                                       {"5.", 5},
                                       {"1.E1", 10},
                                       {"007", 7}}) {
    double value = 0;
    INFO(word);
    CHECK(parseNumber(word, value));
    CHECK(value == expected);
  }
  double value = 0;
  for (const std::string word : {"e", "d", ".", "+", "f", "1x", "0x", "--1", "1-", "1e1.5", "1,5", "1e+-1", ""})
    CHECK_FALSE(parseNumber(word, value));
  const Lit folder;
  folder.write("a.obj",
               "mtllib a.mtl\nv 0 0 0\nv 2.5D0 0e 0x0\nv 0 1.5f 0 # d\nvt 1e 0x1p-1\nusemtl m\nf 1/1 2/1 3/1\n");
  const Scene scene = folder.loadKeys("Kd 1e 0.5D0 +.25f\nmap_Kd tile.png");
  CHECK(scene.bounds().hi == vec3(2.5f, 1.5f, 0));
  CHECK(uvOf(scene, 0, 0) == vec2(1, 0.5f));
  CHECK(scene.materials.at(0).kd == vec3(1, 0.5f, 0.25f));
}
