// Writes small EXR files of every kind of storage into a folder: where the fuzzer of EXR begins.
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfDeepFrameBuffer.h>
#include <OpenEXR/ImfDeepScanLineOutputPart.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfMultiPartOutputFile.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfOutputPart.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <OpenEXR/ImfTiledOutputFile.h>
#include <fmt/format.h>

#include <exception>
#include <string>
#include <vector>

namespace {

constexpr int width = 9, height = 5;
const std::vector<float> values(4 * width * height, 0.5f);

Imf::Header headerOf(Imf::Compression compression, Imf::PixelType type, const std::vector<std::string>& channels) {
  Imf::Header header(width, height, 1, Imath::V2f(0, 0), 1, Imf::INCREASING_Y, compression);
  for (const std::string& name : channels) header.channels().insert(name, Imf::Channel(type));
  header.insert("copse", Imf::StringAttribute("{\"schema\": 1}"));
  return header;
}

Imf::FrameBuffer bufferOf(const Imf::Header& header) {
  Imf::FrameBuffer buffer;
  for (auto c = header.channels().begin(); c != header.channels().end(); ++c) {
    const std::size_t bytes = c.channel().type == Imf::HALF ? 2 : 4;
    char* first = const_cast<char*>(reinterpret_cast<const char*>(values.data()));
    buffer.insert(c.name(), Imf::Slice(c.channel().type, first, bytes, bytes * width));
  }
  return buffer;
}

void writeLines(const std::string& file, const Imf::Header& header) {
  Imf::OutputFile output(file.c_str(), header);
  output.setFrameBuffer(bufferOf(header));
  output.writePixels(height);
}

void writeTiles(const std::string& file, Imf::Header header, Imf::LevelMode mode) {
  header.setTileDescription(Imf::TileDescription(4, 4, mode));
  Imf::TiledOutputFile output(file.c_str(), header);
  output.setFrameBuffer(bufferOf(header));
  for (int level = 0; level < output.numLevels(); ++level)
    output.writeTiles(0, output.numXTiles(level) - 1, 0, output.numYTiles(level) - 1, level);
}

void writeParts(const std::string& file, std::vector<Imf::Header> headers) {
  for (std::size_t i = 0; i < headers.size(); ++i) {
    headers[i].setName(fmt::format("ViewLayer.{}", i));
    headers[i].setType(Imf::SCANLINEIMAGE);
  }
  Imf::MultiPartOutputFile output(file.c_str(), headers.data(), static_cast<int>(headers.size()));
  for (std::size_t i = 0; i < headers.size(); ++i) {
    Imf::OutputPart part(output, static_cast<int>(i));
    part.setFrameBuffer(bufferOf(headers[i]));
    part.writePixels(height);
  }
}

void writeDeep(const std::string& file) {
  Imf::Header header = headerOf(Imf::ZIPS_COMPRESSION, Imf::FLOAT, {"Z"});
  header.setType(Imf::DEEPSCANLINE);
  header.setName("deep");
  Imf::MultiPartOutputFile output(file.c_str(), &header, 1);
  Imf::DeepScanLineOutputPart part(output, 0);
  float value = 1;
  std::vector<unsigned> counts(width * height, 1);
  std::vector<const float*> samples(width * height, &value);
  Imf::DeepFrameBuffer buffer;
  buffer.insertSampleCountSlice(
      Imf::Slice(Imf::UINT, reinterpret_cast<char*>(counts.data()), sizeof(unsigned), sizeof(unsigned) * width));
  buffer.insert("Z", Imf::DeepSlice(Imf::FLOAT, reinterpret_cast<char*>(samples.data()), sizeof(float*),
                                    sizeof(float*) * width, sizeof(float)));
  part.setFrameBuffer(buffer);
  part.writePixels(height);
}

void writeAll(const std::string& folder) {
  const std::vector<std::string> rgb{"R", "G", "B"},
      layers{"ViewLayer.Combined.R", "ViewLayer.Combined.G", "ViewLayer.Combined.B", "ViewLayer.Depth.Z"};
  for (int compression = 0; compression < Imf::NUM_COMPRESSION_METHODS; ++compression)
    for (const Imf::PixelType type : {Imf::HALF, Imf::FLOAT}) {
      const Imf::Header header = headerOf(static_cast<Imf::Compression>(compression), type, rgb);
      writeLines(fmt::format("{}/lines-{}-{}.exr", folder, compression, static_cast<int>(type)), header);
      writeTiles(fmt::format("{}/tiles-{}-{}.exr", folder, compression, static_cast<int>(type)), header,
                 Imf::ONE_LEVEL);
    }
  writeTiles(folder + "/mipmap.exr", headerOf(Imf::ZIP_COMPRESSION, Imf::HALF, rgb), Imf::MIPMAP_LEVELS);
  writeLines(folder + "/layers.exr", headerOf(Imf::NO_COMPRESSION, Imf::HALF, layers));
  writeLines(folder + "/uint.exr", headerOf(Imf::NO_COMPRESSION, Imf::UINT, {"Y", "id"}));
  Imf::Header shifted = headerOf(Imf::RLE_COMPRESSION, Imf::FLOAT, {"Y"});
  shifted.displayWindow() = Imath::Box2i({-3, 1}, {4, 9});
  writeLines(folder + "/window.exr", shifted);
  writeParts(folder + "/parts.exr",
             {headerOf(Imf::ZIP_COMPRESSION, Imf::HALF, rgb), headerOf(Imf::PIZ_COMPRESSION, Imf::FLOAT, {"Y"})});
  writeDeep(folder + "/deep.exr");
}

}  // namespace

int main(int count, char** arguments) {
  try {
    if (count == 2) writeAll(arguments[1]);
  } catch (const std::exception& error) {
    fmt::print(stderr, "error: {}\n", error.what());
    return 1;
  }
  return count == 2 ? 0 : 2;
}
