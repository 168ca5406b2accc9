// Andersson et al., "FLIP: A Difference Evaluator for Alternating Images", 2020, and for renders Andersson et al.,
// "Visualizing Errors in Rendered High Dynamic Range Images", 2021. Colours are blurred as the eye blurs them and
// compared in a uniform colour space; edges and points that only one image has make the difference larger.
// Tile by tile, eight separable convolutions per image; the memory is a tile's, whatever the image.
#include "tracer/image/flip.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

namespace copse {

namespace {

constexpr double pi = std::numbers::pi;
constexpr int tileSide = 128;

using Plane = std::vector<float>;
using Taps = std::vector<float>;

// IEC 61966-2-1: linear RGB to XYZ under D65, and the white that (1, 1, 1) becomes.
constexpr float xyzOfRgb[3][3] = {
    {0.4123908f, 0.3575843f, 0.1804808f}, {0.2126390f, 0.7151687f, 0.0721923f}, {0.0193308f, 0.1191948f, 0.9505322f}};
constexpr float white[3] = {xyzOfRgb[0][0] + xyzOfRgb[0][1] + xyzOfRgb[0][2],
                            xyzOfRgb[1][0] + xyzOfRgb[1][1] + xyzOfRgb[1][2],
                            xyzOfRgb[2][0] + xyzOfRgb[2][1] + xyzOfRgb[2][2]};
constexpr float rgbOfXyz[3][3] = {{3.2409699f, -1.5373832f, -0.4986108f},
                                  {-0.9692436f, 1.8759675f, 0.0415551f},
                                  {0.0556301f, -0.2039770f, 1.0569715f}};

vec3 multiply(const float (&m)[3][3], const vec3& v) {
  return {m[0][0] * v.x + m[0][1] * v.y + m[0][2] * v.z, m[1][0] * v.x + m[1][1] * v.y + m[1][2] * v.z,
          m[2][0] * v.x + m[2][1] * v.y + m[2][2] * v.z};
}

/// XYZ over that of white.
vec3 relativeXyz(const vec3& rgb) {
  const vec3 xyz = multiply(xyzOfRgb, rgb);
  return {xyz.x / white[0], xyz.y / white[1], xyz.z / white[2]};
}

/// The linear opponent space that the eye's blur is known in.
vec3 yCxCzOf(const vec3& rgb) {
  const vec3 r = relativeXyz(rgb);
  return {116 * r.y - 16, 500 * (r.x - r.y), 200 * (r.y - r.z)};
}

vec3 rgbOfYCxCz(const vec3& c) {
  const float y = (c.x + 16) / 116;
  const vec3 rgb = multiply(rgbOfXyz, {(y + c.y / 500) * white[0], y * white[1], (y - c.z / 200) * white[2]});
  return glm::clamp(rgb, 0.0f, 1.0f);
}

/// CIELAB with Hunt's adjustment: dark colours have less chroma.
vec3 huntLabOf(const vec3& rgb) {
  const auto f = [](float t) { return t > 216.0f / 24389 ? std::cbrt(t) : (24389.0f / 27 * t + 16) / 116; };
  const vec3 r = relativeXyz(rgb);
  const float fx = f(r.x), fy = f(r.y), fz = f(r.z), lightness = 116 * fy - 16;
  return {lightness, 0.01f * lightness * 500 * (fx - fy), 0.01f * lightness * 200 * (fy - fz)};
}

float hyAb(const vec3& a, const vec3& b) { return std::abs(a.x - b.x) + std::hypot(a.y - b.y, a.z - b.z); }

/// What the eye does at this many pixels per degree, as one-dimensional taps of one radius.
struct Eye {
  explicit Eye(double ppd) {
    // Contrast sensitivity, Section 4.1.1: sums of a sqrt(pi/b) exp(-pi² x²/b), x in degrees.
    csfRadius = static_cast<int>(std::ceil(3 * std::sqrt(0.04 / (2 * pi * pi)) * ppd));
    const double sigma = 0.5 * 0.082 * ppd;  // For the feature detectors, Section 4.2.
    const int featureRadius = static_cast<int>(std::ceil(3 * sigma));
    radius = std::max(csfRadius, featureRadius);
    const double b[4] = {0.0047, 0.0053, 0.04, 0.025};
    double sum[4] = {0, 0, 0, 0};
    for (int k = 0; k < 4; ++k) {
      csf[k].assign(2 * radius + 1, 0);
      for (int i = -csfRadius; i <= csfRadius; ++i) {
        const double value = std::exp(-pi * pi * (i / ppd) * (i / ppd) / b[k]);
        csf[k][radius + i] = static_cast<float>(value);
        sum[k] += value;
      }
    }
    for (int k = 0; k < 2; ++k) achromaticAndRedGreen[k] = static_cast<float>(1 / (sum[k] * sum[k]));
    const double w2 = 34.1 * std::sqrt(pi / b[2]), w3 = 13.5 * std::sqrt(pi / b[3]);
    const double whole = w2 * sum[2] * sum[2] + w3 * sum[3] * sum[3];
    blueYellow[0] = static_cast<float>(w2 / whole);
    blueYellow[1] = static_cast<float>(w3 / whole);

    Taps* all[3] = {&gauss, &edge, &point};
    for (Taps* taps : all) taps->assign(2 * radius + 1, 0);
    for (int i = -featureRadius; i <= featureRadius; ++i) {
      const double g = std::exp(-i * i / (2 * sigma * sigma));
      gauss[radius + i] = static_cast<float>(g);
      edge[radius + i] = static_cast<float>(-i * g);
      point[radius + i] = static_cast<float>((i * i / (sigma * sigma) - 1) * g);
    }
    for (Taps* taps : all) {  // Positive taps sum to 1 and negative ones to -1.
      double positive = 0, negative = 0;
      for (const float tap : *taps) (tap > 0 ? positive : negative) += tap;
      for (float& tap : *taps) tap = static_cast<float>(tap > 0 ? tap / positive : tap < 0 ? -tap / negative : 0);
    }
    cMax = std::pow(hyAb(huntLabOf({0, 1, 0}), huntLabOf({0, 0, 1})), 0.7f);
  }

  int csfRadius, radius;
  std::array<Taps, 4> csf;  // Achromatic, red-green, and two for blue-yellow.
  float achromaticAndRedGreen[2], blueYellow[2];
  Taps gauss, edge, point;
  float cMax;
};

/// A tile of one image with a margin of the eye's radius; beyond the image its border repeats.
class Tile {
 public:
  Tile(const Eye& eye, const Image& image, int x0, int y0, int width, int height)
      : eye_(eye), width_(width), height_(height), paddedWidth_(width + 2 * eye.radius) {
    for (Plane& plane : padded_) plane.reserve(paddedWidth_ * static_cast<std::size_t>(height + 2 * eye.radius));
    for (int y = y0 - eye.radius; y < y0 + height + eye.radius; ++y)
      for (int x = x0 - eye.radius; x < x0 + width + eye.radius; ++x) {
        const vec3 c = yCxCzOf(image.at(std::clamp(x, 0, image.width - 1), std::clamp(y, 0, image.height - 1)));
        for (int k = 0; k < 3; ++k) padded_[k].push_back(c[k]);
      }
  }

  /// Blurred by contrast sensitivity, in Hunt-adjusted CIELAB.
  std::vector<vec3> blurred() const {
    const Plane y = convolve(padded_[0], eye_.csf[0], eye_.csf[0]), cx = convolve(padded_[1], eye_.csf[1], eye_.csf[1]);
    const Plane wide = convolve(padded_[2], eye_.csf[2], eye_.csf[2]);
    const Plane slim = convolve(padded_[2], eye_.csf[3], eye_.csf[3]);
    std::vector<vec3> lab(y.size());
    for (std::size_t i = 0; i < y.size(); ++i)
      lab[i] = huntLabOf(rgbOfYCxCz({y[i] * eye_.achromaticAndRedGreen[0], cx[i] * eye_.achromaticAndRedGreen[1],
                                     wide[i] * eye_.blueYellow[0] + slim[i] * eye_.blueYellow[1]}));
    return lab;
  }

  /// How much of an edge (first derivatives) or a point (second derivatives) there is, on luminance in 0 … 1.
  Plane features(const Taps& derivative) const {
    const Plane across = convolve(padded_[0], derivative, eye_.gauss);
    const Plane down = convolve(padded_[0], eye_.gauss, derivative);
    Plane strength(across.size());
    for (std::size_t i = 0; i < across.size(); ++i) strength[i] = std::hypot(across[i], down[i]) / 116;
    return strength;
  }

 private:
  Plane convolve(const Plane& padded, const Taps& acrossTaps, const Taps& downTaps) const {
    const int rows = height_ + 2 * eye_.radius, taps = 2 * eye_.radius + 1;
    Plane across(static_cast<std::size_t>(width_) * rows, 0.0f);
    Plane result(static_cast<std::size_t>(width_) * height_, 0.0f);
    for (int y = 0; y < rows; ++y)
      for (int k = 0; k < taps; ++k)
        for (int x = 0; x < width_; ++x) across[y * width_ + x] += acrossTaps[k] * padded[y * paddedWidth_ + x + k];
    for (int y = 0; y < height_; ++y)
      for (int k = 0; k < taps; ++k)
        for (int x = 0; x < width_; ++x) result[y * width_ + x] += downTaps[k] * across[(y + k) * width_ + x];
    return result;
  }

  const Eye& eye_;
  int width_, height_, paddedWidth_;
  std::array<Plane, 3> padded_;
};

/// Section 4.1.3: differences up to 0.4 of the largest take 0.95 of the range.
float redistribute(float difference, float cMax) {
  const float power = std::pow(difference, 0.7f), knee = 0.4f * cMax;
  return power < knee ? 0.95f / knee * power : 0.95f + (power - knee) / (cMax - knee) * 0.05f;
}

/// Narkowicz's fit of the ACES curve, with its exposure of 0.6.
float aces(float x) {
  x = 0.6f * std::min(x, 1e6f);
  return std::clamp(x * (2.51f * x + 0.03f) / (x * (2.43f * x + 0.59f) + 0.14f), 0.0f, 1.0f);
}

float luminance(const vec3& rgb) { return multiply(xyzOfRgb, rgb).y; }

}  // namespace

std::vector<float> flip(const Image& a, const Image& b, double pixelsPerDegree) {
  const Eye eye(pixelsPerDegree);
  std::vector<float> result(a.pixels.size());
  const int columns = (a.width + tileSide - 1) / tileSide, rows = (a.height + tileSide - 1) / tileSide;
#pragma omp parallel for schedule(dynamic, 1)
  for (int t = 0; t < columns * rows; ++t) {
    const int x0 = t % columns * tileSide, y0 = t / columns * tileSide;
    const int width = std::min(tileSide, a.width - x0), height = std::min(tileSide, a.height - y0);
    const Tile tileA(eye, a, x0, y0, width, height), tileB(eye, b, x0, y0, width, height);
    const std::vector<vec3> labA = tileA.blurred(), labB = tileB.blurred();
    const Plane edgeA = tileA.features(eye.edge), edgeB = tileB.features(eye.edge);
    const Plane pointA = tileA.features(eye.point), pointB = tileB.features(eye.point);
    for (int i = 0; i < width * height; ++i) {
      const float colour = redistribute(hyAb(labA[i], labB[i]), eye.cMax);
      const float feature = std::sqrt(std::max(std::abs(edgeA[i] - edgeB[i]), std::abs(pointA[i] - pointB[i])) /
                                      std::numbers::sqrt2_v<float>);
      const float whole = std::pow(colour, 1 - std::min(feature, 1.0f));
      result[static_cast<std::size_t>(y0 + i / width) * a.width + x0 + i % width] = std::min(whole, 1.0f);
    }
  }
  return result;
}

std::vector<float> flipHdr(const Image& image, const Image& reference, double pixelsPerDegree) {
  std::vector<float> luminances(reference.pixels.size());
  std::transform(reference.pixels.begin(), reference.pixels.end(), luminances.begin(), luminance);
  const auto middle = luminances.begin() + static_cast<std::ptrdiff_t>(luminances.size() / 2);
  std::nth_element(luminances.begin(), middle, luminances.end());
  const float largest = *std::max_element(middle, luminances.end());
  // Where the curve gives 0.85: the first exposure shows the brightest pixel so, the last the median, and between them
  // are steps of about a stop. A median that is next to black would ask for any number of stops.
  const double bright = 2.1193;
  double first = 0, last = 0;
  if (largest > 0) {
    first = std::log2(bright / largest);
    last = std::log2(bright / std::max<double>(*middle, largest * 0x1p-16));
  }
  const int count = std::max(2, static_cast<int>(std::ceil(last - first)));

  std::vector<float> result(image.pixels.size(), 0.0f);
  for (int i = 0; i < count; ++i) {
    const double exposure = first + (last - first) * i / (count - 1);
    const auto shown = [&](const Image& from) {
      const float scale = static_cast<float>(std::exp2(exposure));
      Image to = from;
      for (vec3& p : to.pixels) p = {aces(scale * p.x), aces(scale * p.y), aces(scale * p.z)};
      return to;
    };
    const std::vector<float> difference = flip(shown(image), shown(reference), pixelsPerDegree);
    for (std::size_t k = 0; k < result.size(); ++k) result[k] = std::max(result[k], difference[k]);
  }
  return result;
}

}  // namespace copse
