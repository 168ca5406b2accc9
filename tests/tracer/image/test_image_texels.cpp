// Files that other programs wrote: bit depths, grey, alpha; and texels as renderers keep them.
#include <Imath/half.h>

#include <cmath>

#include "tests/support/catch.h"
#include "tests/support/files.h"
#include "tests/support/real_meshes.h"
#include "tracer/image/image_io.h"
#include "tracer/scene/colour.h"

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
  if (!hasOpenImageIO()) return skipTest("no OpenImageIO");
  const Folder folder;
  using namespace std::string_view_literals;
  putBytes(folder / "a.tga", tga(2, 2, 24, "\x00\x00\xff\xff\x00\x00\x00\x80\x00\xff\xff\xff"sv));
  const Image image = readImage(folder / "a.tga");
  REQUIRE(image.pixels.size() == 4);
  CHECK(image.at(0, 0) == vec3(1, 0, 0));
  CHECK(image.at(1, 0) == vec3(0, 0, 1));
  CHECK(image.at(0, 1).y == Approx(0.21586).epsilon(1e-4));
  CHECK(image.at(1, 1) == vec3(1, 1, 1));
}

TEST_CASE("Alpha is left out, and the colours under it stay as bright as they are") {
  if (!hasOpenImageIO()) return skipTest("no OpenImageIO");
  const Folder folder;
  using namespace std::string_view_literals;
  putBytes(folder / "a.tga", tga(2, 1, 32, "\x00\x80\xff\x40\xff\xff\xff\x00"sv));
  const Image image = readImage(folder / "a.tga");
  REQUIRE(image.pixels.size() == 2);
  CHECK(image.at(0, 0).x == Approx(1).epsilon(1e-3));
  CHECK(image.at(0, 0).y == Approx(0.21586).epsilon(1e-3));
  CHECK(image.at(1, 0) == vec3(1, 1, 1));
}

TEST_CASE("Textures with alpha are said to be opaque, once with their number") {
  if (!hasOpenImageIO()) return skipTest("no OpenImageIO");
  const Folder folder;
  using namespace std::string_view_literals;
  putBytes(folder / "leaf.tga", tga(2, 1, 32, "\x00\x80\xff\xff\xff\xff\xff\x00"sv));
  putBytes(folder / "bark.tga", tga(2, 1, 32, "\x00\x80\xff\xff\xff\xff\xff\xff"sv));
  putBytes(folder / "moss.tga", tga(1, 1, 32, "\x00\x80\xff\x80"sv));
  const auto notes = [&](const std::vector<std::string>& files) {
    Scene scene;
    for (const std::string& file : files) {
      scene.materials.push_back({.name = file, .texture = static_cast<int>(scene.textures.size())});
      scene.textures.push_back({.file = folder / file, .texels = {}});
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
  if (!hasOpenImageIO()) return skipTest("no OpenImageIO");
  const Folder folder;
  using namespace std::string_view_literals;
  putBytes(folder / "a.tga", tga(2, 1, 8, "\xff\x80"sv));
  const Image image = readImage(folder / "a.tga");
  CHECK(image.at(0, 0) == vec3(1, 1, 1));
  CHECK(image.at(1, 0).x == Approx(0.21586).epsilon(1e-4));
  CHECK(image.at(1, 0).z == image.at(1, 0).x);
}

TEST_CASE("A 16-bit PNG is sRGB as well and a float PFM is linear") {
  if (!hasOpenImageIO()) return skipTest("no OpenImageIO");
  const Folder folder;
  using namespace std::string_view_literals;
  // 1x1, 16-bit RGB: 32896 of 65535 is 128 of 255. Made with Python's zlib.
  putBytes(folder / "a.png",
           "\x89\x50\x4e\x47\x0d\x0a\x1a\x0a\x00\x00\x00\x0d\x49\x48\x44\x52\x00\x00\x00\x01\x00\x00\x00\x01"
           "\x10\x02\x00\x00\x00\xc0\xe7\x8f\x9d\x00\x00\x00\x0f\x49\x44\x41\x54\x78\x9c\x63\x68\x68\xf8\xff"
           "\x9f\x81\x01\x00\x0c\x80\x02\xff\xa2\xe1\xc7\x94\x00\x00\x00\x00\x49\x45\x4e\x44\xae\x42\x60\x82"sv);
  const float texel[3] = {0.5f, 2, 0.25f};
  putBytes(folder / "a.pfm", "PF\n1 1\n-1.0\n" + std::string(reinterpret_cast<const char*>(texel), sizeof texel));
  const Image pfm = readImage(folder / "a.pfm");
  CHECK(pfm.pixels == std::vector<vec3>{{0.5f, 2, 0.25f}});
  const Image png = readImage(folder / "a.png");
  CHECK(png.pixels[0].x == Approx(0.21586).epsilon(1e-4));
  CHECK(png.pixels[0].y == 1);
  CHECK(png.pixels[0].z == 0);
}

TEST_CASE("8-bit texels are kept as they are, and are the light that their file is, to the last bit") {
  if (!hasOpenImageIO()) return skipTest("no OpenImageIO");
  const Folder folder;
  std::string ramp;
  for (int i = 0; i < 256; ++i) ramp.append(3, static_cast<char>(i));
  std::string file = tga(1, 1, 24, ramp);
  file[12] = 0, file[13] = 1;  // 256 wide.
  putBytes(folder / "ramp.tga", file);
  const Image light = readImage(folder / "ramp.tga");
  const Texels screen = readTexels(folder / "ramp.tga"), linear = readTexels(folder / "ramp.tga", true);
  CHECK(screen.format == TexelFormat::srgb8);
  CHECK(linear.format == TexelFormat::linear8);
  CHECK(screen.sizeInBytes() == 4 * 256);
  REQUIRE(light.width == 256);
  for (int i = 0; i < 256; ++i) {
    CHECK(screen.at(i, 0) == light.at(i, 0));
    CHECK(light.at(i, 0) == vec3(linearOfScreen(i * (1 / 255.0f))));
    CHECK(linear.at(i, 0) == vec3(i * (1 / 255.0f)));
  }
  CHECK(screen.at(255, 0) == vec3(1));
}

TEST_CASE("A texture of floats is halves within 0 … 1, each the nearest, those near 0 too") {
  const Texels texels = texelsOf({2, 2, {{0.5f, 2, -1}, vec3(std::nanf("")), {0.1f, 1e-6f, 0x1p-24f}, {1, 0, 6e-5f}}});
  CHECK(texels.format == TexelFormat::half);
  CHECK(texels.sizeInBytes() == 8 * 4);
  CHECK(texels.at(0, 0) == vec3(0.5f, 1, 0));
  CHECK(texels.at(1, 0) == vec3(0));
  CHECK(texels.at(0, 1) == vec3(0x1.998p-4f, 0x1p-20f + 0x1p-24f, 0x1p-24f));  // Halves of 2^-24 or 2^-14 apart.
  CHECK(texels.at(1, 1).x == 1);
  for (uint32_t bits = 0; bits < 0x7c00; ++bits) {
    half value;
    value.setBits(static_cast<uint16_t>(bits));
    REQUIRE(floatOfHalf(bits) == static_cast<float>(value));
  }
}

TEST_CASE("16-bit textures are halves of what their light is, grey is in all channels") {
  if (!hasOpenImageIO()) return skipTest("no OpenImageIO");
  const Folder folder;
  using namespace std::string_view_literals;
  putBytes(folder / "grey.pgm", "P5 2 1 65535 \x80\x80\xff\xff"sv);
  const Image light = readImage(folder / "grey.pgm");
  const Texels texels = readTexels(folder / "grey.pgm");
  CHECK(texels.format == TexelFormat::half);
  CHECK(texels.at(0, 0) == vec3(static_cast<float>(half(light.at(0, 0).x))));
  CHECK(texels.at(1, 0) == vec3(1));
}
