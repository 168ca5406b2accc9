// EXR files of other programs, written here by OpenEXR itself: layers, parts, tiles, windows, deep pixels.
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfDeepFrameBuffer.h>
#include <OpenEXR/ImfDeepScanLineOutputFile.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfMultiPartOutputFile.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfOutputPart.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfTileDescription.h>
#include <OpenEXR/ImfTiledOutputFile.h>

#include "builder/base/error.h"
#include "tests/support/catch.h"
#include "tests/support/files.h"
#include "tracer/image/exr_layers.h"
#include "tracer/image/image_io.h"

using namespace copse;
using namespace copse::test;

namespace {

const Imath::Box2i square({0, 0}, {15, 15});

/// A half can hold it; another for each channel and pixel.
float valueOf(std::size_t channel, int x, int y) {
  return 0.25f * static_cast<float>(x) + static_cast<float>(y) + 32 * static_cast<float>(channel);
}

/// The values of channels in a data window, and slices of them. Channel i of the names has valueOf(i, …).
struct Pixels {
  Pixels(const Imath::Box2i& window, const std::vector<std::string>& names, Imf::PixelType type = Imf::FLOAT) {
    const int width = window.max.x - window.min.x + 1, height = window.max.y - window.min.y + 1;
    floats.resize(names.size());
    halves.resize(names.size());
    for (std::size_t i = 0; i < names.size(); ++i) {
      for (int y = window.min.y; y <= window.max.y; ++y)
        for (int x = window.min.x; x <= window.max.x; ++x) {
          floats[i].push_back(valueOf(i, x, y));
          halves[i].push_back(half(valueOf(i, x, y)));
        }
      const std::size_t step = type == Imf::HALF ? 2 : 4;
      const void* first = type == Imf::HALF ? static_cast<const void*>(halves[i].data()) : floats[i].data();
      buffer.insert(names[i], Imf::Slice::Make(type, first, window, step, step * static_cast<std::size_t>(width)));
    }
    lines = height;
  }
  Imf::FrameBuffer buffer;
  int lines = 0;
  std::vector<std::vector<float>> floats;
  std::vector<std::vector<half>> halves;
};

Imf::Header headerOf(const Imath::Box2i& display, const Imath::Box2i& data, const std::vector<std::string>& names,
                     Imf::PixelType type = Imf::FLOAT) {
  Imf::Header header(display, data);
  for (const std::string& name : names) header.channels().insert(name, Imf::Channel(type));
  return header;
}

void put(const std::string& file, const std::vector<std::string>& names, Imf::PixelType type = Imf::FLOAT,
         const Imath::Box2i& data = square, const Imath::Box2i& display = square) {
  Imf::OutputFile output(file.c_str(), headerOf(display, data, names, type));
  const Pixels pixels(data, names, type);
  output.setFrameBuffer(pixels.buffer);
  output.writePixels(pixels.lines);
}

struct Part {
  std::string name;
  std::vector<std::string> channels;
};

void putParts(const std::string& file, const std::vector<Part>& parts) {
  std::vector<Imf::Header> headers;
  for (const Part& part : parts) {
    headers.push_back(headerOf(square, square, part.channels));
    headers.back().setName(part.name);
    headers.back().setType(Imf::SCANLINEIMAGE);
  }
  Imf::MultiPartOutputFile output(file.c_str(), headers.data(), static_cast<int>(headers.size()));
  for (int i = 0; i < static_cast<int>(parts.size()); ++i) {
    Imf::OutputPart part(output, i);
    const Pixels pixels(square, parts[static_cast<std::size_t>(i)].channels);
    part.setFrameBuffer(pixels.buffer);
    part.writePixels(pixels.lines);
  }
}

void putDeep(const std::string& file) {
  Imf::Header header = headerOf(square, square, {"R"}, Imf::HALF);
  header.setType(Imf::DEEPSCANLINE);
  header.compression() = Imf::ZIPS_COMPRESSION;
  Imf::DeepScanLineOutputFile output(file.c_str(), header);
  std::vector<unsigned> counts(256, 1);
  std::vector<half> values(256, half(0.5f));
  std::vector<half*> pointers;
  for (half& value : values) pointers.push_back(&value);
  Imf::DeepFrameBuffer buffer;
  buffer.insertSampleCountSlice(
      Imf::Slice(Imf::UINT, reinterpret_cast<char*>(counts.data()), sizeof(unsigned), 16 * sizeof(unsigned)));
  buffer.insert("R", Imf::DeepSlice(Imf::HALF, reinterpret_cast<char*>(pointers.data()), sizeof(half*),
                                    16 * sizeof(half*), sizeof(half)));
  output.setFrameBuffer(buffer);
  output.writePixels(16);
}

/// Whether a pixel has these channels' values; -1 is a channel that is not there.
bool has(const Image& image, int x, int y, int r, int g, int b) {
  const auto value = [&](int c) { return c < 0 ? 0 : valueOf(static_cast<std::size_t>(c), x, y); };
  return image.at(x, y) == vec3(value(r), value(g), value(b));
}

std::string errorOf(const std::string& file, const std::string& layer = "") {
  try {
    ImageSource source;
    readExrLayer(file, layer, source);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

ExrChoice choose(const std::vector<std::string>& channels, const std::string& wanted = "") {
  return chooseExrChannels({{"", false, channels}}, wanted);
}
std::string chosen(const std::vector<std::string>& channels, const std::string& wanted = "") {
  try {
    const ExrChoice c = choose(channels, wanted);
    return c.channels[0] + " " + c.channels[1] + " " + c.channels[2];
  } catch (const InputError& error) {
    return error.what();
  }
}

}  // namespace

TEST_CASE("The channels of a picture are found by the names that other programs give them") {
  const std::vector<std::string> blender = {"ViewLayer.Combined.A", "ViewLayer.Combined.B", "ViewLayer.Combined.G",
                                            "ViewLayer.Combined.R", "ViewLayer.Depth.Z",    "ViewLayer.DiffCol.B",
                                            "ViewLayer.DiffCol.G",  "ViewLayer.DiffCol.R",  "ViewLayer.Normal.X",
                                            "ViewLayer.Normal.Y",   "ViewLayer.Normal.Z"};
  CHECK(chosen(blender) == "ViewLayer.Combined.R ViewLayer.Combined.G ViewLayer.Combined.B");
  CHECK(chosen(blender, "ViewLayer.DiffCol") == "ViewLayer.DiffCol.R ViewLayer.DiffCol.G ViewLayer.DiffCol.B");
  CHECK(chosen(blender, "diffcol") == "ViewLayer.DiffCol.R ViewLayer.DiffCol.G ViewLayer.DiffCol.B");
  CHECK(chosen(blender, "Normal") == "ViewLayer.Normal.X ViewLayer.Normal.Y ViewLayer.Normal.Z");
  CHECK(chosen(blender, "ViewLayer.Depth") == "ViewLayer.Depth.Z ViewLayer.Depth.Z ViewLayer.Depth.Z");
  CHECK(chosen(blender, "ViewLayer.Normal.Y") == "ViewLayer.Normal.Y ViewLayer.Normal.Y ViewLayer.Normal.Y");

  CHECK(chosen({"B", "G", "R", "Z", "a.B", "a.G", "a.R"}) == "R G B");
  CHECK(chosen({"b", "g", "r"}) == "r g b");
  CHECK(chosen({"B", "G", "R", "b", "g", "r"}) == "R G B");
  CHECK(chosen({"blue", "green", "red"}) == "red green blue");
  CHECK(chosen({"only.b", "only.g", "only.r"}) == "only.r only.g only.b");
  CHECK(chosen({"Y"}) == "Y Y Y");
  CHECK(chosen({"A", "Y"}) == "Y Y Y");
  CHECK(chosen({"y"}) == "y y y");
  CHECK(chosen({"lum.Y", "N.X", "N.Y", "N.Z"}) == "lum.Y lum.Y lum.Y");
  CHECK(chosen({"G", "R"}) == "R G ");
}

TEST_CASE("Where several layers could be the picture, or none, the error lists what there is") {
  const std::vector<std::string> two = {"a.B", "a.G", "a.R", "b.B", "b.G", "b.R", "b.left.B", "c.left.G"};
  CHECK_THAT(chosen(two), StartsWith("2 layers of colours") && EndsWith("--layer with one of: a, b)"));
  CHECK_THAT(chosen(two, "d"), StartsWith("no layer 'd' (available: a, b, b.left, c.left"));
  CHECK_THAT(chosen(two, "left"), StartsWith("'left' could be 2 layers: b.left, c.left"));
  CHECK_THAT(chosen({"N.X", "N.Y", "N.Z"}), Contains("expected channels R, G, B or Y, got N.X, N.Y, N.Z"));
  CHECK_THAT(chosen({"BY", "RY", "Y"}), Contains("luminance/chroma"));
  CHECK_THAT(chosen({}), Contains("got none"));
}

TEST_CASE("A part's name is its layer's, and the first part's own colours come first") {
  const std::vector<ExrPart> colours = {{"left", false, {"B", "G", "R"}}, {"right", false, {"B", "G", "R"}}};
  CHECK(chooseExrChannels(colours, "").part == 0);
  CHECK(chooseExrChannels(colours, "right").part == 1);
  const std::vector<ExrPart> later = {
      {"depth", false, {"Z"}}, {"beauty", false, {"B", "G", "R"}}, {"albedo", false, {"B", "G", "R"}}};
  CHECK(chooseExrChannels(later, "").part == 1);
  CHECK(chooseExrChannels(later, "Albedo").part == 2);
  CHECK(chooseExrChannels(later, "Z").part == 0);
  const std::vector<ExrPart> deep = {{"deep", true, {"B", "G", "R"}}, {"flat", false, {"B", "G", "R"}}};
  CHECK(chooseExrChannels(deep, "").part == 1);
  CHECK_THROWS_WITH(chooseExrChannels(deep, "deep"), Contains("deep pixels are not supported"));
}

TEST_CASE("Half, luminance, lower case and layered EXR files are read bit for bit") {
  const Folder folder;
  ImageSource source;
  put(folder / "a.exr", {"R", "G", "B"}, Imf::HALF);
  CHECK(has(readExr(folder / "a.exr"), 3, 14, 0, 1, 2));
  put(folder / "b.exr", {"r", "g", "b"});
  CHECK(has(readExr(folder / "b.exr"), 3, 14, 0, 1, 2));
  put(folder / "c.exr", {"Y"}, Imf::HALF);
  CHECK(has(readExr(folder / "c.exr"), 15, 2, 0, 0, 0));
  put(folder / "d.exr", {"ViewLayer.Combined.R", "ViewLayer.Combined.G", "ViewLayer.Combined.B", "Z"});
  CHECK(has(readExrLayer(folder / "d.exr", "", source), 7, 9, 0, 1, 2));
  CHECK(source.layer == "ViewLayer.Combined");
  CHECK_FALSE(source.isPlain);
  CHECK(has(readExrLayer(folder / "d.exr", "Z", source), 7, 9, 3, 3, 3));
  put(folder / "e.exr", {"G"});
  CHECK(has(readExr(folder / "e.exr"), 7, 9, -1, 0, -1));
}

TEST_CASE("Tiles, with and without smaller levels, are read as scan lines are") {
  const Folder folder;
  for (const Imf::LevelMode mode : {Imf::ONE_LEVEL, Imf::MIPMAP_LEVELS}) {
    const std::string file = folder / "a.exr";
    {
      Imf::Header header = headerOf(square, square, {"R", "G", "B"});
      header.setTileDescription(Imf::TileDescription(4, 4, mode));
      Imf::TiledOutputFile output(file.c_str(), header);
      const Pixels pixels(square, {"R", "G", "B"});
      output.setFrameBuffer(pixels.buffer);
      for (int level = 0; level < output.numLevels(); ++level)
        output.writeTiles(0, output.numXTiles(level) - 1, 0, output.numYTiles(level) - 1, level);
    }
    const Image image = readExr(file);
    REQUIRE(image.width == 16);
    for (int y = 0; y < 16; ++y)
      for (int x = 0; x < 16; ++x) REQUIRE(has(image, x, y, 0, 1, 2));
    CHECK(readExrFacts(file).at(0).tiled);
  }
}

TEST_CASE("What is read is the display window, black where there are no pixels") {
  const Folder folder;
  const std::string file = folder / "a.exr";
  const auto read = [&](const Imath::Box2i& data, const Imath::Box2i& display) {
    put(file, {"R", "G", "B"}, Imf::FLOAT, data, display);
    ImageSource source;
    Image image = readExrLayer(file, "", source);
    CHECK((data == display) == source.window.empty());
    REQUIRE(image.width == display.max.x - display.min.x + 1);
    REQUIRE(image.height == display.max.y - display.min.y + 1);
    for (int y = display.min.y; y <= display.max.y; ++y)
      for (int x = display.min.x; x <= display.max.x; ++x) {
        const vec3 want =
            data.intersects(Imath::V2i(x, y)) ? vec3(valueOf(0, x, y), valueOf(1, x, y), valueOf(2, x, y)) : vec3(0);
        REQUIRE(image.at(x - display.min.x, y - display.min.y) == want);
      }
  };
  read(square, square);
  read({{4, 5}, {11, 8}}, square);     // A crop.
  read({{-3, -2}, {20, 30}}, square);  // Overscan.
  read({{-3, 9}, {5, 30}}, square);    // Across a corner.
  read({{100, 100}, {107, 103}}, {{100, 100}, {107, 103}});
  read({{-8, -8}, {3, 3}}, {{-8, -8}, {7, 7}});
  put(file, {"R", "G", "B"}, Imf::FLOAT, {{40, 40}, {50, 50}}, square);
  CHECK_THAT(errorOf(file), Contains("outside of its display window"));
  put(file, {"R", "G", "B"}, Imf::FLOAT, square, {{0, 0}, {65535, 4095}});
  CHECK_THAT(errorOf(file), Contains("display window of 65536 x 4096 pixels is more than the file can hold"));
}

TEST_CASE("Parts of a file are read by their names, and deep ones are refused by theirs") {
  const Folder folder;
  ImageSource source;
  putParts(folder / "a.exr", {{"depth", {"Z"}}, {"rgba", {"R", "G", "B"}}, {"albedo", {"B", "R", "G"}}});
  CHECK(has(readExr(folder / "a.exr"), 3, 8, 0, 1, 2));
  CHECK(has(readExrLayer(folder / "a.exr", "albedo", source), 3, 8, 1, 2, 0));
  CHECK(has(readExrLayer(folder / "a.exr", "depth", source), 3, 8, 0, 0, 0));
  CHECK(readExrChannel(folder / "a.exr", "Z")[17] == valueOf(0, 1, 1));
  CHECK(readExrFacts(folder / "a.exr").size() == 3);
  putDeep(folder / "deep.exr");
  CHECK_THAT(errorOf(folder / "deep.exr"),
             StartsWith(folder / "deep.exr") && Contains("deep pixels are not supported"));
  CHECK(readExrFacts(folder / "deep.exr").at(0).deep);
}

TEST_CASE("An EXR is told by its first bytes too, and other files are not taken for one") {
  const Folder folder;
  put(folder / "a.exr", {"Y"});
  putBytes(folder / "reference", bytesOf(folder / "a.exr"));
  putBytes(folder / "text.png", "v/1 text");
  CHECK(isExr(folder / "reference"));
  CHECK(isExr(folder / "none.EXR"));
  CHECK_FALSE(isExr(folder / "text.png"));
  CHECK_FALSE(isExr(folder / "none"));
  CHECK(readImage(folder / "reference").pixels == readExr(folder / "a.exr").pixels);
}

TEST_CASE("A header that says more than the file holds is refused before memory is taken for it") {
  const Folder folder;
  const std::string file = folder / "a.exr";
  const auto refusal = [&](const std::string& type, const std::string& value, uint32_t size) {
    std::string bytes("\x76\x2f\x31\x01\x02\0\0\0note\0", 13);
    bytes += type + '\0';
    for (int i = 0; i < 4; ++i) bytes += static_cast<char>(size >> 8 * i & 255);
    putBytes(file, bytes + value);
    try {
      readExrFacts(file);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  CHECK_THAT(refusal("string", "some", 0x70000000),
             EndsWith("a.exr: the attribute note of its header is larger than the file: 1879048192 bytes of 28"));
  CHECK_THAT(refusal("string", "some", 0xfffffff0), Contains("larger than the file"));
  CHECK_THAT(refusal("preview", std::string("\0\x40\0\0\0\x40\0\0", 8), 8), Contains("a preview, is not of the size"));
  CHECK_THAT(refusal("preview", std::string("\xff\xff\xff\xff\xff\xff\xff\xff", 8), 8), Contains("not of the size"));
  CHECK_THAT(refusal("chlist", std::string("a\0", 2), 2), Contains("note of its header, a chlist, is not of the size"));
  CHECK_THAT(refusal("v3f", "some", 4), Contains("a v3f, is not of the size"));
  CHECK_THAT(refusal("stringvector", std::string("\0\0\0\x70", 4), 4), Contains("not of the size"));
  CHECK_THAT(refusal("string", "some", 4), !Contains("larger than the file"));  // It ends too early for an image.
}
