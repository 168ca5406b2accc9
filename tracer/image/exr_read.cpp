// EXR files of any program into RGB: half, float or whole numbers, scan lines or tiles, one part or several. What is
// read is the display window; the data window may be smaller, larger or beside it.
#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfCompressionAttribute.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputPart.h>
#include <OpenEXR/ImfMultiPartInputFile.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfStringAttribute.h>
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <new>
#include <system_error>

#include "builder/base/error.h"
#include "builder/base/files.h"
#include "tracer/image/exr_header.h"
#include "tracer/image/exr_layers.h"
#include "tracer/image/exr_threads.h"
#include "tracer/image/image_io.h"

namespace copse {

namespace {

/// Around a data window that is smaller, a display window may be this large whatever the file's size.
constexpr int64_t maxEmptyPixels = int64_t{1} << 25;

struct Size {
  int64_t width, height;
};

Size sizeOf(const Imath::Box2i& window) {
  return {int64_t{window.max.x} - window.min.x + 1, int64_t{window.max.y} - window.min.y + 1};
}

std::string text(const Imath::Box2i& window) {
  const Size size = sizeOf(window);
  return fmt::format("{} x {} pixels at {}, {}", size.width, size.height, window.min.x, window.min.y);
}

Imath::Box2i intersection(const Imath::Box2i& a, const Imath::Box2i& b) {
  return {{std::max(a.min.x, b.min.x), std::max(a.min.y, b.min.y)},
          {std::min(a.max.x, b.max.x), std::min(a.max.y, b.max.y)}};
}

/// Throws where the windows of a part cannot be what they say, before memory is taken for them.
void checkWindows(const Imf::Header& header, const std::string& file) {
  const Imath::Box2i data = header.dataWindow(), display = header.displayWindow();
  for (const Imath::Box2i& window : {data, display}) {
    const Size size = sizeOf(window);
    if (size.width < 1 || size.height < 1 || size.width > maxImageSide || size.height > maxImageSide ||
        size.width * size.height > maxImagePixels)
      throw InputError(fmt::format("invalid image size {} x {}", size.width, size.height));
  }
  // No compression of OpenEXR comes near this: a header that lies must not claim the memory.
  const auto most = static_cast<int64_t>(std::filesystem::file_size(file)) * 8192;
  const Size read = sizeOf(data), shown = sizeOf(display);
  if (read.width * read.height > most)
    throw InputError(fmt::format("{} x {} pixels are more than the file can hold", read.width, read.height));
  if (shown.width * shown.height > std::max(most, maxEmptyPixels))
    throw InputError(
        fmt::format("a display window of {} x {} pixels is more than the file can hold", shown.width, shown.height));
  const Size both = sizeOf(intersection(data, display));
  if (both.width < 1 || both.height < 1)
    throw InputError(
        fmt::format("its pixels, {}, are all outside of its display window, {}", text(data), text(display)));
}

std::vector<ExrPart> partsOf(const Imf::MultiPartInputFile& input) {
  std::vector<ExrPart> parts;
  for (int i = 0; i < input.parts(); ++i) {
    const Imf::Header& header = input.header(i);
    ExrPart part;
    if (header.hasName()) part.name = header.name();
    part.deep = header.hasType() && Imf::isDeepData(header.type());
    for (auto c = header.channels().begin(); c != header.channels().end(); ++c) part.channels.emplace_back(c.name());
    parts.push_back(std::move(part));
  }
  return parts;
}

/// A part's channels in its data window, `perPixel` floats a pixel; "" leaves 0.
std::vector<float> readChannels(Imf::MultiPartInputFile& input, int number, const std::vector<std::string>& channels,
                                std::size_t perPixel) {
  Imf::InputPart part(input, number);
  const Imath::Box2i window = part.header().dataWindow();
  if (!part.isComplete()) throw InputError("the image is incomplete");
  const auto width = static_cast<std::size_t>(sizeOf(window).width);
  std::vector<float> values(width * static_cast<std::size_t>(sizeOf(window).height) * perPixel, 0.0f);
  Imf::FrameBuffer buffer;
  for (std::size_t c = 0; c < channels.size(); ++c) {
    if (channels[c].empty()) continue;
    const Imf::Channel* channel = part.header().channels().findChannel(channels[c]);
    if (channel->xSampling != 1 || channel->ySampling != 1)
      throw InputError(fmt::format("channel {} has fewer samples than pixels", channels[c]));
    const std::size_t step = perPixel * sizeof(float);
    buffer.insert(channels[c], Imf::Slice::Make(Imf::FLOAT, values.data() + c, window, step, step * width));
  }
  part.setFrameBuffer(buffer);
  part.readPixels(window.min.y, window.max.y);
  return values;
}

/// What of the data window is in the display window, where it is there; black around it.
Image placed(const std::vector<float>& values, bool grey, const Imath::Box2i& data, const Imath::Box2i& display) {
  const Size size = sizeOf(display);
  Image image{static_cast<int>(size.width), static_cast<int>(size.height), {}};
  image.pixels.resize(static_cast<std::size_t>(size.width * size.height), vec3(0));
  const Imath::Box2i both = intersection(data, display);
  const int64_t width = sizeOf(data).width;
  for (int y = both.min.y; y <= both.max.y; ++y) {
    vec3* to = &image.at(both.min.x - display.min.x, y - display.min.y);
    const auto first = static_cast<std::size_t>((int64_t{y} - data.min.y) * width + both.min.x - data.min.x);
    const float* from = values.data() + first * (grey ? 1 : 3);
    for (int x = both.min.x; x <= both.max.x; ++x, from += grey ? 1 : 3)
      *to++ = grey ? vec3(from[0]) : vec3(from[0], from[1], from[2]);
  }
  return image;
}

void takeAttributes(const Imf::Header& header, std::map<std::string, std::string>& attributes) {
  for (auto a = header.begin(); a != header.end(); ++a)
    if (const auto* value = dynamic_cast<const Imf::StringAttribute*>(&a.attribute()))
      if (std::string(a.name()) != "name" && std::string(a.name()) != "type") attributes[a.name()] = value->value();
}

Image readRgb(const std::string& file, const std::string& layer, ImageSource* source) {
  Imf::MultiPartInputFile input(file.c_str());
  const ExrChoice choice = chooseExrChannels(partsOf(input), layer);
  const Imf::Header& header = input.header(choice.part);
  checkWindows(header, file);
  const Imath::Box2i data = header.dataWindow(), display = header.displayWindow();
  useExrThreads(sizeOf(data).width * sizeOf(data).height);
  const bool grey = choice.channels[0] == choice.channels[1];
  const std::vector<std::string> channels(choice.channels, choice.channels + (grey ? 1 : 3));
  const std::vector<float> values = readChannels(input, choice.part, channels, channels.size());
  if (source) {
    source->layer = choice.layer;
    for (const std::string& channel : channels)
      if (!channel.empty()) source->channels += (source->channels.empty() ? "" : ", ") + channel;
    source->isPlain = source->channels == "R, G, B" || source->channels == "Y";
    if (data != display) source->window = fmt::format("{} of a display window of {}", text(data), text(display));
    takeAttributes(header, source->attributes);
  }
  return placed(values, grey, data, display);
}

const char* nameOf(Imf::PixelType type) {
  return type == Imf::HALF ? "half" : type == Imf::FLOAT ? "float" : type == Imf::UINT ? "uint" : "unknown";
}

std::vector<ExrPartFacts> readFacts(const std::string& file) {
  Imf::MultiPartInputFile input(file.c_str());
  const std::vector<ExrPart> parts = partsOf(input);
  std::vector<ExrPartFacts> facts;
  for (int i = 0; i < input.parts(); ++i) {
    const Imf::Header& header = input.header(i);
    ExrPartFacts part;
    part.name = parts[i].name;
    part.deep = parts[i].deep;
    part.tiled = header.hasTileDescription();
    const Imath::Box2i data = header.dataWindow(), display = header.displayWindow();
    part.width = sizeOf(display).width;
    part.height = sizeOf(display).height;
    if (data != display) part.window = text(data);
    for (auto c = header.channels().begin(); c != header.channels().end(); ++c)
      part.channels.emplace_back(c.name(), nameOf(c.channel().type));
    takeAttributes(header, part.attributes);
    if (!input.partComplete(i)) throw InputError("the image is incomplete");
    facts.push_back(std::move(part));
  }
  return facts;
}

/// What `read` reads, with the file's name before all that goes wrong.
template <class Read>
auto named(const std::string& file, Read read) {
  checkFile(file);
  try {
    checkExrHeader(file);
    return read();
  } catch (const std::bad_alloc&) {
    throw InputError(file + ": not enough memory for its pixels");
  } catch (const std::exception& error) {
    throw InputError(fmt::format("{}: {}", file, error.what()));
  }
}

}  // namespace

Image readExr(const std::string& file, std::map<std::string, std::string>* attributes) {
  ImageSource source;
  Image image = named(file, [&] { return readRgb(file, "", &source); });
  if (attributes) *attributes = std::move(source.attributes);
  return image;
}

Image readExrLayer(const std::string& file, const std::string& layer, ImageSource& source) {
  return named(file, [&] { return readRgb(file, layer, &source); });
}

ExrHas lookForExrLayer(const std::string& file, const std::string& layer) {
  return named(file, [&] {
    const std::vector<ExrPart> parts = partsOf(Imf::MultiPartInputFile(file.c_str()));
    return ExrHas{hasExrLayer(parts, layer), exrLayerCount(parts)};
  });
}

std::vector<float> readExrChannel(const std::string& file, const std::string& name) {
  return named(file, [&] {
    Imf::MultiPartInputFile input(file.c_str());
    const std::vector<ExrPart> parts = partsOf(input);
    const auto part = std::ranges::find_if(
        parts, [&](const ExrPart& p) { return !p.deep && std::ranges::count(p.channels, name) > 0; });
    if (part == parts.end()) throw InputError("no channel " + name);
    const int number = static_cast<int>(part - parts.begin());
    checkWindows(input.header(number), file);
    return readChannels(input, number, {name}, 1);
  });
}

std::vector<ExrPartFacts> readExrFacts(const std::string& file) {
  return named(file, [&] { return readFacts(file); });
}

}  // namespace copse
