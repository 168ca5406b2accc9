// Differences per pixel, per block and as the eye sees them.
#include "tracer/image/compare.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <limits>

#include "builder/base/error.h"
#include "tracer/image/flip.h"
#include "tracer/scene/colour.h"

namespace copse {

namespace {

constexpr int blockSide = 16, minPixels = 64;

/// What the eye could be shown: what is negative or not finite as 0.
Image showable(const Image& image) {
  Image shown = image;
  for (vec3& p : shown.pixels)
    for (int c = 0; c < 3; ++c) p[c] = p[c] > 0 && std::isfinite(p[c]) ? p[c] : 0;
  return shown;
}

/// The mean of a-b over its standard error; false where too few pixels are finite.
bool blockScore(const Image& a, const Image& b, int x0, int y0, double& score) {
  double sum = 0, squares = 0, brightness = 0;
  int count = 0;
  for (int y = y0; y < std::min(y0 + blockSide, a.height); ++y)
    for (int x = x0; x < std::min(x0 + blockSide, a.width); ++x) {
      const vec3 &p = a.at(x, y), &q = b.at(x, y);
      if (!isFinite(p) || !isFinite(q)) continue;
      double difference = 0;
      for (int c = 0; c < 3; ++c) {
        difference += (double{p[c]} - q[c]) / 3;
        brightness += (std::abs(double{p[c]}) + std::abs(double{q[c]})) / 6;
      }
      sum += difference;
      squares += difference * difference;
      ++count;
    }
  if (count < minPixels) return false;
  const double mean = sum / count, variance = std::max(0.0, squares / count - mean * mean) / (count - 1);
  const double rounding = 1e-6 * brightness / count;  // That of floats, where there is no noise at all.
  const double error = std::sqrt(variance + rounding * rounding);
  score = error > 0 ? mean / error : 0;
  return true;
}

void compareBlocks(const Image& a, const Image& b, Difference& result) {
  double sum = 0, squares = 0, score = 0;
  for (int y = 0; y < a.height; y += blockSide)
    for (int x = 0; x < a.width; x += blockSide) {
      if (!blockScore(a, b, x, y, score)) continue;
      ++result.blocks;
      sum += score;
      squares += score * score;
      result.blockWorst = std::max(result.blockWorst, std::abs(score));
    }
  if (result.blocks == 0) return;
  result.blockRms = std::sqrt(squares / result.blocks);
  result.blockBias = sum / std::sqrt(double(result.blocks));
}

}  // namespace

vec3 heatColour(float value) {
  static const vec3 stops[6] = {{0.00f, 0.00f, 0.03f}, {0.20f, 0.07f, 0.42f}, {0.52f, 0.14f, 0.50f},
                                {0.84f, 0.28f, 0.38f}, {0.98f, 0.62f, 0.32f}, {1.00f, 0.98f, 0.78f}};
  const float place = 5 * (value > 0 ? std::min(value, 1.0f) : 0);
  const int below = std::min(static_cast<int>(place), 4);
  const vec3 shown = glm::mix(stops[below], stops[below + 1], place - below);
  // The stops are what a screen is sent; an Image is linear.
  return {linearOfScreen(shown.x), linearOfScreen(shown.y), linearOfScreen(shown.z)};
}

Difference compareImages(const Image& a, const Image& b, Image* flipMap) {
  if (a.width != b.width || a.height != b.height)
    throw InputError(fmt::format("image sizes differ: {} x {} and {} x {}", a.width, a.height, b.width, b.height));
  if (a.pixels.empty()) throw InputError("cannot compare images without pixels");

  Difference result;
  double squares = 0, relative = 0;
  int64_t good = 0;
  bool alone = false;
  for (std::size_t i = 0; i < a.pixels.size(); ++i) {
    const bool finiteA = isFinite(a.pixels[i]), finiteB = isFinite(b.pixels[i]);
    if (!finiteA || !finiteB) {
      ++result.badPixels;
      alone = alone || finiteA != finiteB;
      continue;
    }
    ++good;
    for (int c = 0; c < 3; ++c) {
      const double p = a.pixels[i][c], q = b.pixels[i][c], square = (p - q) * (p - q);
      squares += square;
      relative += square / (q * q + 0.01);
      result.maxError = std::max(result.maxError, std::abs(p - q));
      result.meanA += p;
      result.meanB += q;
    }
  }
  if (good > 0) {
    result.rmse = std::sqrt(squares / (3 * good));
    result.relMse = relative / (3 * good);
    result.meanA /= 3 * good;
    result.meanB /= 3 * good;
  }
  if (alone) result.rmse = result.relMse = result.maxError = std::numeric_limits<double>::infinity();
  compareBlocks(a, b, result);

  std::vector<float> seen = flipHdr(showable(a), showable(b));
  for (std::size_t i = 0; i < seen.size(); ++i) {
    if (isFinite(a.pixels[i]) != isFinite(b.pixels[i])) seen[i] = 1;
    result.flip += seen[i];
  }
  result.flip /= static_cast<double>(seen.size());
  if (flipMap) {
    *flipMap = {a.width, a.height, std::vector<vec3>(seen.size())};
    std::transform(seen.begin(), seen.end(), flipMap->pixels.begin(), heatColour);
  }
  return result;
}

}  // namespace copse
