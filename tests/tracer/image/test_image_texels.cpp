// Files that other programs wrote: bit depths, grey, alpha.
#include "tests/support/catch.h"
#include "tests/support/files.h"
#include "tracer/image/image_io.h"

using namespace copse;
using namespace copse::test;

namespace {

/// An uncompressed TGA, whose bytes are easy to write by hand: blue, green, red, alpha.
std::string tga(int width, int height, int bits, std::string_view texels) {
  std::string bytes(18, '\0');
  bytes[2] = bits == 8 ? 3 : 2;
  bytes[12] = static_cast<char>(width);
  bytes[14] = static_cast<char>(height);
  bytes[16] = static_cast<char>(bits);
  bytes[17] = static_cast<char>(0x20 | (bits == 32 ? 8 : 0));  // Rows from the top.
  return bytes + std::string(texels);
}

}  // namespace

TEST_CASE("8-bit texels are decoded from sRGB, the first row being the top") {
  if (!hasOpenImageIO()) return;
  const Folder folder;
  using namespace std::string_view_literals;
  putBytes(folder / "a.tga", tga(2, 2, 24, "\x00\x00\xff\xff\x00\x00\x00\x80\x00\xff\xff\xff"sv));
  const Image image = readTexture(folder / "a.tga");
  REQUIRE(image.pixels.size() == 4);
  CHECK(image.at(0, 0) == vec3(1, 0, 0));
  CHECK(image.at(1, 0) == vec3(0, 0, 1));
  CHECK(image.at(0, 1).y == Approx(0.21586).epsilon(1e-4));
  CHECK(image.at(1, 1) == vec3(1, 1, 1));
}

TEST_CASE("Alpha is left out, and the colours under it stay as bright as they are") {
  if (!hasOpenImageIO()) return;
  const Folder folder;
  using namespace std::string_view_literals;
  putBytes(folder / "a.tga", tga(2, 1, 32, "\x00\x80\xff\x40\xff\xff\xff\x00"sv));
  const Image image = readTexture(folder / "a.tga");
  REQUIRE(image.pixels.size() == 2);
  CHECK(image.at(0, 0).x == Approx(1).epsilon(1e-3));
  CHECK(image.at(0, 0).y == Approx(0.21586).epsilon(1e-3));
  CHECK(image.at(1, 0) == vec3(1, 1, 1));
}

TEST_CASE("Textures with alpha are said to be opaque, once with their number") {
  if (!hasOpenImageIO()) return;
  const Folder folder;
  using namespace std::string_view_literals;
  putBytes(folder / "leaf.tga", tga(2, 1, 32, "\x00\x80\xff\xff\xff\xff\xff\x00"sv));
  putBytes(folder / "bark.tga", tga(2, 1, 32, "\x00\x80\xff\xff\xff\xff\xff\xff"sv));
  putBytes(folder / "moss.tga", tga(1, 1, 32, "\x00\x80\xff\x80"sv));
  const auto notes = [&](const std::vector<std::string>& files) {
    Scene scene;
    for (const std::string& file : files) {
      scene.materials.push_back({.name = file, .texture = static_cast<int>(scene.textures.size())});
      scene.textures.push_back({.file = folder / file, .image = {}});
    }
    loadTextures(scene);
    return scene.notes;
  };
  CHECK(notes({"bark.tga"}).empty());
  const std::vector<std::string> all = notes({"bark.tga", "leaf.tga", "moss.tga"});
  REQUIRE(all.size() == 1);
  CHECK(all[0] == folder / "leaf.tga" + ": ignored the alpha of this texture; surfaces are opaque (2 in all)");
}

TEST_CASE("A grey texture is grey in all three channels") {
  if (!hasOpenImageIO()) return;
  const Folder folder;
  using namespace std::string_view_literals;
  putBytes(folder / "a.tga", tga(2, 1, 8, "\xff\x80"sv));
  const Image image = readTexture(folder / "a.tga");
  CHECK(image.at(0, 0) == vec3(1, 1, 1));
  CHECK(image.at(1, 0).x == Approx(0.21586).epsilon(1e-4));
  CHECK(image.at(1, 0).z == image.at(1, 0).x);
}

TEST_CASE("A 16-bit PNG is sRGB as well and a float PFM is linear") {
  if (!hasOpenImageIO()) return;
  const Folder folder;
  using namespace std::string_view_literals;
  // 1x1, 16-bit RGB: 32896 of 65535 is 128 of 255. Made with Python's zlib.
  putBytes(folder / "a.png",
           "\x89\x50\x4e\x47\x0d\x0a\x1a\x0a\x00\x00\x00\x0d\x49\x48\x44\x52\x00\x00\x00\x01\x00\x00\x00\x01"
           "\x10\x02\x00\x00\x00\xc0\xe7\x8f\x9d\x00\x00\x00\x0f\x49\x44\x41\x54\x78\x9c\x63\x68\x68\xf8\xff"
           "\x9f\x81\x01\x00\x0c\x80\x02\xff\xa2\xe1\xc7\x94\x00\x00\x00\x00\x49\x45\x4e\x44\xae\x42\x60\x82"sv);
  const float texel[3] = {0.5f, 2, 0.25f};
  putBytes(folder / "a.pfm", "PF\n1 1\n-1.0\n" + std::string(reinterpret_cast<const char*>(texel), sizeof texel));
  const Image pfm = readTexture(folder / "a.pfm");
  CHECK(pfm.pixels == std::vector<vec3>{{0.5f, 2, 0.25f}});
  const Image png = readTexture(folder / "a.png");
  CHECK(png.pixels[0].x == Approx(0.21586).epsilon(1e-4));
  CHECK(png.pixels[0].y == 1);
  CHECK(png.pixels[0].z == 0);
}
