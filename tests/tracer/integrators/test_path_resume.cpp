// A path render that goes on from the film of another: the image is that of one render, bit for bit.
#include <atomic>
#include <cstring>

#include "tests/support/catch.h"
#include "tests/support/devices.h"
#include "tests/support/path_scenes.h"

using namespace copse;
using namespace copse::test;

namespace {

Scene ballInBox() {
  SceneMaker maker;
  maker.box({-2, 0, -2}, {2, 3, 2}, maker.material({0.7f, 0.6f, 0.5f}), 5);
  maker.sphere({0.3f, 0.9f, 0}, 0.8f, 1, maker.material({0.3f, 0.6f, 0.9f}));
  maker.scene.quads.push_back({{-0.5f, 2.9f, -0.5f}, {1, 0, 0}, {0, 0, 1}, {6, 6, 5}});
  maker.sky({0.3f, 0.4f, 0.5f});
  return maker.scene;
}

const Camera view = lookAt({0.3f, 1.4f, 4.5f}, {0, 1.2f, 0}, 45);

/// The film of a render that is stopped after `batches` batches of `queue` paths.
FilmState stoppedAfter(const Traced& traced, const RenderSettings& wanted, int batches, uint32_t queue) {
  std::atomic<bool> stop = false;
  int done = 0;
  const PathResult result = traced.render(view, wanted, {.queue = queue},
                                          {[&](double) {
                                             if (++done == batches) stop = true;
                                           },
                                           &stop});
  REQUIRE(result.film);
  REQUIRE(result.film->samples == static_cast<uint64_t>(batches) * queue);
  return *result.film;
}

bool sameBytes(const std::vector<vec3>& a, const std::vector<vec3>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(vec3)) == 0;
}

}  // namespace

TEST_CASE("A render that goes on from a stopped one gives the image of one render bit for bit") {
  const Scene scene = ballInBox();
  const RenderSettings wanted = settings(19, 13, 7, 5, 3);
  for (const Device& device : devices()) {
    const Traced traced(device, scene), other(device.isCuda() ? device : openDevice("cpu", 3), scene);
    const PathResult whole = traced.render(view, wanted, {.surfaces = true});
    CHECK_FALSE(whole.film);  // Of a render that was neither stopped nor is to be gone on from nothing is kept.
    const uint32_t pass = 19 * 13;
    for (const auto& [batches, queue] : {std::pair{1, 1u}, {3, 50u}, {2, pass}, {4, 400u}, {7 * 19 * 13 - 1, 1u}}) {
      if (queue == 1 && batches > 1 && device.isCuda()) continue;
      INFO(batches << " batches of " << queue);
      const FilmState film = stoppedAfter(traced, wanted, batches, queue);
      const PathResult rest = other.render(view, wanted, {.queue = 333, .surfaces = true, .from = &film});
      CHECK(rest.samplesDone == 7);
      CHECK(sameBytes(rest.image.pixels, whole.image.pixels));
      CHECK(sameBytes(rest.surfaces->normals.pixels, whole.surfaces->normals.pixels));
      CHECK(rest.surfaces->depth == whole.surfaces->depth);
      REQUIRE(rest.film);
      CHECK(rest.film->samples == uint64_t{7} * pass);
      CHECK(rest.rays.primary == uint64_t{7} * pass);  // Those before once more, for the surfaces.
      CHECK(rest.rays.shadow < whole.rays.shadow);
    }
  }
}

TEST_CASE("More samples may be added any number of times, also where sums begin to be compensated") {
  const Scene scene = ballInBox();
  const RenderSettings all = settings(3, 2, 1100, 3);
  for (const Device& device : devices()) {
    if (isEmulated(device)) continue;
    const Traced traced(device, scene);
    const Image whole = traced.render(view, all).image;
    FilmState film;
    PathResult last;
    for (const int spp : {1, 700, 1024, 1025, 1050, 1100}) {
      RenderSettings part = all;
      part.spp = spp;
      last = traced.render(view, part, {.from = &film});
      film = last.film.value();
      CHECK(film.lost.empty() == (spp <= 1024));
    }
    CHECK(sameBytes(last.image.pixels, whole.pixels));
  }
}
