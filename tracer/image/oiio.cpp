// The only file that knows OpenImageIO, a module of its own: textures and skies in, PNG previews out.
#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cstdint>
#include <limits>
#include <stdexcept>
#include <type_traits>

#include "tracer/image/oiio.h"
#include "tracer/scene/image.h"

namespace copse {
namespace {

std::string firstLine(const std::string& text) { return text.substr(0, text.find('\n')); }

/// Into the first three T of each pixel; grey into all three. Bytes are in the order of a little-endian machine.
/// Returns whether some alpha is below 0.98: it is not kept, but has to be said to be ignored.
template <class T, class Pixel>
bool readInto(OIIO::ImageInput& input, OIIO::TypeDesc type, std::vector<Pixel>& pixels) {
  static_assert(sizeof(Pixel) >= 3 * sizeof(T));
  const OIIO::ImageSpec& spec = input.spec();
  const bool colour = spec.nchannels >= 3;  // One channel is grey, two are grey and alpha.
  pixels.resize(static_cast<std::size_t>(spec.width) * spec.height);
  T* const values = reinterpret_cast<T*>(pixels.data());
  constexpr std::size_t step = sizeof(Pixel) / sizeof(T);
  const int colours = colour ? 3 : 1;
  const bool alphaFits = spec.alpha_channel == colours && spec.alpha_channel < static_cast<int>(step);
  if (!input.read_image(0, 0, 0, colours + alphaFits, type, values, sizeof(Pixel)))
    throw std::runtime_error(firstLine(input.geterror()));

  std::vector<T> apart;  // Alpha where it does not lie beside the colours.
  if (spec.alpha_channel >= 0 && !alphaFits) {
    apart.resize(pixels.size());
    if (!input.read_image(0, 0, spec.alpha_channel, spec.alpha_channel + 1, type, apart.data()))
      throw std::runtime_error(firstLine(input.geterror()));
  }
  bool seeThrough = false;
  const float opaque = 0.98f * (std::is_integral_v<T> ? std::numeric_limits<T>::max() : 1);
  if (alphaFits)
    for (std::size_t i = 0; i < pixels.size() && !seeThrough; ++i) seeThrough = values[step * i + colours] < opaque;
  else
    seeThrough = std::ranges::any_of(apart, [&](T alpha) { return alpha < opaque; });

  if (!colour)
    for (std::size_t i = 0; i < pixels.size(); ++i) values[step * i + 2] = values[step * i + 1] = values[step * i];
  return seeThrough;
}

Decoded read(const std::string& file) {
  OIIO::ImageSpec wish;
  wish["oiio:UnassociatedAlpha"] = 1;  // Otherwise colours come multiplied by alpha.
  const std::unique_ptr<OIIO::ImageInput> input = OIIO::ImageInput::open(file, &wish);
  if (!input) throw std::runtime_error(firstLine(OIIO::geterror()));
  const OIIO::ImageSpec& spec = input->spec();
  if (spec.width < 1 || spec.height < 1 || spec.width > maxImageSide || spec.height > maxImageSide ||
      spec.nchannels < 1 || int64_t{spec.width} * spec.height > maxImagePixels)
    throw std::runtime_error("invalid image size " + std::to_string(spec.width) + " x " + std::to_string(spec.height));

  Decoded image{spec.width, spec.height, {}, {}, {}};
  if (spec.format.is_floating_point())
    image.seeThrough = readInto<float>(*input, OIIO::TypeDesc::FLOAT, image.floats);
  else if (spec.format == OIIO::TypeDesc::UINT8)
    image.seeThrough = readInto<uint8_t>(*input, OIIO::TypeDesc::UINT8, image.bytes);
  else
    image.seeThrough = readInto<uint16_t>(*input, OIIO::TypeDesc::UINT16, image.words);
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
