// 32-bit float RGB and further channels to OpenEXR and back, with string attributes.
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfInputFile.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <OpenEXR/ImfThreading.h>
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <system_error>
#include <thread>

#include "builder/base/error.h"
#include "builder/base/whole_file.h"
#include "tracer/image/image_io.h"

namespace copse {

namespace {

constexpr int64_t maxSide = 65536, maxPixels = int64_t{1} << 28;

/// OpenEXR writes its table of offsets in a destructor, which swallows errors; WholeFile remembers them until commit().
class WholeStream : public Imf::OStream {
 public:
  WholeStream(WholeFile& whole, const std::string& file) : OStream(file.c_str()), whole_(whole) {}
  void write(const char bytes[], int count) override { whole_.write(bytes, static_cast<std::size_t>(count)); }
  uint64_t tellp() override { return whole_.position(); }
  void seekp(uint64_t position) override { whole_.seek(position); }

 private:
  WholeFile& whole_;
};

/// Threads that compress: a small image is done sooner than they are started.
void useThreads(int64_t pixels) {
  if (pixels < (1 << 21) || Imf::globalThreadCount() > 0) return;
  try {
    Imf::setGlobalThreadCount(static_cast<int>(std::clamp(std::thread::hardware_concurrency(), 1u, 16u)));
  } catch (const std::system_error&) {  // No more threads are to be had: slower is better than no image.
    Imf::setGlobalThreadCount(0);
  }
}

/// A slice of one channel, `stride` bytes from pixel to pixel.
Imf::Slice sliceOf(const Imf::Channel& channel, const std::string& name, const Imath::Box2i& window, float* first,
                   std::size_t stride) {
  if (channel.xSampling != 1 || channel.ySampling != 1)
    throw InputError(fmt::format("channel {} has fewer samples than pixels", name));
  const auto width = static_cast<std::size_t>(window.max.x - window.min.x + 1);
  return Imf::Slice::Make(Imf::FLOAT, first, window, stride, stride * width);
}

/// Slices of R, G and B, or of Y for all three, in rows of vec3.
Imf::FrameBuffer slicesOf(const Imf::ChannelList& channels, const Imath::Box2i& window, Image& image, bool& luminance) {
  const bool rgb = channels.findChannel("R") || channels.findChannel("G") || channels.findChannel("B");
  luminance = !rgb && channels.findChannel("Y") != nullptr;
  std::string names;
  for (auto c = channels.begin(); c != channels.end(); ++c) names += std::string(names.empty() ? "" : ", ") + c.name();
  if (!rgb && !luminance) throw InputError(fmt::format("expected channels R, G, B or Y, got {}", names));
  if (luminance && (channels.findChannel("RY") || channels.findChannel("BY")))
    throw InputError("unsupported luminance/chroma image (expected RGB or luminance)");

  Imf::FrameBuffer buffer;
  const char* wanted[3] = {luminance ? "Y" : "R", "G", "B"};
  for (int c = 0; c < (luminance ? 1 : 3); ++c) {
    float* const first = &image.pixels[0][c];
    if (const Imf::Channel* channel = channels.findChannel(wanted[c]))
      buffer.insert(wanted[c], sliceOf(*channel, wanted[c], window, first, sizeof(vec3)));
    else
      buffer.insert(wanted[c], Imf::Slice::Make(Imf::FLOAT, first, window, sizeof(vec3),
                                                sizeof(vec3) * static_cast<std::size_t>(image.width)));
  }
  return buffer;
}

/// The size of the data window of a file that is whole and may be as large as it says.
Imath::V2i checkedSize(const Imf::InputFile& input, const std::string& file) {
  const Imath::Box2i window = input.header().dataWindow();
  const int64_t width = int64_t{window.max.x} - window.min.x + 1, height = int64_t{window.max.y} - window.min.y + 1;
  if (width < 1 || height < 1 || width > maxSide || height > maxSide || width * height > maxPixels)
    throw InputError(fmt::format("invalid image size {} x {}", width, height));
  // No compression of OpenEXR comes near this: a header that lies must not claim the memory.
  if (width * height / 8192 > static_cast<int64_t>(std::filesystem::file_size(file)))
    throw InputError(fmt::format("{} x {} pixels are more than the file can hold", width, height));
  if (!input.isComplete()) throw InputError("the image is incomplete");
  useThreads(width * height);
  return {static_cast<int>(width), static_cast<int>(height)};
}

Image readRgb(const std::string& file, std::map<std::string, std::string>* attributes) {
  Imf::InputFile input(file.c_str());
  const Imf::Header& header = input.header();
  const Imath::Box2i window = header.dataWindow();
  const Imath::V2i size = checkedSize(input, file);
  Image image{size.x, size.y, {}};
  image.pixels.resize(static_cast<std::size_t>(size.x) * size.y, vec3(0));
  bool luminance = false;
  input.setFrameBuffer(slicesOf(header.channels(), window, image, luminance));
  input.readPixels(window.min.y, window.max.y);
  if (luminance)
    for (vec3& p : image.pixels) p = vec3(p.x);
  if (attributes)
    for (auto a = header.begin(); a != header.end(); ++a)
      if (const auto* text = dynamic_cast<const Imf::StringAttribute*>(&a.attribute()))
        (*attributes)[a.name()] = text->value();
  return image;
}

std::vector<float> readOne(const std::string& file, const std::string& name) {
  Imf::InputFile input(file.c_str());
  const Imath::Box2i window = input.header().dataWindow();
  const Imf::Channel* channel = input.header().channels().findChannel(name);
  if (!channel) throw InputError("no channel " + name);
  const Imath::V2i size = checkedSize(input, file);
  std::vector<float> values(static_cast<std::size_t>(size.x) * size.y);
  Imf::FrameBuffer buffer;
  buffer.insert(name, sliceOf(*channel, name, window, values.data(), sizeof(float)));
  input.setFrameBuffer(buffer);
  input.readPixels(window.min.y, window.max.y);
  return values;
}

/// What `read` reads, with the file's name before all that goes wrong.
template <class Read>
auto named(const std::string& file, Read read) {
  std::error_code ignored;
  if (!std::filesystem::exists(file, ignored)) throw InputError(file + ": no such file");
  if (std::filesystem::is_directory(file, ignored)) throw InputError(file + ": is a directory");
  try {
    return read();
  } catch (const std::exception& error) {
    throw InputError(fmt::format("{}: {}", file, error.what()));
  }
}

}  // namespace

void writeExr(const std::string& file, const Image& image, const std::map<std::string, std::string>& attributes,
              const std::vector<Channel>& channels) {
  const int64_t pixels = int64_t{image.width} * image.height;
  if (image.width < 1 || image.height < 1 || image.pixels.size() != static_cast<std::size_t>(pixels))
    throw InputError(fmt::format("{}: cannot write an image of {} x {} pixels", file, image.width, image.height));
  for (const Channel& channel : channels)
    if (channel.values.size() != image.pixels.size())
      throw InputError(fmt::format("{}: channel {} has {} values for {} pixels", file, channel.name,
                                   channel.values.size(), image.pixels.size()));
  WholeFile whole(file);
  useThreads(pixels);
  try {
    Imf::Header header(image.width, image.height, 1, Imath::V2f(0, 0), 1, Imf::INCREASING_Y, Imf::ZIP_COMPRESSION);
    for (const auto& [name, value] : attributes) header.insert(name, Imf::StringAttribute(value));
    Imf::FrameBuffer buffer;
    const char* names[3] = {"R", "G", "B"};
    for (int c = 0; c < 3; ++c) {
      header.channels().insert(names[c], Imf::Channel(Imf::FLOAT));
      char* first = const_cast<char*>(reinterpret_cast<const char*>(&image.pixels[0][c]));
      buffer.insert(names[c], Imf::Slice(Imf::FLOAT, first, sizeof(vec3), sizeof(vec3) * std::size_t(image.width)));
    }
    for (const Channel& channel : channels) {
      header.channels().insert(channel.name, Imf::Channel(Imf::FLOAT));
      char* first = const_cast<char*>(reinterpret_cast<const char*>(channel.values.data()));
      buffer.insert(channel.name,
                    Imf::Slice(Imf::FLOAT, first, sizeof(float), sizeof(float) * std::size_t(image.width)));
    }
    WholeStream stream(whole, file);
    Imf::OutputFile output(stream, header);
    output.setFrameBuffer(buffer);
    output.writePixels(image.height);
  } catch (const InputError&) {
    throw;
  } catch (const std::exception& error) {
    throw InputError(fmt::format("{}: cannot write: {}", file, error.what()));
  }
  whole.commit();
}

Image readExr(const std::string& file, std::map<std::string, std::string>* attributes) {
  return named(file, [&] { return readRgb(file, attributes); });
}

std::vector<float> readExrChannel(const std::string& file, const std::string& name) {
  return named(file, [&] { return readOne(file, name); });
}

}  // namespace copse
