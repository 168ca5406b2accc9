// Where scenes are: far from the zero of their coordinates, turned from z-up, and under a turned sky.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tests/support/catch.h"
#include "tests/support/scene_files.h"

using namespace copse;
using namespace copse::test;
using glm::dvec3;

namespace {

const dvec3 utm(500'000, 200, 4'649'776);

/// A concave, slightly bent polygon of seven corners, a quad, and three numbers with decimals, about `place`.
std::vector<dvec3> corners(const dvec3& place) {
  std::vector<dvec3> all;
  for (const dvec3& p :
       {dvec3(0, 0, 0), dvec3(4, 0, 0), dvec3(4, 0.125, 3), dvec3(3, 0, 3), dvec3(2, 0, 0.5), dvec3(1, 0, 3),
        dvec3(0, 0, 3), dvec3(0.1, 1.3, 0.7), dvec3(3.3, 1.3, 0.7), dvec3(3.3, 1.9, 2.2), dvec3(0.1, 1.9, 2.2)})
    all.push_back(place + p);
  return all;
}

std::string objOf(const std::vector<dvec3>& points) {
  std::string text;
  for (const dvec3& p : points) text += fmt::format("v {} {} {}\n", p.x, p.y, p.z);
  return text + "f 1 2 3 4 5 6 7\nf 8 9 10 11\n";
}

/// Every vertex is where the file has it, but for one rounding to float of its place in the scene.
void checkPlaces(const Scene& scene, const std::vector<dvec3>& expected) {
  REQUIRE(scene.positions.size() == expected.size());
  for (std::size_t i = 0; i < expected.size(); ++i) CHECK(scene.positions[i] == vec3(expected[i] - scene.origin));
}

std::string plyOf(const std::vector<dvec3>& points, const char* type) {
  std::string text = "ply\nformat binary_little_endian 1.0\n";
  text +=
      fmt::format("element vertex {}\nproperty {} x\nproperty {} y\nproperty {} z\n", points.size(), type, type, type);
  text += "element face 2\nproperty list uchar int vertex_indices\nend_header\n";
  const auto put = [&](const auto& value) { text.append(reinterpret_cast<const char*>(&value), sizeof value); };
  for (const dvec3& p : points)
    for (int k = 0; k < 3; ++k) std::string(type) == "float" ? put(static_cast<float>(p[k])) : put(p[k]);
  put(uint8_t{7});
  for (int i = 0; i < 7; ++i) put(i);
  put(uint8_t{4});
  for (int i = 7; i < 11; ++i) put(i);
  return text;
}

struct Far : SceneFolder {
  Scene load(const std::string& name, const std::string& text, const LoadOptions& options = {}) const {
    return loadScene(write(name, text), options);
  }
};

}  // namespace

TEST_CASE("a scene far from the zero of its coordinates is moved in double, and looks as it would there") {
  const Far folder;
  const Scene near = folder.load("a.obj", objOf(corners(dvec3(0))));
  CHECK(near.origin == dvec3(0));
  for (const dvec3& place : {utm, dvec3(155'000, 0, 463'000), dvec3(-3e9, 0, 0), dvec3(0, 1e10, -70)}) {
    INFO(place.x << " " << place.y << " " << place.z);
    for (const char* name : {"a.obj", "a.ply"}) {
      const Scene far = folder.load(name, name[2] == 'o' ? objOf(corners(place)) : plyOf(corners(place), "double"));
      CHECK(glm::distance(far.origin, place) < 8);
      checkPlaces(far, corners(place));
      CHECK(far.triangles == near.triangles);  // Polygons are cut alike.
      const Camera &here = near.cameras.at(0), &there = far.cameras.at(0);
      CHECK(glm::distance(there.exactEye() + far.origin - place, here.exactEye()) < 1e-5);
      CHECK(glm::distance(there.exactAt() + far.origin - place, here.exactAt()) < 1e-5);
    }
  }
}

TEST_CASE("coordinates that floats hold are moved without rounding") {
  const Far folder;
  const Scene far =
      folder.load("a.obj", "v 499994.125 200 4649770\nv 500006 200.75 4649770.5\nv 500006 200 4649782\nf 1 2 3\n");
  CHECK(dvec3(far.positions.at(0)) + far.origin == dvec3(499'994.125, 200, 4'649'770));
  CHECK(dvec3(far.positions.at(1)) + far.origin == dvec3(500'006, 200.75, 4'649'770.5));
}

TEST_CASE("a scene at most 16 of its sizes from zero stays where it is, to the last bit") {
  const Far folder;
  const auto at = [&](double middle) {
    return folder.load("a.obj", fmt::format("v {} 0.1 0.3\nv {} 0.2 0.7\nv 0 0 0\nv {} 0.7 0.1\nf 1 2 4\n",
                                            middle - 0.5, middle + 0.5, middle));
  };
  const Scene near = at(16);
  CHECK(near.origin == dvec3(0));
  CHECK(near.positions.at(0) == vec3(15.5f, 0.1f, 0.3f));
  const Scene far = at(16.25);
  CHECK(far.origin == dvec3(16, 0, 0));  // Whole powers of two; the vertex at zero belongs to no triangle.
  CHECK(far.positions.at(2) == vec3(0.25f, 0.7f, 0.1f));
  const Scene point = folder.load("a.obj", "v 1e9 2 3\nf 1 1 1\n");
  CHECK(point.origin == dvec3(1e9, 2, 3));
  CHECK(folder.load("a.obj", "v 1e9 2 3\n").origin == dvec3(0));
}

TEST_CASE("transforms and instances place meshes in double") {
  const Far folder;
  folder.write("a.obj", "o all\n" + objOf(corners(dvec3(0))));
  const std::string mesh = "[[mesh]]\nfile = 'a.obj'\n";
  const std::string numbers = "0.1, 0, 0, 500000.3, 0, 0.1, 0, 200.7, 0, 0, -0.1, 4649776.9";
  const auto placed = [&](double size) {
    std::vector<dvec3> all = corners(dvec3(0));
    for (dvec3& p : all)
      p = dvec3(0.1 * size * p.x + 500000.3, 0.1 * size * p.y + 200.7, -0.1 * size * p.z + 4649776.9);
    return all;
  };
  const Scene moved = folder.load("s.toml", mesh + "scale = 0.3\ntransform = [" + numbers + "]\n");
  const double ulp = 0x1p-24;  // Of what is within 1 of the middle.
  const auto lacks = [&](const Scene& scene, const dvec3& place) {
    return std::ranges::none_of(scene.positions,
                                [&](const vec3& p) { return glm::distance(dvec3(p) + scene.origin, place) < ulp; });
  };
  REQUIRE(moved.positions.size() == 11);
  for (const dvec3& place : placed(0.3)) CHECK_FALSE(lacks(moved, place));
  std::string line = "ALL - " + numbers;
  std::erase(line, ',');
  folder.write("i.txt", line);
  const Scene instance = folder.load("s.toml", mesh + "instances = 'i.txt'\n");
  REQUIRE(instance.positions.size() == 11);
  for (const dvec3& place : placed(1)) CHECK_FALSE(lacks(instance, place));
}

TEST_CASE("views and lights keep the coordinates of the files, and those in bounds are the mesh's") {
  const Far folder;
  const auto text = [](const dvec3& p, const std::string& space) {
    const dvec3 q = space.empty() ? p : dvec3(0);
    return fmt::format(
        "[[mesh]]\nfile = 'a.obj'\n[[light]]\nkind = 'quad'\ncorner = [{}, {}, {}]\nedge_u = [1, 0, 0]\n"
        "edge_v = [0, 0, 1]\nradiance = [1, 1, 1]\n{}[[view]]\neye = [{}, {}, {}]\nat = [{}, {}, {}]\n{}",
        q.x + 0.3, q.y + 0.9, q.z + 0.1, space, q.x + 1.1, q.y + 2.3, q.z + 0.7, q.x + 1.2, q.y, q.z, space);
  };
  for (const std::string space : {"", "space = 'bounds'\n"}) {
    INFO(space);
    folder.write("a.obj", objOf(corners(dvec3(0))));
    const Scene near = folder.load("s.toml", text(dvec3(0), space));
    folder.write("a.obj", objOf(corners(utm)));
    const Scene far = folder.load("s.toml", text(utm, space));
    CHECK(far.origin != dvec3(0));
    const dvec3 moved = utm - far.origin;
    CHECK(glm::distance(dvec3(far.quads.at(0).corner), dvec3(near.quads.at(0).corner) + moved) < 2e-6);
    CHECK(far.quads[0].edgeU == near.quads[0].edgeU);
    CHECK(far.quads[0].cornerRest == dvec3(0));
    CHECK(glm::distance(dvec3(far.cameras.at(0).eye), dvec3(near.cameras.at(0).eye) + moved) < 2e-6);
    CHECK(glm::distance(dvec3(far.cameras[0].at), dvec3(near.cameras[0].at) + moved) < 2e-6);
    CHECK(far.cameras[0].eyeRest == dvec3(0));
    CHECK(far.cameras[0].start == 0);
  }
}

TEST_CASE("a view from far away keeps what floats lack, and its rays start near the scene") {
  const Far folder;
  folder.write("a.obj", objOf(corners(dvec3(0))));
  const Scene scene = folder.load("s.toml",
                                  "[[mesh]]\nfile = 'a.obj'\n[[view]]\neye = [2.1, 4000000.7, 1.3]\n"
                                  "at = [2.1, 0, 1.2]\nup = [0, 0, 1]\nvfov = 1e-4\n");
  const Camera& camera = scene.cameras.at(0);
  CHECK(camera.exactEye() == dvec3(2.1, 4000000.7, 1.3));
  CHECK(camera.start < 4000000.7 - 1.9);
  CHECK(camera.start > 4000000.7 - 20);
}

TEST_CASE("float coordinates in a PLY that are coarse beside its edges are noted") {
  const Far folder;
  CHECK(hasNote(folder.load("a.ply", plyOf(corners(utm), "float")), "a.ply: coordinates are 32-bit floats"));
  CHECK_FALSE(hasNote(folder.load("a.ply", plyOf(corners(utm), "double")), "32-bit floats"));
  CHECK_FALSE(hasNote(folder.load("a.ply", plyOf(corners(dvec3(300, 0, 0)), "float")), "32-bit floats"));
}

TEST_CASE("z-up meshes are turned to y-up exactly, before they are scaled and placed") {
  const Far folder;
  const LoadOptions z{UpAxis::z, {}};
  const std::vector<dvec3> given = corners(dvec3(1, 2, 3));
  std::vector<dvec3> turned;
  for (const dvec3& p : given) turned.push_back({p.x, p.z, -p.y});
  checkPlaces(folder.load("a.obj", objOf(given), z), turned);
  checkPlaces(folder.load("a.ply", plyOf(given, "double"), z), turned);
  checkPlaces(folder.load("a.obj", objOf(given)), given);
  const std::string mesh = "[[mesh]]\nfile = 'a.obj'\n", view = "[[view]]\neye = [1, 2, 3]\nat = [0, 0, 0]\n";
  const Scene whole = folder.load("s.toml", mesh + view, z);
  checkPlaces(whole, turned);
  CHECK(whole.cameras.at(0).eye == vec3(1, 2, 3));  // Views are y-up.
  checkPlaces(folder.load("s.toml", mesh + "up = 'z'\n"), turned);
  checkPlaces(folder.load("s.toml", mesh + "up = 'y'\n", z), given);
  for (dvec3& p : turned) p = 2.0 * p + dvec3(0, 5, 0);
  checkPlaces(folder.load("s.toml", mesh + "up = 'z'\nscale = 2\ntransform = [1,0,0,0, 0,1,0,5, 0,0,1,0]\n"), turned);
  // An instance's matrix is in the file's space: up there is z.
  folder.write("i.txt", "ALL - 1 0 0 0 0 1 0 0 0 0 1 5\n");
  turned.clear();
  for (const dvec3& p : given) turned.push_back({p.x, p.z + 5, -p.y});
  const Scene instance = folder.load("s.toml", mesh + "up = 'z'\ninstances = 'i.txt'\n");
  REQUIRE(instance.positions.size() == turned.size());
  for (const dvec3& p : turned) CHECK(std::ranges::count(instance.positions, vec3(p)) == 1);
  const std::string made = "[[mesh]]\ngenerator = 'cornell'\n";
  CHECK(folder.load("s.toml", made, z).positions == folder.load("s.toml", made).positions);
  CHECK_THAT(errorOf(folder.write("s.toml", made + "up = 'z'\n")),
             Equals("s.toml:3: 'up' cannot be used with 'generator'"));
  CHECK_THAT(errorOf(folder.write("s.toml", mesh + "up = 'x'\n")),
             Equals("s.toml:3: 'up': unknown axis 'x' (expected y or z)"));
}

TEST_CASE("a sky's rotation is the file's or the user's, and needs an image") {
  const Far folder;
  folder.write("a.obj", objOf(corners(dvec3(0))));
  folder.write("sky.exr", "");
  const std::string head = "[[mesh]]\nfile = 'a.obj'\n[[light]]\nkind = 'sky'\n", image = "image = 'sky.exr'\n";
  CHECK(folder.load("s.toml", head + image).sky->rotation == 0);
  CHECK(folder.load("s.toml", head + image + "rotation = 30.5\n").sky->rotation == 30.5);
  CHECK(folder.load("s.toml", head + image + "rotation = 30.5\n", {UpAxis::y, -90.0}).sky->rotation == -90);
  CHECK_THAT(errorOf(folder.write("s.toml", head + "radiance = [1, 1, 1]\nrotation = 1\n")),
             Equals("s.toml:6: 'rotation' needs an image to turn"));
  CHECK(
      hasNote(folder.load("s.toml", head + "radiance = [1, 1, 1]\n", {UpAxis::y, 90.0}), "ignored the sky's rotation"));
  const auto turn = [](double rotation) { return SkyLight{vec3(0), "", {}, rotation}.turn(); };
  CHECK(turn(90) == 0.25);
  CHECK(turn(-90) == 0.75);
  CHECK(turn(720) == 0);
}
