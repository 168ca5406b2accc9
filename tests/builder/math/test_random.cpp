// builder/math/random.h and the tables that choose by weight: even, and free of correlation between neighbours.
#include <cmath>
#include <functional>
#include <vector>

#include "builder/math/random.h"
#include "tests/support/catch.h"
#include "tracer/materials/sampling.h"

using namespace copse;

namespace {

/// Chi-square of `counts` against expectations, as standard deviations above what chance gives (Wilson-Hilferty).
double chiSquareSigmas(const std::vector<double>& counts, const std::vector<double>& expected) {
  double sum = 0, freedom = -1;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    if (expected[i] == 0) continue;
    sum += (counts[i] - expected[i]) * (counts[i] - expected[i]) / expected[i];
    freedom += 1;
  }
  const double spread = 2 / (9 * freedom);
  return (std::cbrt(sum / freedom) - (1 - spread)) / std::sqrt(spread);
}

/// The ways in which an index can enter: as pixel, sample, bounce, dimension or seed, and both halves of the word.
struct Way {
  const char* name;
  std::function<uint64_t(uint32_t)> bits;
};

std::vector<Way> ways() {
  return {
      {"pixel", [](uint32_t i) { return randomBits(randomKey(1, i, 0), 1, 0); }},
      {"sample", [](uint32_t i) { return randomBits(randomKey(1, 77, i), 1, 0); }},
      {"bounce", [](uint32_t i) { return randomBits(randomKey(1, 77, 3), i, 0); }},
      {"dimension", [](uint32_t i) { return randomBits(randomKey(1, 77, 3), 2, i); }},
      {"seed", [](uint32_t i) { return randomBits(randomKey(i, 77, 3), 2, 5); }},
      {"far sample", [](uint32_t i) { return randomBits(randomKey(1, 77, (1ull << 40) + i), 1, 0); }},
  };
}

constexpr uint32_t draws = 1 << 17;

}  // namespace

TEST_CASE("Random numbers fill the unit interval evenly along every index") {
  for (const Way& way : ways()) {
    for (const int half : {0, 1}) {
      INFO(way.name << ", half " << half);
      std::vector<double> counts(1024), expected(1024, draws / 1024.0);
      for (uint32_t i = 0; i < draws; ++i) {
        const uint64_t bits = way.bits(i);
        const float u = unitFloat(half ? lowWord(bits) : highWord(bits));
        REQUIRE(u >= 0);
        REQUIRE(u < 1);
        ++counts[static_cast<std::size_t>(u * 1024)];
      }
      const double sigmas = chiSquareSigmas(counts, expected);
      CHECK(std::abs(sigmas) < 4.5);
    }
  }
}

TEST_CASE("Neighbouring random numbers are uncorrelated and fill the square evenly") {
  for (const Way& way : ways()) {
    for (const uint32_t step : {1u, 2u, 1024u}) {
      INFO(way.name << ", step " << step);
      std::vector<double> counts(32 * 32), expected(32 * 32, draws / 1024.0);
      double covariance = 0;
      for (uint32_t i = 0; i < draws; ++i) {
        const float a = unitFloat(highWord(way.bits(i))), b = unitFloat(highWord(way.bits(i + step)));
        covariance += (a - 0.5) * (b - 0.5) / draws;
        ++counts[static_cast<std::size_t>(a * 32) * 32 + static_cast<std::size_t>(b * 32)];
      }
      // The product of two centred uniforms has a standard deviation of 1/12.
      CHECK(std::abs(covariance) * 12 * std::sqrt(draws) < 4.5);
      const double sigmas = chiSquareSigmas(counts, expected);
      CHECK(std::abs(sigmas) < 4.5);
    }
  }
}

TEST_CASE("The two halves of a random word fill the square evenly") {
  for (const Way& way : ways()) {
    INFO(way.name);
    std::vector<double> counts(32 * 32), expected(32 * 32, draws / 1024.0);
    for (uint32_t i = 0; i < draws; ++i) {
      const uint64_t bits = way.bits(i);
      ++counts[(highWord(bits) >> 27) * 32 + (lowWord(bits) >> 27)];
    }
    const double sigmas = chiSquareSigmas(counts, expected);
    CHECK(std::abs(sigmas) < 4.5);
  }
}

TEST_CASE("One bit of any index flips half of the bits of a random word") {
  for (int word = 0; word < 3; ++word) {
    for (int bit = 0; bit < 32; ++bit) {
      double flips = 0;
      for (uint64_t i = 0; i < 512; ++i) {
        uint64_t index[3] = {i, i * 3, i * 7};
        const uint64_t before = randomBits(randomKey(index[0], index[1], index[2]), 1, 1);
        index[word] ^= 1ull << bit;
        flips += __builtin_popcountll(before ^ randomBits(randomKey(index[0], index[1], index[2]), 1, 1));
      }
      INFO("word " << word << ", bit " << bit);
      // 512 draws of 64 bits: the mean of 32 has a standard error of 4 / sqrt(512).
      CHECK(std::abs(flips / 512 - 32) < 5 * 4 / std::sqrt(512.0));
    }
  }
}

TEST_CASE("An alias table picks each entry by its weight and never one of weight 0") {
  std::vector<double> weights{0, 1, 5, 0, 0.01, 1e3, 0, 7, 2, 2, 0, 0.5};
  for (int extra = 0; extra < 100; ++extra) weights.push_back(extra % 7);
  double sum = 0;
  for (const double w : weights) sum += w;
  const auto cells = aliasTable(weights);
  REQUIRE(cells.size() == weights.size());
  std::vector<double> counts(weights.size()), expected;
  const uint32_t n = 1 << 20;
  for (const double w : weights) expected.push_back(w / sum * n);
  for (uint32_t i = 0; i < n; ++i)
    ++counts[pick(cells.data(), static_cast<uint32_t>(cells.size()), randomBits(randomKey(3, i, 0), 0, 0))];
  for (std::size_t i = 0; i < weights.size(); ++i) {
    CHECK(cells[i].probability == Approx(weights[i] / sum));
    if (weights[i] == 0) CHECK(counts[i] == 0);
  }
  CHECK(chiSquareSigmas(counts, expected) < 4.5);
}

TEST_CASE("An alias table of nothing, of zeros or of numbers that are not finite is empty or leaves them out") {
  const double infinite = INFINITY, none = NAN;
  CHECK(aliasTable(std::vector<double>{}).empty());
  CHECK(aliasTable(std::vector<double>{0, 0}).empty());
  CHECK(aliasTable(std::vector<double>{-1, none, infinite}).empty());
  const auto cells = aliasTable(std::vector<double>{none, 3, -2, infinite});
  REQUIRE(cells.size() == 4);
  for (uint64_t i = 0; i < 1000; ++i) REQUIRE(pick(cells.data(), 4, mixBits(i)) == 1);
}

TEST_CASE("Directions about a normal are unit vectors whose cosine has mean 2/3 and whose azimuth is even") {
  for (const vec3 axis : {vec3(0, 0, 1), vec3(0, 0, -1), vec3(1, 0, 0), vec3(-1, 2, -3), vec3(1e-4f, 1e-4f, -1)}) {
    const vec3 n = glm::normalize(axis);
    glm::dvec3 sum(0);
    const int count = 1 << 16;
    for (int i = 0; i < count; ++i) {
      float cosine;
      const vec3 d = cosineDirection(n, randomBits(randomKey(1, static_cast<uint64_t>(i), 0), 0, 0), cosine);
      REQUIRE(glm::length(d) == Approx(1).margin(1e-5));
      REQUIRE(glm::dot(d, n) == Approx(cosine).margin(1e-5));
      REQUIRE(cosine > 0);
      sum += glm::dvec3(d);
    }
    const glm::dvec3 mean = sum / static_cast<double>(count);
    const glm::dvec3 expected = glm::dvec3(n) * (2 / 3.0);
    CHECK(glm::length(mean - expected) < 5 * 0.6 / std::sqrt(count));
  }
}
