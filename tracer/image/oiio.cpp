// The only file that knows OpenImageIO: textures and skies in, PNG previews out.
#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "builder/parallel/error.h"
#include "tracer/image/image_io.h"
#include "tracer/image/oiio.h"
#include "tracer/scene/whole_file.h"

namespace copse {

namespace {

constexpr int64_t maxSide = 65536, maxPixels = int64_t{1} << 28;

// IEC 61966-2-1.
float linearOf(float s) { return s <= 0.04045f ? s / 12.92f : std::pow((s + 0.055f) / 1.055f, 2.4f); }
float sRgbOf(float l) { return l <= 0.0031308f ? 12.92f * l : 1.055f * std::pow(l, 1 / 2.4f) - 0.055f; }

std::string firstLine(const std::string& text) { return text.substr(0, text.find('\n')); }

}  // namespace

bool hasOpenImageIO() { return true; }

void writePng(const std::string& file, const Image& image, float exposure) {
  if (image.width < 1 || image.height < 1) throw InputError(file + ": an image without pixels cannot be written");
  const float scale = std::exp2(exposure);
  std::vector<unsigned char> bytes(3 * image.pixels.size());
  for (std::size_t i = 0; i < image.pixels.size(); ++i)
    for (int c = 0; c < 3; ++c) {
      const float value = image.pixels[i][c] * scale;
      // The comparison sends NaN to 0.
      bytes[3 * i + c] = static_cast<unsigned char>(value > 0 ? std::lround(255 * sRgbOf(std::min(value, 1.0f))) : 0);
    }

  WholeFile whole(file);
  std::vector<unsigned char> encoded;
  OIIO::Filesystem::IOVecOutput memory(encoded);
  const std::unique_ptr<OIIO::ImageOutput> output = OIIO::ImageOutput::create("png");
  if (!output) throw InputError(file + ": cannot be written: " + firstLine(OIIO::geterror()));
  OIIO::ImageSpec spec(image.width, image.height, 3, OIIO::TypeDesc::UINT8);
  spec.attribute("oiio:ColorSpace", "sRGB");
  output->set_ioproxy(&memory);
  const bool good = output->open("preview.png", spec) && output->write_image(OIIO::TypeDesc::UINT8, bytes.data());
  if (!good || !output->close()) throw InputError(file + ": cannot be written: " + firstLine(output->geterror()));
  whole.write(encoded.data(), encoded.size());
  whole.commit();
}

Image readByOpenImageIO(const std::string& file) {
  OIIO::ImageSpec wish;
  wish["oiio:UnassociatedAlpha"] = 1;  // Otherwise colours come multiplied by alpha.
  const std::unique_ptr<OIIO::ImageInput> input = OIIO::ImageInput::open(file, &wish);
  if (!input) throw InputError(file + ": " + firstLine(OIIO::geterror()));
  const OIIO::ImageSpec& spec = input->spec();
  if (spec.width < 1 || spec.height < 1 || spec.width > maxSide || spec.height > maxSide || spec.nchannels < 1 ||
      int64_t{spec.width} * spec.height > maxPixels)
    throw InputError(file + ": " + std::to_string(spec.width) + " x " + std::to_string(spec.height) +
                     " pixels are not an image's size");

  const bool colour = spec.nchannels >= 3;  // One channel is grey, two are grey and alpha.
  const int channels = colour ? 3 : 1;
  const std::size_t count = static_cast<std::size_t>(spec.width) * spec.height;
  Image image{spec.width, spec.height, std::vector<vec3>(count)};
  std::vector<float> values(count * channels);
  if (!input->read_image(0, 0, 0, channels, OIIO::TypeDesc::FLOAT, values.data()))
    throw InputError(file + ": " + firstLine(input->geterror()));
  const bool decode = !spec.format.is_floating_point();
  for (std::size_t i = 0; i < count; ++i)
    for (int c = 0; c < 3; ++c) {
      const float value = values[i * channels + (colour ? c : 0)];
      image.pixels[i][c] = decode ? linearOf(value) : value;
    }
  return image;
}

}  // namespace copse
