// Scene TOML: every key, and every way to get one wrong.
#include <cstdlib>

#include "tests/support/catch.h"
#include "tests/support/scene_files.h"
#include "tracer/generators/generators.h"
#include "tracer/scene/io/assemble.h"

using namespace copse;
using namespace copse::test;

namespace {

/// A folder with one triangle, and scenes beside it.
struct Triangle : SceneFolder {
  Triangle() { write("t.obj", "o one\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl red\nf 1 2 3\n"); }
  Scene load(const std::string& text) const { return loadScene(write("s.toml", text)); }
  std::string error(const std::string& text) const { return errorOf(write("s.toml", text)); }
  /// The error of keys that follow the mesh's file on line 3.
  std::string meshError(const std::string& keys) const { return error(mesh + keys + "\n"); }
  const std::string mesh = "[[mesh]]\nfile = 't.obj'\n";
};

}  // namespace

TEST_CASE("a scene TOML says meshes, lights and views") {
  const Scene scene = loadScene(sceneData("room.toml"));
  CHECK(scene.name == "room");
  CHECK(scene.file == sceneData("room.toml"));
  CHECK(scene.triangles.size() == 9 - 2 + 6);
  CHECK(scene.materials.size() == 3);  // Without the lamp, with the pyramid's grey.
  for (std::size_t i = 0; i < scene.triangles.size(); ++i) CHECK_FALSE(scene.emits(i));
  CHECK(scene.positions.back() == vec3(0.25f, 0.5f, 0));  // The pyramid's tip, halved and then moved.
  CHECK(scene.uvTriangles.size() == scene.triangles.size());
  REQUIRE(scene.quads.size() == 1);
  CHECK(scene.quads[0].corner == vec3(-0.5f, 1.9f, -0.5f));
  CHECK(scene.quads[0].edgeU == vec3(1, 0, 0));
  CHECK(scene.quads[0].edgeV == vec3(0, 0, 1));
  CHECK(scene.quads[0].radiance == vec3(10, 9, 8));
  REQUIRE(scene.sky);
  CHECK(scene.sky->radiance == vec3(0.5f, 0.6f, 0.7f));
  REQUIRE(scene.cameras.size() == 2);
  CHECK(findCamera(scene, "door").eye == vec3(0, 1, 4));
  CHECK(findCamera(scene, "").vfov == 40);
  CHECK(scene.cameras[1].name == "view2");
  CHECK(scene.cameras[1].vfov == 45);
  CHECK(scene.cameras[1].up != vec3(0, 1, 0));
  CHECK(hasNote(scene, "view 'view2' looks along its up vector"));
  CHECK_THROWS_WITH(findCamera(scene, "window"), EndsWith("no view 'window' (available: door, view2)"));
}

TEST_CASE("views and quads may be given in the space of the meshes' bounds") {
  const Triangle folder;
  const std::string rest = "corner = [0.5, 1, 0]\nedge_u = [0.25, 0, 0]\nedge_v = [0, 0, 0.5]\nradiance = [1, 1, 1]\n";
  const auto text = [&](const std::string& space) {
    return folder.mesh + "transform = [4, 0, 0, 10, 0, 2, 0, 20, 0, 0, 1, 30]\n[[light]]\nkind = 'quad'\n" + rest +
           space + "[[view]]\neye = [0, 0.5, -1]\nat = [0.25, 0.5, 0]\nup = [0, 0, 1]\n" + space;
  };
  const Scene scene = folder.load(text("space = 'bounds'\n"));  // From (10, 20, 30) on, 4 wide.
  CHECK(scene.quads.at(0).corner == vec3(12, 24, 30));
  CHECK(scene.quads[0].edgeU == vec3(1, 0, 0));
  CHECK(scene.quads[0].edgeV == vec3(0, 0, 2));
  CHECK(scene.cameras.at(0).eye == vec3(10, 22, 26));
  CHECK(scene.cameras[0].at == vec3(11, 22, 30));
  CHECK(scene.cameras[0].up == vec3(0, 0, 1));
  CHECK(folder.load(text("space = 'world'\n")).cameras.at(0).eye == vec3(0, 0.5f, -1));
  CHECK_THAT(folder.error(text("space = 'unit'\n")), StartsWith("s.toml:10: unknown space 'unit'"));
  folder.write("t.obj", "v 0 0 0\n");  // No triangle: no bounds.
  CHECK(folder.load(text("space = 'bounds'\n")).cameras.size() == 1);
}

TEST_CASE("instances are flattened, with their material or the mesh's own, mirrored ones too") {
  const Scene scene = loadScene(sceneData("room_instances.toml"));
  CHECK(scene.name == "room_instances");
  CHECK(scene.triangles.size() == 9 + 2 + 5 + 2);
  CHECK(doubleArea(scene) == Approx(2 * (7.75 + 4 + 3.5 + 1)));  // The strip follows the back wall: one `o`.
  CHECK(scene.materials[scene.materialOf[9]].name == "spare");
  CHECK(scene.positions[scene.triangles[9].x] == vec3(-1, 2, -1));
  CHECK(scene.materials[scene.materialOf[11]].name == "tiles");
  CHECK(scene.materials[scene.materialOf[16]].name == "white wall");
  CHECK(scene.bounds().hi == vec3(2, 3.8f, 3));
  CHECK(scene.uvTriangles[11] == scene.uvTriangles[4]);
}

TEST_CASE("instance_lines reads the first of them, and materials of a further MTL can be named") {
  const Triangle folder;
  folder.write("more.mtl", "newmtl blue\nKd 0 0 1\n");
  folder.write("i.txt", "# c\nALL - 1 0 0 0 0 1 0 0 0 0 1 0\n\n one blue 1 0 0 5 0 1 0 0 0 0 1 0 # d\r\nALL - x\n");
  const Scene scene = folder.load(folder.mesh + "materials = 'more.mtl'\ninstances = 'i.txt'\ninstance_lines = 2\n");
  CHECK(scene.triangles.size() == 2);
  CHECK(scene.materials.at(scene.materialOf.at(1)).kd == vec3(0, 0, 1));
  CHECK(scene.bounds().hi.x == 6);
  CHECK_THAT(folder.meshError("instances = 'i.txt'"),
             Equals("i.txt:4: the mesh and its libraries have no material 'blue'"));
  CHECK_THAT(folder.meshError("materials = 'more.mtl'\ninstances = 'i.txt'"),
             StartsWith("i.txt:5: 'x' is not a number"));
  const auto instanceError = [&](const std::string& text) {
    folder.write("i.txt", text);
    return folder.meshError("instances = 'i.txt'");
  };
  CHECK_THAT(instanceError("two - 1 0 0 0 0 1 0 0 0 0 1 0\n"), Equals("i.txt:1: the mesh has no object 'two'"));
  CHECK_THAT(instanceError("one - 1 0 0 0 0 1 0 0 0 0 1\n"),
             EndsWith("expected a row-major 3x4 matrix of 12 numbers, got 11"));
  CHECK_THAT(instanceError("one - 1 0 0 0 0 1 0 0 0 0 1 0 1\n"),
             StartsWith("i.txt:1: unexpected '1' after the 12 numbers"));
  CHECK_THAT(instanceError("one - 1 0 0 nan 0 1 0 0 0 0 1 0\n"), StartsWith("i.txt:1: 'nan' is not finite"));
  CHECK_THAT(instanceError("one\n"), StartsWith("i.txt:1: expected object, material"));
  CHECK_THAT(instanceError(""), Equals("i.txt: the file is empty"));
  folder.write("i.txt", "# nothing\n");
  CHECK(folder.load(folder.mesh + "instances = 'i.txt'\n").triangles.empty());
  CHECK_THAT(folder.meshError("instances = 'i.txt'\ninstance_lines = 1"),
             Contains("expected at least 1 instances, got 0"));
}

TEST_CASE("more triangles than 2^31 - 2 are refused before they are made") {
  const Triangle folder;
  std::string text = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf";
  constexpr int corners = 60'000;
  for (int i = 0; i < corners; ++i) text += " " + std::to_string(i % 3 + 1);
  folder.write("t.obj", text + "\n");
  std::string lines;
  for (int i = 0; i < 36'000; ++i) lines += "ALL - 1 0 0 0 0 1 0 0 0 0 1 0\n";
  folder.write("i.txt", lines);
  CHECK_THAT(folder.meshError("instances = 'i.txt'"),
             Contains("2159928000 triangles with 108000 vertices exceed the max"));
}

TEST_CASE("scale comes before transform, and a scene without view or light is told so") {
  const Triangle folder;
  const Scene scene = folder.load(folder.mesh + "scale = 2\ntransform = [0, -1, 0, 5, 1, 0, 0, 6, 0, 0, -1, 7]\n");
  CHECK(scene.positions == std::vector<vec3>{{5, 6, 7}, {5, 8, 7}, {3, 6, 7}});
  CHECK(scene.emitterCount() == 0);
  CHECK(hasNote(scene, "using a camera that frames the scene"));
  CHECK(scene.cameras.size() == 1);
  CHECK_FALSE(scene.sky);
  // A lamp without area shines on nothing.
  folder.write("t.obj", "mtllib t.mtl\nusemtl l\nv 0 0 0\nv 0 0 0\nv 0 1 0\nf 1 2 3\n");
  folder.write("t.mtl", "newmtl l\nKe 1 1 1\n");
  CHECK(folder.load(folder.mesh).emitterCount() == 0);
}

TEST_CASE("lights of radiance 0 are not counted, so that a scene of them alone is told to be black") {
  const Triangle folder;
  const std::string sky = "[[light]]\nkind = 'sky'\nradiance = ";
  const std::string quad =
      "[[light]]\nkind = 'quad'\ncorner = [0, 0, 0]\nedge_u = [1, 0, 0]\nedge_v = [0, 1, 0]\nradiance = ";
  CHECK(folder.load(folder.mesh + sky + "[0, 0, 0]\n" + quad + "[0, 0, 0]\n").emitterCount() == 0);
  CHECK(folder.load(folder.mesh + sky + "[0, 0, 1]\n" + quad + "[0, 1, 0]\n").emitterCount() == 2);
}

TEST_CASE("a sky whose image is loaded and black is no light") {
  Scene scene;
  scene.sky = SkyLight{{0, 0, 0}, "sky.exr", {}};
  CHECK(scene.emitterCount() == 1);
  scene.sky->image = {2, 1, {vec3(0), vec3(0)}};
  CHECK(scene.emitterCount() == 0);
  scene.sky->image.pixels[1].z = 1e-6f;
  CHECK(scene.emitterCount() == 1);
}

TEST_CASE("files are looked for beside the scene and then where COPSE_SCENES says") {
  const Triangle folder, elsewhere;
  elsewhere.write("far.obj", "v 0 0 0\nv 2 0 0\nv 0 1 0\nf 1 2 3\n");
  const KeepScenes keep;
  unsetenv("COPSE_SCENES");
  const std::string text = "[[mesh]]\nfile = 'far.obj'\n";
  CHECK_THAT(folder.error(text), StartsWith("s.toml:2: no file 'far.obj'\n  looked at far.obj"));
  CHECK_THAT(folder.error(text), Contains("COPSE_SCENES, which is not set"));
  setenv("COPSE_SCENES", ("/nowhere::" + elsewhere.file("")).c_str(), 1);
  CHECK(folder.load(text).bounds().hi.x == 2);
  CHECK_THAT(folder.error("[[mesh]]\nfile = 'gone.obj'\n"), Contains("/nowhere/gone.obj"));
  elsewhere.write("t.obj", "v 0 0 0\n");
  CHECK(folder.load(folder.mesh).triangles.size() == 1);
  unsetenv("COPSE_SCENES");
  CHECK(folder.load(std::string("[[mesh]]\nfile = '").append(elsewhere.file("far.obj")) + "'\n").bounds().hi.x == 2);
}

TEST_CASE("a generator gives meshes, and lights and views where the TOML has none") {
  const Triangle folder;
  const std::string cornell = "[[mesh]]\ngenerator = 'cornell'\n";
  const Scene own = findGenerator("cornell").generate(findGenerator("cornell").defaultTriangles, 1);
  const Scene scene = folder.load(cornell);
  CHECK(scene.triangles.size() == own.triangles.size());
  CHECK(scene.cameras.size() == own.cameras.size());
  CHECK(scene.quads.size() == own.quads.size());
  const std::string sky = "[[light]]\nkind = 'sky'\nradiance = [1, 2, 3]\n";
  const Scene lit = folder.load(cornell + sky + "[[view]]\neye = [0, 0, 0]\nat = [0, 0, 1]\n");
  CHECK(lit.quads.empty());
  REQUIRE(lit.sky);
  CHECK(lit.sky->radiance == vec3(1, 2, 3));
  CHECK(lit.cameras.size() == 1);
  CHECK(folder.load("[[mesh]]\ngenerator = 'hairball'\ntriangles = 288_000\nseed = 2\n").triangles.size() == 288'000);
  CHECK_THAT(folder.error("[[mesh]]\ngenerator = 'box'\n"), StartsWith("s.toml:2: "));
  CHECK_THAT(folder.error(cornell + "file = 't.obj'\n"),
             Equals("s.toml:2: [[mesh]] needs either a file or a generator"));
  CHECK_THAT(folder.error(cornell + "instances = 'i.txt'\n"), StartsWith("s.toml:3: 'instances' cannot be used with"));
  CHECK_THAT(folder.error(cornell + "triangles = 0\n"), StartsWith("s.toml:3: 'triangles': expected an integer"));
  CHECK_THAT(folder.error(cornell + "seed = 1.5\n"), StartsWith("s.toml:3: 'seed': expected an integer"));
  CHECK_THAT(folder.error(cornell + "triangles = 3000000000\n"), StartsWith("s.toml:3: 'triangles': expected"));
}

TEST_CASE("a transformed generator keeps its views in place") {
  const Triangle folder;
  const Scene plain = folder.load("[[mesh]]\ngenerator = 'cornell'\n");
  const Scene mirrored =
      folder.load("[[mesh]]\ngenerator = 'cornell'\nscale = 2\ntransform = [-1,0,0,1, 0,1,0,2, 0,0,1,3]\n");
  const auto place = [](const vec3& p) { return vec3(-2 * p.x + 1, 2 * p.y + 2, 2 * p.z + 3); };
  REQUIRE(mirrored.cameras.size() == plain.cameras.size());
  CHECK(glm::distance(mirrored.cameras[0].eye, place(plain.cameras[0].eye)) < 1e-2f);
}

TEST_CASE("a mirrored quad goes on shining to the side that it lit") {
  Scene scene;
  scene.quads.push_back({{1, 2, 3}, {1, 0, 0}, {0, 1, 0}, {1, 1, 1}});  // Shines along +z.
  transform(scene, {{-2, 0, 0, 1, 0, 2, 0, 2, 0, 0, 2, 3}});
  const QuadLight& quad = scene.quads[0];
  CHECK(quad.corner == vec3(-1, 6, 9));
  CHECK(glm::cross(quad.edgeU, quad.edgeV) == vec3(0, 0, 4));
}

TEST_CASE("two meshes with textures each keep their own, and what no triangle uses is gone") {
  const Triangle folder;
  for (const std::string name : {"a", "b"}) {
    folder.write(name + ".mtl", "newmtl spare\nmap_Kd spare.png\nnewmtl m\nmap_Kd " + name + ".png\n");
    folder.write(name + ".obj", "mtllib " + name + ".mtl\nusemtl m\nv 9 9 9\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 2 3 4\n");
  }
  const Scene scene = folder.load("[[mesh]]\nfile = 'a.obj'\n[[mesh]]\nfile = 'b.obj'\n");
  REQUIRE(scene.triangles.size() == 2);
  CHECK(scene.positions.size() == 6);
  REQUIRE(scene.textures.size() == 2);
  for (std::size_t i = 0; i < 2; ++i) {
    const int texture = scene.materials.at(scene.materialOf[i]).texture;
    REQUIRE(texture >= 0);
    CHECK(scene.textures.at(texture).file == folder.file(i == 0 ? "a.png" : "b.png"));
  }
}

TEST_CASE("unknown keys, wrong types and missing keys of a mesh are errors with their line") {
  const Triangle folder;
  CHECK_THAT(folder.error("title = 'x'\n" + folder.mesh),
             StartsWith("s.toml:1: unknown key 'title' in a scene (allowed: name"));
  CHECK_THAT(folder.meshError("colour = 1"), StartsWith("s.toml:3: unknown key 'colour' in [[mesh]]"));
  CHECK_THAT(folder.error(""), Equals("s.toml: the file is empty"));
  CHECK_THAT(folder.error("name = 'x'\n"), Equals("s.toml: a scene needs at least one [[mesh]]"));
  CHECK_THAT(folder.error("name = 1\n" + folder.mesh), Equals("s.toml:1: 'name': expected a string in quotes, got 1"));
  CHECK_THAT(folder.error("\nname = \n" + folder.mesh), StartsWith("s.toml:2: "));
  CHECK_THAT(folder.error("[mesh]\nfile = 't.obj'\n"),
             Equals("s.toml:1: 'mesh': expected tables, written as [[mesh]], got a table"));
  CHECK_THAT(folder.error("mesh = [1]\n"),
             Equals("s.toml:1: 'mesh': expected tables, written as [[mesh]], got an array of 1 value"));
  CHECK_THAT(folder.error("[[mesh]]\n"), Equals("s.toml:1: [[mesh]] needs either a file or a generator"));
  CHECK_THAT(folder.error("[[mesh]]\nfile = ''\n"), StartsWith("s.toml:2: 'file' is empty"));
  CHECK_THAT(folder.error("[[mesh]]\nfile = '.'\n"), Contains("unsupported mesh format ''"));
  CHECK_THAT(folder.error("[[mesh]]\nfile = 's.toml'\n"),
             StartsWith("s.toml: unsupported mesh format '.toml' (expected .obj or .ply)"));
  CHECK_THAT(folder.meshError("scale = 0"), StartsWith("s.toml:3: 'scale': expected a number other than 0"));
  CHECK_THAT(folder.meshError("scale = nan"), StartsWith("s.toml:3: 'scale': expected a finite number"));
  CHECK_THAT(folder.meshError("scale = '1'"), StartsWith("s.toml:3: 'scale': expected a finite number"));
  CHECK_THAT(folder.meshError("transform = [1, 2]"),
             StartsWith("s.toml:3: 'transform': expected an array of 12 numbers"));
  CHECK_THAT(folder.meshError("transform = 1"), StartsWith("s.toml:3: 'transform': expected an array of 12 numbers"));
  const std::string snowmen = "☃☃☃☃☃☃☃☃☃☃☃☃☃☃☃☃☃☃☃☃☃☃☃☃";  // Three bytes each; a long value is cut between two of them.
  CHECK_THAT(folder.meshError("transform = 'a" + snowmen + "'"), EndsWith("got 'a" + snowmen.substr(0, 54) + "…"));
  CHECK_THAT(folder.meshError("transform = [1,0,0,inf,0,1,0,0,0,0,1,0]"), Contains("12 finite numbers"));
  CHECK_THAT(folder.meshError("seed = 1"), StartsWith("s.toml:3: 'seed' cannot be used with 'file'"));
  CHECK_THAT(folder.meshError("instance_lines = 4"), StartsWith("s.toml:3: 'instance_lines' needs 'instances'"));
  CHECK_THAT(folder.meshError("leave_out_materials = 'red'"),
             StartsWith("s.toml:3: 'leave_out_materials': expected an array"));
  CHECK_THAT(folder.meshError("leave_out_materials = [1]"),
             StartsWith("s.toml:3: 'leave_out_materials': expected an array"));
  CHECK_THAT(folder.meshError("leave_out_materials = ['blue']"),
             Equals("s.toml:3: the mesh has no material 'blue' to leave out"));
  CHECK_THAT(folder.meshError("leave_out_materials = ['red']"), Equals(""));
}

TEST_CASE("lights that cannot be are errors with their line") {
  const Triangle folder;
  const auto light = [&](const std::string& keys) { return folder.error("[[light]]\n" + keys + "\n" + folder.mesh); };
  CHECK_THAT(light(""), Equals("s.toml:1: [[light]] lacks the key 'kind'"));
  CHECK_THAT(light("kind = 'lamp'"), StartsWith("s.toml:2: unknown light kind 'lamp'"));
  CHECK_THAT(light("kind = 'sky'"), StartsWith("s.toml:1: a sky needs either radiance or an image"));
  CHECK_THAT(light("kind = 'sky'\nradiance = [1, 1, 1]\nimage = 't.obj'"), Contains("either radiance or an image"));
  CHECK_THAT(light("kind = 'sky'\nimage = 'no.exr'"), StartsWith("s.toml:3: no file 'no.exr'"));
  CHECK_THAT(light("kind = 'sky'\nradiance = [1, 1]"), StartsWith("s.toml:3: 'radiance': expected an array of 3"));
  CHECK_THAT(light("kind = 'sky'\nradiance = [1, 1, -1]"),
             StartsWith("s.toml:3: 'radiance': expected no negative number"));
  CHECK_THAT(light("kind = 'sky'\nradiance = [1, 1, 1]\ncorner = [0, 0, 0]"),
             StartsWith("s.toml:4: unknown key 'corner'"));
  CHECK_THAT(light("kind = 'sky'\nradiance = [1, 1, 1]\n[[light]]\nkind = 'sky'\nradiance = [1, 1, 1]"),
             StartsWith("s.toml:5: a scene can have only one sky"));
  CHECK_THAT(light("kind = 'quad'\ncorner = [0, 0, 0]\nedge_u = [1, 0, 0]\nedge_v = [2, 0, 0]\nradiance = [1, 1, 1]"),
             StartsWith("s.toml:4: the quad has no area"));
  CHECK_THAT(light("kind = 'quad'\ncorner = [0, 0, 0]\nedge_u = [1, 0, 0]"),
             Equals("s.toml:1: a quad light lacks the key 'edge_v'"));
  folder.write("sky.exr", "later");
  CHECK(folder.load("[[light]]\nkind = 'sky'\nimage = 'sky.exr'\n" + folder.mesh).sky->file == folder.file("sky.exr"));
}

TEST_CASE("views that cannot be are errors with their line, and a missing up is made up") {
  const Triangle folder;
  const auto text = [&](const std::string& keys) { return folder.mesh + "[[view]]\n" + keys + "\n"; };
  CHECK_THAT(folder.error(text("eye = [0, 0, 1]")), Equals("s.toml:3: [[view]] lacks the key 'at'"));
  CHECK_THAT(folder.error(text("eye = [0, 0, 1]\nat = [0, 0, 1]")),
             StartsWith("s.toml:4: 'eye' and 'at' are the same"));
  CHECK_THAT(folder.error(text("eye = [0, 0, nan]\nat = [0, 0, 1]")), StartsWith("s.toml:4: 'eye': expected 3 finite"));
  CHECK_THAT(folder.error(text("eye = [0, 0, '0']\nat = [0, 0, 1]")), StartsWith("s.toml:4: 'eye': expected 3 finite"));
  for (const std::string bad : {"0", "180", "-10", "200", "inf"})
    CHECK_THAT(folder.error(text("eye = [0, 0, 1]\nat = [0, 0, 0]\nvfov = " + bad)),
               StartsWith("s.toml:6: 'vfov': expected"));
  CHECK_THAT(folder.error(text("name = 'all'\neye = [0, 0, 1]\nat = [0, 0, 0]")),
             StartsWith("s.toml:4: a view cannot be called"));
  const std::string twice = "name = 'a'\neye = [0, 0, 1]\nat = [0, 0, 0]\n";
  CHECK_THAT(folder.error(text(twice + "[[view]]\n" + twice)), Equals("s.toml:8: duplicate view 'a'"));
  const Scene zero = folder.load(text("eye = [0, 3, 0]\nat = [0, 0, 0]\nup = [0, 0, 0]"));
  CHECK(zero.cameras.at(0).up == vec3(0, 0, 1));
  CHECK(hasNote(zero, "using another up vector"));
  const Camera side = folder.load(text("eye = [3, 0, 0]\nat = [0, 0, 0]\nup = [9, 0, 0]\nvfov = 179.5")).cameras.at(0);
  CHECK(side.up == vec3(0, 1, 0));
}
