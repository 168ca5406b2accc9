// EXR, PNG and textures in and out, and what happens where they cannot be.
#include <sys/resource.h>

#include <cmath>
#include <csignal>
#include <cstring>
#include <functional>
#include <limits>

#include "builder/base/error.h"
#include "builder/base/whole_file.h"
#include "tests/support/catch.h"
#include "tests/support/files.h"
#include "tracer/image/image_io.h"

using namespace copse;
using namespace copse::test;

namespace {

Image gradient(int width, int height) {
  Image image{width, height, {}};
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) image.pixels.push_back({0.1f + x, 1e-5f * y, 1000.0f * std::sin(x + 0.3f * y)});
  return image;
}

std::string errorOf(const std::function<void()>& action) {
  try {
    action();
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

/// The size that a file may grow to, as on a full disk.
struct FileSizeLimit {
  explicit FileSizeLimit(rlim_t bytes) {
    handler = std::signal(SIGXFSZ, SIG_IGN);
    getrlimit(RLIMIT_FSIZE, &before);
    rlimit limit = before;
    limit.rlim_cur = bytes;
    setrlimit(RLIMIT_FSIZE, &limit);
  }
  ~FileSizeLimit() {
    setrlimit(RLIMIT_FSIZE, &before);
    std::signal(SIGXFSZ, handler);
  }
  rlimit before;
  void (*handler)(int);
};

/// One texture and one material that uses it.
Scene sceneWith(const std::vector<std::string>& files) {
  Scene scene;
  for (const std::string& file : files) {
    scene.textures.push_back({.file = file, .texels = {}});
    Material material;
    material.texture = static_cast<int>(scene.materials.size());
    scene.materials.push_back(material);
  }
  return scene;
}

}  // namespace

TEST_CASE("An EXR comes back bit for bit, with its attributes and its rows the same way up") {
  const Folder folder;
  const std::string file = folder / "a.exr";
  Image image = gradient(37, 21);
  image.at(3, 4).x = std::numeric_limits<float>::quiet_NaN();
  image.at(4, 4).y = -std::numeric_limits<float>::infinity();
  writeExr(file, image, {{"copse", "{\"schema\": 1}"}, {"other", ""}});
  CHECK(folder.fileCount() == 1);

  std::map<std::string, std::string> attributes;
  const Image back = readExr(file, &attributes);
  REQUIRE(back.width == 37);
  REQUIRE(back.height == 21);
  CHECK(std::memcmp(back.pixels.data(), image.pixels.data(), image.pixels.size() * sizeof(vec3)) == 0);
  CHECK(attributes == std::map<std::string, std::string>{{"copse", "{\"schema\": 1}"}, {"other", ""}});
}

TEST_CASE("An EXR of a single pixel and one of many megapixels come back") {
  const Folder folder;
  for (const auto& [width, height] : {std::pair{1, 1}, {2048, 1100}}) {
    const Image image = gradient(width, height);
    writeExr(folder / "a.exr", image, {});
    CHECK(readExr(folder / "a.exr").pixels == image.pixels);
  }
}

TEST_CASE("A file that fills the disk on its way leaves the old one and nothing else") {
  const Folder folder;
  const std::string file = folder / "a.exr";
  writeWholeFile(file, "the old one");
  const Image image = gradient(200, 200);
  for (const rlim_t bytes : {0, 10, 400, 4096, 100000}) {
    FileSizeLimit limit(bytes);
    CHECK_THAT(errorOf([&] { writeExr(file, image, {}); }), StartsWith(file + ": ") && Contains("File too large"));
    if (bytes == 10 && hasOpenImageIO()) CHECK_THROWS_AS(writePng(file, image), InputError);
    if (bytes == 10) CHECK_THROWS_AS(writeWholeFile(file, "longer than ten bytes"), InputError);
  }
  CHECK(bytesOf(file) == "the old one");
  CHECK(folder.fileCount() == 1);
}

TEST_CASE("A device is written directly and a full one is an error") {
  CHECK_THAT(errorOf([&] { writeExr("/dev/full", gradient(64, 64), {}); }), Contains("No space left"));
  CHECK_NOTHROW(writeExr("/dev/null", gradient(64, 64), {}));
  CHECK(std::filesystem::is_character_file("/dev/full"));
  CHECK(std::filesystem::is_character_file("/dev/null"));
}

TEST_CASE("Folders that are missing, files as folders and folders as files are named in the error") {
  const Folder folder;
  writeWholeFile(folder / "file", "x");
  const Image image = gradient(4, 4);
  CHECK_THAT(errorOf([&] { writeExr(folder / "no/a.exr", image, {}); }), Contains("No such file or directory"));
  CHECK_THAT(errorOf([&] { writeExr(folder / "file/a.exr", image, {}); }), Contains("Not a directory"));
  CHECK_THAT(errorOf([&] { writeExr(folder / "", image, {}); }), Contains("directory"));
  CHECK_THAT(errorOf([&] { writeExr("/proc/a.exr", image, {}); }), StartsWith("/proc/a.exr: cannot write"));
  CHECK_THAT(errorOf([&] { writeExr("", image, {}); }), Contains("empty file name"));
  CHECK_THAT(errorOf([&] { writeExr(folder / "a.exr", Image{}, {}); }), Contains("0 x 0"));
  CHECK(folder.fileCount() == 1);
}

TEST_CASE("A link is followed, so that the file it names is the one replaced") {
  const Folder folder;
  writeWholeFile(folder / "real.txt", "old");
  std::filesystem::create_symlink("real.txt", folder / "link.txt");
  writeWholeFile(folder / "link.txt", "new");
  CHECK(std::filesystem::is_symlink(folder / "link.txt"));
  CHECK(bytesOf(folder / "real.txt") == "new");
}

TEST_CASE("A link to a file that is not there yet makes that file, and a circle of links is an error") {
  const Folder folder;
  std::filesystem::create_directory(folder / "there");
  std::filesystem::create_symlink("there/second.txt", folder / "first.txt");
  std::filesystem::create_symlink("../new.txt", folder / "there/second.txt");
  writeWholeFile(folder / "first.txt", "new");
  CHECK(std::filesystem::is_symlink(folder / "first.txt"));
  CHECK(std::filesystem::is_symlink(folder / "there/second.txt"));
  CHECK(bytesOf(folder / "new.txt") == "new");
  std::filesystem::create_symlink("nowhere/a.txt", folder / "lost.txt");
  CHECK_THAT(errorOf([&] { writeWholeFile(folder / "lost.txt", "x"); }), Contains("No such file or directory"));
  std::filesystem::create_symlink("circle.txt", folder / "circle.txt");
  CHECK_THAT(errorOf([&] { writeWholeFile(folder / "circle.txt", "x"); }), Contains("symbolic links"));
  CHECK(std::filesystem::is_symlink(folder / "circle.txt"));
}

TEST_CASE("An error of a write that someone swallowed comes back with the commit") {
  const Folder folder;
  {
    FileSizeLimit limit(10);
    WholeFile whole(folder / "a");
    CHECK_THROWS_AS(whole.write("longer than ten bytes"), InputError);
    CHECK_THAT(errorOf([&] { whole.commit(); }), Contains("File too large"));
  }
  CHECK(folder.fileCount() == 0);
}

TEST_CASE("A whole file that is not committed was never there") {
  const Folder folder;
  {
    WholeFile whole(folder / "a");
    whole.write("bytes");
    CHECK(folder.fileCount() == 1);
  }
  CHECK(folder.fileCount() == 0);
}

TEST_CASE("Files that are no EXR, or the start of one, are errors that name the file") {
  const Folder folder;
  const std::string good = folder / "good.exr", bad = folder / "bad.exr";
  writeExr(good, gradient(64, 48), {{"copse", "record"}});
  const std::string bytes = bytesOf(good);
  CHECK_THAT(errorOf([&] { readExr(folder / "none.exr"); }), Contains("none.exr: no such file"));
  CHECK_THAT(errorOf([&] { readExr(folder / ""); }), Contains("is a directory"));
  for (std::size_t length = 0; length < bytes.size(); length += 1 + length / 3) {
    putBytes(bad, bytes.substr(0, length));
    CHECK_THAT(errorOf([&] { readExr(bad); }), StartsWith(bad + ": "));
  }
  putBytes(bad, "P6 1 1 255 abc, which is another format");
  CHECK_THAT(errorOf([&] { readExr(bad); }), StartsWith(bad + ": "));
}

TEST_CASE("A small EXR that claims to be enormous is an error before any memory is taken") {
  const Folder folder;
  writeExr(folder / "a.exr", gradient(64, 48), {});
  std::string bytes = bytesOf(folder / "a.exr");
  const std::size_t window = bytes.find("dataWindow") + 11 + 6 + 4;  // Past its name, "box2i" and its size.
  for (const uint32_t last : {0x7fffffffu, 65535u, 12345u, 0x80000000u}) {
    std::memcpy(&bytes[window + 8], &last, 4);
    std::memcpy(&bytes[window + 12], &last, 4);
    putBytes(folder / "b.exr", bytes);
    CHECK_THAT(errorOf([&] { readExr(folder / "b.exr"); }), Contains("b.exr: "));
  }
}

TEST_CASE("Any byte of an EXR may be wrong without a crash") {
  const Folder folder;
  writeExr(folder / "good.exr", gradient(19, 33), {{"copse", "record"}});
  const std::string bytes = bytesOf(folder / "good.exr"), bad = folder / "bad.exr";
  uint32_t random = 1;
  for (int i = 0; i < 400; ++i) {
    std::string broken = bytes;
    random = random * 1664525 + 1013904223;
    const std::size_t where = i < 200 ? (random >> 8) % 400 : (random >> 8) % bytes.size();  // The header more often.
    broken[where] = static_cast<char>(broken[where] ^ (1 << (random >> 29)));
    putBytes(bad, broken);
    try {
      const Image image = readExr(bad);
      CHECK(image.pixels.size() == static_cast<std::size_t>(image.width) * image.height);
    } catch (const InputError& error) {
      CHECK_THAT(error.what(), StartsWith(bad + ": "));
    }
  }
}

TEST_CASE("A texture that cannot be read costs its colours and a note, not the render") {
  const Folder folder;
  putBytes(folder / "broken.png", "\x89PNG\r\n\x1a\n and then nothing");
  writeExr(folder / "good.exr", Image{1, 1, {{0.5f, -2, 7}}}, {});
  Scene scene = sceneWith({folder / "none.exr", folder / "broken.png", folder / "good.exr"});
  loadTextures(scene);
  CHECK(scene.textures[0].texels == nullptr);
  CHECK(scene.textures[1].texels == nullptr);
  REQUIRE(scene.notes.size() == 2);
  // Without OpenImageIO what is no EXR is left out, which is said first.
  CHECK_THAT(scene.notes[hasOpenImageIO() ? 0 : 1], Contains("none.exr: no such file") && Contains("Kd"));
  REQUIRE(scene.textures[2].texels != nullptr);
  CHECK(scene.textures[2].texels->at(0, 0) == vec3(0.5f, 0, 1));  // Reflectances are in 0 … 1.
}

TEST_CASE("Of many textures that cannot be read some are named and the others counted") {
  const Folder folder;
  std::vector<std::string> files;
  for (int i = 0; i < 1000; ++i) files.push_back(folder / std::to_string(i) + ".exr");
  Scene scene = sceneWith(files);
  loadTextures(scene);
  REQUIRE(scene.notes.size() == 4);
  CHECK_THAT(scene.notes[0], Contains("0.exr: no such file"));
  CHECK(scene.notes[3] == "997 more textures cannot be read; using the materials' Kd instead");
}

TEST_CASE("Textures of the same file are read once and shared") {
  const Folder folder;
  writeExr(folder / "a.exr", gradient(2, 2), {});
  std::filesystem::create_directory(folder / "sub");
  std::filesystem::create_symlink("../a.exr", folder / "sub/link.exr");
  Scene scene = sceneWith({folder / "a.exr", folder / "sub/../a.exr", folder / "sub/link.exr", folder / "a.exr"});
  scene.textures[3].linear = true;  // Read in another way.
  loadTextures(scene);
  CHECK(scene.materials[2].texture == 0);
  CHECK(scene.materials[3].texture == 3);
  CHECK(scene.materials[0].texture == 0);
  CHECK(scene.materials[1].texture == 0);
  CHECK(scene.textures[1].texels == nullptr);
  CHECK(scene.notes.empty());
}

TEST_CASE("A sky that cannot be read is an error, and a wild one is tamed with a note") {
  const Folder folder;
  Scene scene;
  scene.sky = SkyLight{};
  scene.sky->file = folder / "sky.exr";
  CHECK_THROWS_AS(loadTextures(scene), InputError);
  const float infinity = std::numeric_limits<float>::infinity();
  writeExr(folder / "sky.exr", Image{2, 1, {{1, 2, 3}, {-1, infinity, std::nanf("")}}}, {});
  loadTextures(scene);
  CHECK(scene.sky->image.pixels == std::vector<vec3>{{1, 2, 3}, {0, 65504, 0}});
  CHECK(scene.notes.size() == 1);
}

TEST_CASE("A PNG preview is the sRGB curve of the exposed pixels, and reads back as they were") {
  if (!hasOpenImageIO()) {
    CHECK_THAT(errorOf([&] { writePng("/tmp/never.png", gradient(2, 2)); }), Contains("does not support OpenImageIO"));
    return;
  }
  const Folder folder;
  const float nan = std::nanf("");
  const Image image{4,
                    2,
                    {{0, 0.25f, 0.5f},
                     {1, 2, 1e30f},
                     {-1, nan, 0.001f},
                     {0.2f, 0.4f, 0.1f},
                     {0.05f, 0.3f, 0.7f},
                     {0.1f, 0, 0},
                     {0, 0.1f, 0},
                     {0, 0, 0.1f}}};
  writePng(folder / "a.png", image, 1);
  CHECK(folder.fileCount() == 1);
  const Image back = readImage(folder / "a.png");
  REQUIRE(back.width == 4);
  REQUIRE(back.height == 2);
  for (std::size_t i = 0; i < image.pixels.size(); ++i)
    for (int c = 0; c < 3; ++c) {
      const float want = image.pixels[i][c] > 0 ? std::min(1.0f, 2 * image.pixels[i][c]) : 0;
      CHECK(back.pixels[i][c] == Approx(want).margin(0.5 / 255 * 2.3));  // Half a step, where the curve is steepest.
    }
  // Known values of the curve: 0.5 is 188 of 255, which is 0.5029 again.
  CHECK(back.pixels[0][1] == Approx(0.50289).epsilon(1e-4));
}
