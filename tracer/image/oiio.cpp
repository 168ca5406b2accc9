// The only file that knows OpenImageIO, a module of its own: textures and skies in, PNG previews out.
#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <stdexcept>

#include "tracer/image/colour.h"
#include "tracer/image/oiio.h"

namespace copse {
namespace {

constexpr int64_t maxSide = 65536, maxPixels = int64_t{1} << 28;

std::string firstLine(const std::string& text) { return text.substr(0, text.find('\n')); }

Image read(const std::string& file) {
  OIIO::ImageSpec wish;
  wish["oiio:UnassociatedAlpha"] = 1;  // Otherwise colours come multiplied by alpha.
  const std::unique_ptr<OIIO::ImageInput> input = OIIO::ImageInput::open(file, &wish);
  if (!input) throw std::runtime_error(firstLine(OIIO::geterror()));
  const OIIO::ImageSpec& spec = input->spec();
  if (spec.width < 1 || spec.height < 1 || spec.width > maxSide || spec.height > maxSide || spec.nchannels < 1 ||
      int64_t{spec.width} * spec.height > maxPixels)
    throw std::runtime_error("invalid image size " + std::to_string(spec.width) + " x " + std::to_string(spec.height));

  const bool colour = spec.nchannels >= 3;  // One channel is grey, two are grey and alpha.
  // Alpha is looked at only so that it can be said to be ignored.
  const int alpha = spec.alpha_channel, channels = std::max(colour ? 3 : 1, alpha + 1);
  const std::size_t count = static_cast<std::size_t>(spec.width) * spec.height;
  Image image{spec.width, spec.height, std::vector<vec3>(count)};
  std::vector<float> values(count * channels);
  if (!input->read_image(0, 0, 0, channels, OIIO::TypeDesc::FLOAT, values.data()))
    throw std::runtime_error(firstLine(input->geterror()));
  const bool decode = !spec.format.is_floating_point();
  for (std::size_t i = 0; i < count; ++i)
    for (int c = 0; c < 3; ++c) {
      const float value = values[i * channels + (colour ? c : 0)];
      image.pixels[i][c] = decode ? linearOfScreen(value) : value;
    }
  for (std::size_t i = 0; i < count && alpha >= 0 && !image.seeThrough; ++i)
    image.seeThrough = values[i * channels + alpha] < 0.98f;
  return image;
}

std::vector<unsigned char> encodePng(int width, int height, const unsigned char* bytes) {
  std::vector<unsigned char> encoded;
  OIIO::Filesystem::IOVecOutput memory(encoded);
  const std::unique_ptr<OIIO::ImageOutput> output = OIIO::ImageOutput::create("png");
  if (!output) throw std::runtime_error(firstLine(OIIO::geterror()));
  OIIO::ImageSpec spec(width, height, 3, OIIO::TypeDesc::UINT8);
  spec.attribute("oiio:ColorSpace", "sRGB");
  output->set_ioproxy(&memory);
  const bool good = output->open("preview.png", spec) && output->write_image(OIIO::TypeDesc::UINT8, bytes);
  if (!good || !output->close()) throw std::runtime_error(firstLine(output->geterror()));
  return encoded;
}

}  // namespace
}  // namespace copse

extern "C" __attribute__((visibility("default")))
const copse::OiioModule copseOiioModule{&copse::read, &copse::encodePng};
