// Bad input from outside: each gives its exit status and one clear message, never a crash and never a file.
#include "builder/parallel/device.h"
#include "tests/support/catch.h"
#include "tests/support/devices.h"
#include "tests/support/files.h"
#include "tests/support/program.h"
#include "tests/support/real_meshes.h"
#include "tests/support/small_scene.h"
#include "tracer/image/image_io.h"

using namespace copse;
using namespace copse::test;

namespace {

bool contains(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

/// `copse render SCENE -o x.exr`, small, with `more`.
Ran render(const Folder& folder, const std::string& scene, std::vector<std::string> more = {}) {
  std::vector<std::string> arguments{"render", scene, "-o", "x.exr"};
  if (std::find(more.begin(), more.end(), "--device") == more.end())
    more.insert(more.end(), {"--device", deviceOption()});
  if (std::find(more.begin(), more.end(), "--size") == more.end()) more.insert(more.end(), {"--size", "16x12"});
  if (std::find(more.begin(), more.end(), "--spp") == more.end()) more.insert(more.end(), {"--spp", "1"});
  arguments.insert(arguments.end(), more.begin(), more.end());
  return runCopse(folder / "", arguments);
}

/// The run printed "error: …" with `part` in it, exited with `status` and wrote no image.
void checkRefused(const Folder& folder, const Ran& ran, int status, const std::string& part) {
  INFO(ran.err);
  CHECK(ran.status == status);
  CHECK(contains(ran.err, "error: "));
  CHECK(contains(ran.err, part));
  CHECK(ran.out.empty());
  CHECK_FALSE(std::filesystem::exists(folder / "x.exr"));
}

/// A scene TOML around `mesh` with `rest` after it.
std::string tomlOf(const std::string& mesh, const std::string& rest = "") {
  return "name = \"s\"\n[[mesh]]\nfile = \"" + mesh + "\"\n" + rest +
         "[[view]]\nname = \"v\"\neye = [0, 1, 4]\nat = [0, 1, 0]\nup = [0, 1, 0]\nvfov = 45\n";
}

}  // namespace

TEST_CASE("an extension in capitals is the same format to every command") {
  Folder folder;
  putSmallScene(folder);
  putBytes(folder / "T.TOML", smallToml);
  putBytes(folder / "B.TOML",
           "size = [16, 12]\nspp = [1]\nscenes = [{ file = \"T.TOML\", views = [\"side\"] }]\n"
           "[[builder]]\nname = \"lbvh\"\n");
  const auto succeeds = [&](const std::vector<std::string>& arguments) {
    const Ran ran = runCopse(folder / "", arguments);
    INFO(arguments[0] << ": " << ran.err);
    CHECK(ran.status == 0);
  };
  succeeds({"render", "T.TOML", "-o", "T.EXR", "--size", "16x12", "--spp", "1", "--device", deviceOption(), "--quiet"});
  succeeds({"info", "T.EXR"});
  succeeds({"info", "T.TOML"});
  succeeds({"bench", "B.TOML", "-o", "results", "--device", deviceOption()});
}

TEST_CASE("a scene that cannot be read gives 2 and names the file") {
  Folder folder;
  putSmallScene(folder);
  std::filesystem::create_directory(folder / "folder.obj");
  for (const char* name : {"empty.obj", "empty.ply", "empty.toml", "noending"}) putBytes(folder / name, "");
  for (const char* name : {"nothing.toml", "nothing.obj", "nothing.ply", "folder.obj", "empty.obj", "empty.ply",
                           "empty.toml", "noending"}) {
    checkRefused(folder, render(folder, name), 2, name);
    CHECK(runCopse(folder / "", {"info", name}).status == 2);
    CHECK(runCopse(folder / "", {"build", name}).status == 2);
  }
  putBytes(folder / "lost.toml", tomlOf("nowhere.obj"));
  checkRefused(folder, render(folder, "lost.toml"), 2, "nowhere.obj");
}

TEST_CASE("a truncated or wrong mesh gives 2 and says where") {
  Folder folder;
  putBytes(folder / "cut.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2");
  checkRefused(folder, render(folder, "cut.obj"), 2, "cut.obj");
  putBytes(folder / "range.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n");
  checkRefused(folder, render(folder, "range.obj"), 2, "range.obj:4");
  const std::string header =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
      "element face 1\nproperty list uchar int vertex_indices\nend_header\n";
  putBytes(folder / "cut.ply", header + "0 0 0\n1 0 0\n");
  checkRefused(folder, render(folder, "cut.ply"), 2, "cut.ply");
  putBytes(folder / "head.ply", header.substr(0, 60));
  checkRefused(folder, render(folder, "head.ply"), 2, "head.ply");
}

TEST_CASE("a scene file with an unknown key, a wrong type or no TOML in it gives 2 with its line") {
  Folder folder;
  putSmallScene(folder);
  putBytes(folder / "key.toml", tomlOf("small.obj", "colour = 3\n"));
  checkRefused(folder, render(folder, "key.toml"), 2, "key.toml:4");
  putBytes(folder / "type.toml", tomlOf("small.obj", "scale = \"big\"\n"));
  checkRefused(folder, render(folder, "type.toml"), 2, "type.toml:4");
  putBytes(folder / "syntax.toml", "name = \n[[mesh\n");
  checkRefused(folder, render(folder, "syntax.toml"), 2, "syntax.toml:1");
}

TEST_CASE("no light gives a black image and a warning") {
  Folder folder;
  putBytes(folder / "dark.obj", "v -1 0 0\nv 1 0 0\nv 0 2 0\nf 1 2 3\n");
  putBytes(folder / "dark.toml", tomlOf("dark.obj"));
  const Ran ran = render(folder, "dark.toml", {"--quiet"});
  CHECK(ran.status == 0);
  CHECK(contains(ran.err, "warning: dark.toml: there is no light"));
  for (const vec3& pixel : readExr(folder / "x.exr").pixels) REQUIRE(pixel == vec3(0));
  putBytes(folder / "off.toml", tomlOf("dark.obj") + "[[light]]\nkind = \"sky\"\nradiance = [0, 0, 0]\n");
  CHECK(contains(render(folder, "off.toml", {"--quiet"}).err, "warning: off.toml: there is no light"));
  writeExr(folder / "black.exr", {4, 2, std::vector<vec3>(8, vec3(0))}, {});
  putBytes(folder / "black.toml", tomlOf("dark.obj") + "[[light]]\nkind = \"sky\"\nimage = \"black.exr\"\n");
  CHECK(contains(render(folder, "black.toml", {"--quiet"}).err, "warning: black.toml: there is no light"));
}

TEST_CASE("a view inside a wall renders") {
  Folder folder;
  putSmallScene(folder);
  putBytes(folder / "wall.toml",
           "name = \"s\"\n[[mesh]]\nfile = \"small.obj\"\n[[view]]\nname = \"v\"\neye = [0, 0, 0]\nat = [1, 0, 0]\n"
           "up = [0, 1, 0]\nvfov = 45\n");
  const Ran ran = render(folder, "wall.toml", {"--spp", "4"});
  INFO(ran.err);
  CHECK(ran.status == 0);
  for (const vec3& pixel : readExr(folder / "x.exr").pixels)
    for (int c = 0; c < 3; ++c) REQUIRE((std::isfinite(pixel[c]) && pixel[c] >= 0));
}

TEST_CASE("few triangles, triangles without area and triangles all the same render") {
  Folder folder;
  const std::string vertices = "v -1 0 0\nv 1 0 0\nv 0 2 0\nv 0 0 1\n";
  const std::vector<std::pair<std::string, std::string>> faces{{"one", "f 1 2 3\n"},
                                                               {"two", "f 1 2 3\nf 1 2 4\n"},
                                                               {"three", "f 1 2 3\nf 1 2 4\nf 2 3 4\n"},
                                                               {"flat", "f 1 1 2\nf 1 2 3\nf 3 3 3\n"},
                                                               {"same", [] {
                                                                  std::string text;
                                                                  for (int i = 0; i < 500; ++i) text += "f 1 2 3\n";
                                                                  return text;
                                                                }()}};
  for (const auto& [name, text] : faces)
    for (const char* builder : {"lbvh", "sah"}) {
      putBytes(folder / (name + ".obj"), vertices + text);
      const Ran ran = render(folder, name + ".obj", {"--builder", builder});
      INFO(name << " " << ran.err);
      CHECK(ran.status == 0);
      CHECK(contains(ran.err, "note: "));  // A camera and a sky were made up, and said so.
      const Ran built =
          runCopse(folder / "", {"build", name + ".obj", "--builder", builder, "--device", deviceOption()});
      CHECK(built.status == 0);
    }
}

TEST_CASE("vertices that are no numbers are dropped with a note, the image stays finite") {
  Folder folder;
  putBytes(folder / "nan.obj", "v nan 0 0\nv 1 0 0\nv 0 2 0\nv 0 0 1\nv inf 0 0\nf 1 2 3\nf 2 3 4\nf 5 3 4\n");
  const Ran ran = render(folder, "nan.obj");
  INFO(ran.err);
  REQUIRE(ran.status == 0);
  CHECK(contains(ran.err, "note: nan.obj: "));
  CHECK(contains(ran.err, "dropped"));
  for (const vec3& pixel : readExr(folder / "x.exr").pixels) REQUIRE(std::isfinite(pixel.x + pixel.y + pixel.z));
}

TEST_CASE("sizes, samples and other numbers out of range give 2 and name the option") {
  Folder folder;
  putSmallScene(folder);
  const char* const wrong[] = {"--size 0x0",
                               "--size 9000x10",
                               "--size 99999999999x1",
                               "--size -5x5",
                               "--size 640",
                               "--size 640x480x3",
                               "--spp 0",
                               "--spp -1",
                               "--spp 2.5",
                               "--max-depth -1",
                               "--light-samples 0",
                               "--seed -1",
                               "--seed x",
                               "--threads -1",
                               "--threads 1025",
                               "--threads 99999999999",
                               "--exposure nan",
                               "--device tpu",
                               "--integrator bdpt",
                               "--builder none-such",
                               "--set no.such=1",
                               "--set leaf.max=0",
                               "--set leaf.max=1e9",
                               "--set leaf.max=four",
                               "--set leaf.max",
                               "--set leaf.rule=best",
                               "--colour red"};
  for (const std::string text : wrong) {
    const std::vector<std::string> option{text.substr(0, text.find(' ')), text.substr(text.find(' ') + 1)};
    INFO(text);
    // What --set names is in the message itself; for the others the option is.
    checkRefused(folder, render(folder, "small.toml", option), 2,
                 option[0] == "--set"       ? option[1].substr(0, option[1].find('='))
                 : option[0] == "--device"  ? "tpu"
                 : option[0] == "--builder" ? "none-such"
                                            : option[0]);
  }
}

TEST_CASE("cuda without a device gives 3") {
  Folder folder;
  putSmallScene(folder);
  const Ran devices = runCopse(folder / "", {"list", "devices"});
  if (contains(devices.out, "cuda")) return skipTest("there is a CUDA device");
  checkRefused(folder, runCopse(folder / "", {"render", "small.toml", "-o", "x.exr", "--device", "cuda"}), 3, "CUDA");
  CHECK(runCopse(folder / "", {"build", "small.toml", "--device", "cuda"}).status == 3);
}

TEST_CASE("wrong usage gives 2 and says where to find help") {
  Folder folder;
  putSmallScene(folder);
  CHECK(runCopse(folder / "", {}).status == 2);
  const Ran unknown = runCopse(folder / "", {"paint"});
  CHECK(unknown.status == 2);
  CHECK(contains(unknown.err, "unknown command 'paint' (available: render, build"));
  const Ran without = runCopse(folder / "", {"render"});
  CHECK(without.status == 2);
  CHECK(contains(without.err, "copse render --help"));
  CHECK(runCopse(folder / "", {"render", "a.toml", "b.toml"}).status == 2);
  CHECK(runCopse(folder / "", {"generate", "forest", "-o", "x.obj"}).status == 2);
  CHECK(runCopse(folder / "", {"generate", "cornell"}).status == 2);
  CHECK(runCopse(folder / "", {"generate", "hairball", "--triangles", "0", "-o", "x.obj"}).status == 2);
  CHECK(runCopse(folder / "", {"build", "small.toml", "--repeat", "0"}).status == 2);
}

TEST_CASE("an output that cannot be written is refused before anything is rendered") {
  Folder folder;
  putSmallScene(folder);
  std::filesystem::create_directory(folder / "folder.exr");
  const std::vector<std::string> slow{"render", "small.toml", "--size",   "2048x2048",
                                      "--spp",  "1000",       "--device", deviceOption()};
  auto with = [&](std::vector<std::string> more) {
    more.insert(more.begin(), slow.begin(), slow.end());
    return runCopse(folder / "", more);
  };
  for (const char* output : {"nowhere/x.exr", "folder.exr", "small.toml/x.exr", "/proc/x.exr"})
    checkRefused(folder, with({"-o", output}), 2, output);
  checkRefused(folder, with({"-o", "x.jpg"}), 2, "must end in .exr");
  checkRefused(folder, with({"-o", "x.exr", "--stats", "nowhere/x.json"}), 2, "nowhere/x.json");
  checkRefused(folder, with({"-o", "x.exr", "--preview", "nowhere/x.png"}), 2,
               hasOpenImageIO() ? "nowhere/x.png" : "OpenImageIO");
  putBytes(folder / "out", "in the way");
  checkRefused(folder, with({}), 2, "out");
}

TEST_CASE("more threads than four per processor are not started, and a note says so") {
  Folder folder;
  putSmallScene(folder);
  const Ran ran = render(folder, "small.toml", {"--threads", "1024"});
  CHECK(ran.status == 0);
  const bool fewer = 4 * openDevice("cpu", 0).threads < 1024;
  CHECK(contains(ran.err, "note: --threads 1024: ") == fewer);
  CHECK(render(folder, "small.toml", {"--threads", "1024", "--quiet"}).err.empty());
}

TEST_CASE("threads that the system refuses to start give 3, and fewer of them render", "[medium]") {
  Folder folder;
  putSmallScene(folder);
  // No address space has room for such stacks.
  const std::vector<Limit> limits{{RLIMIT_STACK, 1ull << 47}};
  const auto with = [&](const char* threads, const char* size) {
    return runCopse(folder / "",
                    {"render", "small.toml", "-o", "x.exr", "--size", size, "--spp", "1", "--max-depth", "1",
                     "--device", "cpu", "--threads", threads},
                    limits);
  };
  checkRefused(folder, with("4", "16x12"), 3, "cannot start thread");
  checkRefused(folder, runCopse(folder / "", {"build", "small.toml", "--threads", "4"}, limits), 3,
               "cannot start thread 2 of 4");
  for (const char* size : {"16x12", "2048x1024"}) {  // Threads compress the larger one where they can.
    const Ran ran = with("1", size);
    INFO(ran.err);
    CHECK(ran.status == 0);
    CHECK(readExr(folder / "x.exr").height == (size[0] == '1' ? 12 : 1024));
  }
  const Ran preview =
      runCopse(folder / "",
               {"render", "small.toml", "--size", "8x8", "--spp", "1", "--device", "cpu", "--threads", "1"}, limits);
  CHECK(preview.status == 0);
  CHECK(contains(preview.err, "note: no preview is written"));
  const Ran compared = runCopse(folder / "", {"compare", "x.exr", "x.exr"}, limits);
  CHECK(compared.status == (processorCount() > 1 ? 3 : 0));
}

TEST_CASE("outputs that are the same file as another or as an input are refused", "[medium]") {
  Folder folder;
  putSmallScene(folder);
  const std::string toml = bytesOf(folder / "small.toml");
  std::filesystem::create_directory(folder / "sub");
  std::filesystem::create_symlink("small.toml", folder / "link.json");
  const char* const same = "are the same file";
  checkRefused(folder, render(folder, "small.toml", {"--stats", "x.exr"}), 2, same);
  checkRefused(folder, render(folder, "small.toml", {"--stats", "sub/../x.exr"}), 2, same);
  for (const char* stats : {"small.toml", "./small.toml", "link.json"})
    checkRefused(folder, render(folder, "small.toml", {"--stats", stats}), 2, same);
  if (hasOpenImageIO())
    checkRefused(folder, render(folder, "small.toml", {"--preview", "y.png", "--stats", "y.png"}), 2, same);
  checkRefused(folder, render(folder, "small.toml", {"--view", "all", "--stats", "x.exr"}), 2, same);
  checkRefused(folder, runCopse(folder / "", {"build", "small.toml", "--stats", "small.toml"}), 2, same);
  CHECK(bytesOf(folder / "small.toml") == toml);

  REQUIRE(render(folder, "small.toml").status == 0);
  std::filesystem::rename(folder / "x.exr", folder / "a.exr");
  const std::string image = bytesOf(folder / "a.exr");
  checkRefused(folder, runCopse(folder / "", {"compare", "a.exr", "a.exr", "--stats", "a.exr"}), 2, same);
  CHECK(bytesOf(folder / "a.exr") == image);
  CHECK(runCopse(folder / "", {"compare", "a.exr", "a.exr", "--stats", "d.json"}).status == 0);
}

TEST_CASE("an empty name of a file or a view gives 2") {
  Folder folder;
  putSmallScene(folder);
  for (const char* option : {"-o", "--view", "--preview", "--stats"}) {
    INFO(option);
    const Ran ran = runCopse(
        folder / "", {"render", "small.toml", "--size", "8x8", "--spp", "1", "--device", deviceOption(), option, ""});
    checkRefused(folder, ran, 2, "empty");
    CHECK_FALSE(std::filesystem::exists(folder / "out"));
  }
}
