// 32-bit float RGB and further channels to OpenEXR, with string attributes.
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfIO.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <OpenEXR/ImfThreading.h>
#include <fmt/format.h>

#include <algorithm>
#include <system_error>
#include <thread>

#include "builder/base/error.h"
#include "builder/base/whole_file.h"
#include "tracer/image/exr_threads.h"
#include "tracer/image/image_io.h"

namespace copse {

namespace {

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

}  // namespace

void useExrThreads(int64_t pixels) {
  if (pixels < (1 << 21) || Imf::globalThreadCount() > 0) return;
  try {
    Imf::setGlobalThreadCount(static_cast<int>(std::clamp(std::thread::hardware_concurrency(), 1u, 16u)));
  } catch (const std::system_error&) {  // No more threads are to be had: slower is better than no image.
    Imf::setGlobalThreadCount(0);
  }
}

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
  useExrThreads(pixels);
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

}  // namespace copse
