// Which files and which materials are meant by names that were written on another machine.
#include <fmt/format.h>

#include <filesystem>

#include "tests/support/catch.h"
#include "tests/support/scene_files.h"
#include "tracer/scene/io/file_finder.h"

using namespace copse;
using namespace copse::test;

namespace {

const std::string triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nf 1/1 2/1 3/1\n";

vec3 kdOf(const Scene& scene) { return scene.materials.at(scene.materialOf.at(0)).kd; }

}  // namespace

TEST_CASE("a file is found by a name in quotes, of another case or with the folders of another machine") {
  const SceneFolder folder;
  std::filesystem::create_directories(folder.file("Maps/Old Ones"));
  folder.write("Barrel Rust.jpg", "");
  folder.write("Maps/Brick.PNG", "");
  folder.write("Maps/Old Ones/a_b.png", "");
  FileFinder finder(folder.file("a.mtl"));
  const auto check = [&](const std::string& name, const std::string& expected, bool guessed) {
    const std::optional<FoundFile> found = finder.find(name);
    INFO(name);
    REQUIRE(found);
    CHECK(found->path == folder.file(expected));
    CHECK(found->guessed == guessed);
  };
  check("Barrel Rust.jpg", "Barrel Rust.jpg", false);
  check("./Maps\\Brick.PNG", "Maps/Brick.PNG", false);
  check(folder.file("Maps/Brick.PNG"), "Maps/Brick.PNG", false);
  for (const std::string name :
       {"\"Barrel Rust.jpg\"", "'Barrel Rust.jpg'", " \"barrel rust.JPG\" ", "barrel_rust.jpg", "Barrel%20Rust.jpg",
        "D:\\Work Files\\maps\\Barrel Rust.jpg", "/home/ann/Barrel Rust.jpg", "..\\nowhere\\barrel rust.jpg",
        "\\\\server\\share\\Barrel Rust.jpg", "file:///C:/Barrel Rust.jpg"})
    check(name, "Barrel Rust.jpg", true);
  for (const std::string name : {"maps\\brick.png", "MAPS/BRICK.PNG", "C:\\x\\maps\\brick.png", "\"Maps/Brick.PNG\""})
    check(name, "Maps/Brick.PNG", true);
  check("maps/old ones/A B.png", "Maps/Old Ones/a_b.png", true);
  for (const std::string name : {"", " ", "\"\"", "Maps", "Brick.PNG", "Barrel.jpg", "..", "/", "Barrel Rust.jpg/x"})
    CHECK_FALSE(finder.find(name));
  CHECK_FALSE(finder.find(std::string(100'000, '/') + "x"));
  CHECK_FALSE(finder.find(std::string("Barrel Rust.jpg\0", 16)));
}

TEST_CASE("names of libraries that are quoted, of another case, absent, several or blank") {
  const SceneFolder folder;
  std::filesystem::create_directory(folder.file("libs"));
  folder.write("my red.mtl", "newmtl m\nKd 1 0 0\n");
  folder.write("libs/blue.mtl", "newmtl n\nKd 0 0 1\n");
  const auto load = [&](const std::string& lines) {
    return loadScene(folder.write("a.obj", lines + "usemtl m\n" + triangle));
  };
  for (const std::string line : {"my red.mtl", "my red.mtl   ", "my red.mtl # the red ones"}) {
    CHECK(kdOf(load("mtllib " + line + "\n")) == vec3(1, 0, 0));
    CHECK_FALSE(hasNote(load("mtllib " + line + "\n"), "library"));
  }
  for (const std::string line : {"\"my red.mtl\"", "My Red.MTL", "MY_RED.mtl", "C:\\work\\my red.mtl",
                                 "\"none.mtl\" \"my red.mtl\"", "none.mtl my red.mtl", "my red.mtl libs/blue.mtl",
                                 "libs\\blue.mtl \"my red.mtl\"", "LIBS/Blue.mtl my red.mtl"}) {
    const Scene scene = load("mtllib " + line + "\n");
    INFO(line);
    CHECK(kdOf(scene) == vec3(1, 0, 0));
    CHECK(hasNote(scene, "no material library") == (line != "my red.mtl libs/blue.mtl"));
  }
  const Scene gone = load("mtllib old name.mtl\n");
  CHECK(kdOf(gone) == vec3(0.6f));
  CHECK(hasNote(gone, "old name.mtl; its materials are grey"));
  for (const std::string line : {"mtllib\n", "mtllib \n", "mtllib  # none\n"}) {
    CHECK(hasNote(load(line), "a.obj: mtllib without a name"));
    CHECK_FALSE(hasNote(load(line), "directory"));
  }
  CHECK(hasNote(load("mtllib libs\n"), "libs; its materials are grey"));
  CHECK(hasNote(load(""), "a.obj: names materials but no library; using grey"));
  CHECK(hasNote(loadScene(folder.write("b.obj", "mtllib my red.mtl\n" + triangle)),
                "b.obj: names a library but no material; using grey"));
}

TEST_CASE("NAME.mtl beside NAME.obj stands in for a library that is missing or not named") {
  const SceneFolder folder;
  folder.write("House.mtl", "newmtl m\nKd 1 0 0\n");
  folder.write("other.mtl", "newmtl n\nKd 0 0 1\n");
  const auto load = [&](const std::string& lines) { return loadScene(folder.write("house.obj", lines + triangle)); };
  const Scene unnamed = load("usemtl m\n");
  CHECK(kdOf(unnamed) == vec3(1, 0, 0));
  CHECK(hasNote(unnamed, "house.obj: names no library; using " + folder.file("House.mtl")));
  const Scene renamed = load("mtllib old name.mtl\nusemtl m\n");
  CHECK(kdOf(renamed) == vec3(1, 0, 0));
  CHECK(hasNote(renamed, "old name.mtl; using " + folder.file("House.mtl")));
  CHECK(kdOf(load("mtllib other.mtl\nusemtl m\n")) == vec3(0.6f));  // The mesh has a library.
  CHECK_FALSE(hasNote(load(""), "House.mtl"));
}

TEST_CASE("a name that no library has is one that differs in case or quotes, or else grey, counted once a scene") {
  const SceneFolder folder;
  folder.write("a.mtl", "newmtl Red Clay\nKd 1 0 0\nnewmtl red_clay\nKd 0 1 0\n");
  const auto load = [&](const std::string& names) {
    return loadScene(folder.write("a.obj", "mtllib a.mtl\n" + names));
  };
  CHECK(kdOf(load("usemtl Red Clay\n" + triangle)) == vec3(1, 0, 0));
  CHECK(kdOf(load("usemtl red_clay\n" + triangle)) == vec3(0, 1, 0));
  for (const std::string name : {"RED CLAY", "\"Red Clay\"", "Red Clay # of the roof", "red clay"}) {
    const Scene scene = load("usemtl " + name + "\n" + triangle);
    INFO(name);
    CHECK(kdOf(scene) == vec3(1, 0, 0));
    CHECK(hasNote(scene, "'" + name + "'; using 'Red Clay'"));
  }
  const Scene many = load("usemtl x\n" + triangle + "usemtl y\nf 1 2 3\nusemtl z\nf 1 2 3\n");
  CHECK(hasNote(many, "a.obj: no library has the material 'x'; using grey (3 in all)"));
  CHECK_FALSE(hasNote(many, "'y'"));
}

TEST_CASE("usemtl without a name ends a material") {
  const SceneFolder folder;
  folder.write("a.mtl", "newmtl red\nKd 1 0 0\n");
  for (const std::string bare : {"usemtl", "usemtl ", "usemtl\t", "USEMTL"}) {
    const Scene scene =
        loadScene(folder.write("a.obj", "mtllib a.mtl\nusemtl red\n" + triangle + bare + "\nf 1 2 3\n"));
    REQUIRE(scene.materialOf.size() == 2);
    CHECK(kdOf(scene) == vec3(1, 0, 0));
    CHECK(scene.materials.at(scene.materialOf[1]).name == "default");
    CHECK(hasNote(scene, "a.obj: usemtl without a name"));
  }
  folder.write("a.mtl", "newmtl red\nKd 1 0 0\nnewmtl \nKd 0 0 1\n");
  CHECK(loadScene(folder.file("a.obj")).materials.at(1).kd == vec3(0, 0, 1));
}

TEST_CASE("a library that is named for every object is read once, however many materials and lost textures it has") {
  const SceneFolder folder;
  std::string mtl, obj = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  constexpr int count = 3000;
  for (int i = 0; i < count; ++i) {
    mtl += fmt::format("newmtl m{0}\nmap_Kd D:\\maps\\gone {0}.png\n", i);
    obj += fmt::format("mtllib a.mtl\nusemtl m{}\nf 1 2 3\n", i);
    if (i < 1000) folder.write(fmt::format("{}.txt", i), "");
  }
  folder.write("a.mtl", mtl);
  const Scene scene = loadScene(folder.write("a.obj", obj));
  CHECK(scene.materials.size() == count);
  CHECK(scene.textures.size() == count);
}
