// Textures and PNG from outside: a build with OpenImageIO, and one without.
#include "tests/support/catch.h"
#include "tests/support/devices.h"
#include "tests/support/files.h"
#include "tests/support/program.h"
#include "tests/support/small_scene.h"
#include "tracer/image/image_io.h"

using namespace copse;
using namespace copse::test;

namespace {

/// A PNG of one pixel, sRGB (255, 0, 0).
constexpr std::string_view redPng(
    "\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\0\0\1\0\0\0\1\x08\2\0\0\0\x90wS\xde\0\0\0\x0cIDATx\xda"
    "c\xf8\xcf\xc0\0\0\3\1\1\0\xf7\3"
    "A"
    "C\0\0\0\0IEND\xae"
    "B`\x82",
    69);

const char* const noPng = "cannot write PNG: this build does not support OpenImageIO";

Ran render(const Folder& folder, const std::string& scene, std::vector<std::string> more = {}) {
  std::vector<std::string> arguments{"render", scene, "--size", "24x16", "--spp", "4", "--device", deviceOption()};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return runCopse(folder / "", arguments);
}

vec3 meanOf(const std::string& exr) {
  const Image image = readExr(exr);
  vec3 sum(0);
  for (const vec3& pixel : image.pixels) sum += pixel / static_cast<float>(image.pixels.size());
  return sum;
}

/// A floor of material `Kd 0 1 0` and `texture` under a white sky, seen from above.
void putFloor(const Folder& folder, const std::string& texture, const std::string& sky = "radiance = [1, 1, 1]") {
  putBytes(folder / "floor.mtl", "newmtl floor\nKd 0 1 0\n" + (texture.empty() ? "" : "map_Kd " + texture + "\n"));
  putBytes(folder / "floor.obj",
           "mtllib floor.mtl\nv -9 0 -9\nv 9 0 -9\nv 9 0 9\nv -9 0 9\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
           "usemtl floor\nf 1/1 2/2 3/3 4/4\n");
  putBytes(folder / "floor.toml", "name = \"floor\"\n[[mesh]]\nfile = \"floor.obj\"\n[[light]]\nkind = \"sky\"\n" +
                                      sky +
                                      "\n[[view]]\nname = \"v\"\neye = [0, 3, 0]\nat = [0, 0, 0]\nup = [0, 0, 1]\n"
                                      "vfov = 45\n");
}

}  // namespace

TEST_CASE("every build renders an EXR with light, one without OpenImageIO says why there is no preview", "[medium]") {
  Folder folder;
  putSmallScene(folder);
  const Ran ran = render(folder, "small.toml");
  INFO(ran.err);
  REQUIRE(ran.status == 0);
  CHECK(meanOf(folder / "out/small.exr").y > 0.01f);
  CHECK(std::filesystem::exists(folder / "out/small.png") == hasOpenImageIO());
  CHECK_THAT(ran.out, Contains("out/small.exr"));
  if (hasOpenImageIO()) {
    CHECK_THAT(ran.out, Contains("out/small.png"));
    CHECK_THAT(ran.err, !Contains("preview"));
  } else {
    CHECK_THAT(ran.out, !Contains(".png"));
    CHECK_THAT(ran.err, Contains("note: no preview is written: this build does not support OpenImageIO"));
    CHECK(render(folder, "small.toml", {"--quiet"}).err.empty());
    CHECK_THAT(render(folder, "small.toml", {"-o", "x.exr"}).err, !Contains("preview"));  // Not asked for.
  }
}

TEST_CASE("The options --preview and --heatmap write PNG files, or are refused before any work by a build that cannot",
          "[medium]") {
  Folder folder;
  putSmallScene(folder);
  const Ran preview = render(folder, "small.toml", {"-o", "x.exr", "--preview", "x.png"});
  if (!hasOpenImageIO()) {
    CHECK(preview.status == 2);
    CHECK_THAT(preview.err, Contains(std::string("error: --preview x.png: ") + noPng));
    CHECK_FALSE(std::filesystem::exists(folder / "x.exr"));
    REQUIRE(render(folder, "small.toml", {"-o", "x.exr"}).status == 0);
  } else {
    CHECK(preview.status == 0);
    CHECK(bytesOf(folder / "x.png").substr(0, 8) == redPng.substr(0, 8));
  }
  const Ran heatmap = runCopse(folder / "", {"compare", "x.exr", "x.exr", "--heatmap", "h.png"});
  CHECK(heatmap.status == (hasOpenImageIO() ? 0 : 2));
  CHECK(std::filesystem::exists(folder / "h.png") == hasOpenImageIO());
  if (!hasOpenImageIO()) CHECK_THAT(heatmap.err, Contains(std::string("error: --heatmap h.png: ") + noPng));
}

TEST_CASE("a PNG texture colours its surface, or costs a note and leaves Kd, an EXR texture does in every build",
          "[medium]") {
  Folder folder;
  putBytes(folder / "red.png", redPng);
  writeExr(folder / "blue.exr", Image{1, 1, {{0, 0, 1}}}, {});
  const auto colourOf = [&](const std::string& texture, std::string* messages = nullptr) {
    putFloor(folder, texture);
    const Ran ran = render(folder, "floor.toml", {"-o", "x.exr", "--max-depth", "1"});
    INFO(ran.err);
    REQUIRE(ran.status == 0);
    if (messages) *messages = ran.err;
    return meanOf(folder / "x.exr");
  };
  const auto is = [](const vec3& a, const vec3& b) { return glm::length(a - b) < 0.02f; };
  std::string messages;
  CHECK(is(colourOf(""), {0, 1, 0}));
  CHECK(is(colourOf("blue.exr", &messages), {0, 0, 1}));
  CHECK(messages.empty());
  const vec3 colour = colourOf("red.png", &messages);
  if (hasOpenImageIO()) {
    CHECK(is(colour, {1, 0, 0}));
    CHECK(messages.empty());
  } else {
    CHECK(is(colour, {0, 1, 0}));
    CHECK_THAT(
        messages,
        Contains("note: ignored 1 texture (only EXR can be read), using Kd instead: this build does not support"));
  }
}

TEST_CASE("a sky in PNG lights the scene, or is an error in a build that cannot read it, one in EXR always lights it",
          "[medium]") {
  Folder folder;
  putBytes(folder / "red.png", redPng);
  writeExr(folder / "blue.exr", Image{2, 1, {{0, 0, 1}, {0, 0, 1}}}, {});
  putFloor(folder, "", "image = \"blue.exr\"");
  REQUIRE(render(folder, "floor.toml", {"-o", "blue-sky.exr", "--view", "v"}).status == 0);
  putFloor(folder, "", "image = \"red.png\"");
  const Ran ran = render(folder, "floor.toml", {"-o", "x.exr"});
  INFO(ran.err);
  CHECK(ran.status == (hasOpenImageIO() ? 0 : 2));
  CHECK(std::filesystem::exists(folder / "x.exr") == hasOpenImageIO());
  if (!hasOpenImageIO()) {
    CHECK_THAT(ran.err, Contains("error: "));
    CHECK_THAT(ran.err, Contains("red.png: cannot read this format (only EXR): this build does not support"));
  }
}
