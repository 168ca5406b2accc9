// The film beside sums made one sample after another on the host.
#include <cmath>
#include <cstring>

#include "builder/math/vec.h"
#include "tests/support/catch.h"
#include "tests/support/devices.h"
#include "tracer/integrators/film.h"

using namespace copse;
using namespace copse::test;

namespace {

HD inline vec3 valueOf(uint32_t pixel, uint64_t number) {
  const float n = static_cast<float>(number), p = static_cast<float>(pixel + 1);
  return {p / (n + 3), n * 0.37f, 1 / p};
}

struct Value {
  uint64_t* wrongPlaces;
  uint64_t first;
  uint32_t pixels;
  const uint32_t* pixelAt;
  HD vec3 operator()(const FilmSample& sample) const {
    const uint64_t sampleOfAll = first + sample.place;
    if (sample.number != sampleOfAll / pixels || sample.pixel != pixelAt[sampleOfAll % pixels]) *wrongPlaces = 1;
    return valueOf(sample.pixel, sample.number);
  }
};

struct CountSamples {
  uint64_t* counts;
  HD void operator()(uint32_t pixel, const vec3&, uint64_t samples) const { counts[pixel] = samples; }
};

struct Tenth {
  HD vec3 operator()(const FilmSample&) const { return vec3(0.1f); }
};

bool same(const std::vector<vec3>& a, const std::vector<vec3>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(vec3)) == 0;
}

}  // namespace

TEST_CASE("A film adds the samples of a pixel in their order, whatever the batches") {
  constexpr uint32_t pixels = 9 * 3;
  constexpr uint64_t all = pixels * 20 + 25;  // All but the last two pixels have a sample more.
  for (const Device& device : devices()) {
    const PixelOrder order(device, 9, 3);
    std::vector<uint32_t> pixelAt(pixels);
    copyToHost(device, pixelAt.data(), order.pixelAt(), pixels * sizeof(uint32_t));
    std::vector<vec3> expected(pixels, vec3(0));
    std::vector<uint64_t> samples(pixels, 0);
    for (uint64_t i = 0; i < all; ++i) {
      expected[pixelAt[i % pixels]] += valueOf(pixelAt[i % pixels], i / pixels);
      ++samples[pixelAt[i % pixels]];
    }
    for (const uint32_t batch : {1u, 5u, 27u, 40u, 200u}) {
      INFO(batch << " samples at a time");
      Film<vec3> film(device, order);
      Buffer<uint64_t> wrong(device, 1), counts(device, pixels);
      wrong.fill(0);
      for (uint64_t first = 0; first < all; first += batch) {
        const auto count = static_cast<uint32_t>(std::min<uint64_t>(batch, all - first));
        film.add(device, "add", first, count, Value{wrong.data(), first, pixels, order.pixelAt()});
      }
      CHECK(wrong.read(0) == 0);
      CHECK(same(film.sums().toHost(), expected));
      film.finish(device, "finish", all, CountSamples{counts.data()});
      CHECK(counts.toHost() == samples);
    }
  }
}

TEST_CASE("A compensated film keeps what rounding takes from a million samples") {
  constexpr uint32_t count = 1 << 20;
  for (const Device& device : devices())
    for (const bool compensated : {false, true}) {
      const PixelOrder order(device, 1, 1);
      Film<vec3> film(device, order, compensated ? 0 : Film<vec3>::never);
      film.add(device, "add", 0, count / 2, Tenth{});
      film.add(device, "add", count / 2, count / 2, Tenth{});
      const double mean = double{film.sums().read(0).y} / count, exact = double{0.1f};
      const double off = std::abs(mean - exact) / exact;
      CHECK(compensated == (off < 1e-6));
    }
}

TEST_CASE("A film that is restored goes on bit for bit, and compensates samples by their numbers") {
  constexpr uint32_t count = 5000, from = 1000;
  for (const Device& device : devices()) {
    const PixelOrder order(device, 1, 1);
    const auto sumOf = [&](uint64_t exactFrom, uint32_t samples) {
      Film<vec3> film(device, order, exactFrom);
      film.add(device, "add", 0, samples, Tenth{});
      return film.sums().read(0);
    };
    Film<vec3> one(device, order, from);
    one.add(device, "add", 0, count, Tenth{});
    const vec3 whole = one.sums().read(0);
    CHECK(whole != sumOf(Film<vec3>::never, count));
    CHECK(whole != sumOf(0, count));
    CHECK(sumOf(from, from) == sumOf(Film<vec3>::never, from));
    for (const uint32_t split : {1u, from - 1, from, from + 1, 3333u}) {
      INFO(split);
      Film<vec3> first(device, order, split > from ? from : Film<vec3>::never), second(device, order, from);
      first.add(device, "add", 0, split, Tenth{});
      second.restore(first.sums().toHost(), first.lost().toHost());
      second.add(device, "add", split, count - split, Tenth{});
      CHECK(second.sums().read(0) == whole);
      CHECK(second.lost().read(0) == one.lost().read(0));
    }
  }
}
