// The clusters of a k-means pass against the builder's own tree and against their definition; their picture against
// rays traced one by one; boxes on the screen against all their edges.

#include <cmath>
#include <cstring>
#include <map>
#include <set>

#include "builder/build.h"
#include "builder/methods/kmeans/build.h"
#include "builder/methods/kmeans/pass_clusters.h"
#include "tests/support/catch.h"
#include "tests/support/devices.h"
#include "tests/support/inputs.h"
#include "tests/support/path_scenes.h"
#include "tracer/integrators/clusters/box_lines.h"
#include "tracer/integrators/clusters/clusters.h"

using namespace copse;
using namespace copse::test;

namespace {

Parameters parameters(const std::vector<std::string>& settings = {}) {
  Parameters chosen;
  for (const std::string& setting : settings) chosen.set(setting);
  return withPreset(findBuilder("kmeans-q2"), chosen);
}

/// A builder's input, and what owns it.
struct Input {
  OwnedPrimitives owned;
  Primitives of;

  Input(const Device& device, const TrianglesView& triangles)
      : owned(primitivesOf(device, triangles)), of(owned.view()) {}
};

/// As points in R^6, in the scene's unit.
double squaredDistance(const Box& a, const Box& b) {
  double sum = 0;
  for (int d = 0; d < 3; ++d) {
    sum += (double{a.lo[d]} - b.lo[d]) * (double{a.lo[d]} - b.lo[d]);
    sum += (double{a.hi[d]} - b.hi[d]) * (double{a.hi[d]} - b.hi[d]);
  }
  return sum;
}

/// Balls in a row and a floor.
Scene balls() {
  SceneMaker maker;
  const uint32_t grey = maker.material(vec3(0.5f));
  for (int i = 0; i < 5; ++i) maker.sphere({-4.0f + 2 * i, 1, 0.3f * i}, 0.8f, 3, grey);
  maker.parallelogram({-6, 0, -3}, {0, 0, 6}, {12, 0, 0}, grey);
  return maker.scene;
}

const Camera ballsView = lookAt({0, 3, 9}, {0, 0.8f, 0}, 60);

}  // namespace

TEST_CASE("Clusters are those of the builder's tree: each is one range of its order") {
  for (const Device& device : devices())
    for (const std::string name : {"random", "grid", "two-clusters", "one-huge"}) {
      const TestMesh mesh = makeInput(name, 3000);
      const DeviceMesh onDevice(device, mesh);
      const Input input(device, onDevice.view());
      const Parameters chosen = parameters();
      const std::vector<uint32_t> order =
          kmeans::build(device, input.of, kmeans::settingsOf(chosen)).order.toHost(mesh.count());
      std::vector<uint32_t> coarser;
      for (const uint32_t level : {1u, 2u, 3u, 50u}) {
        INFO(name << ", level " << level);
        const PassClusters clusters = kmeans::passClusters(device, input.of, chosen, level);
        const std::vector<uint32_t> of = clusters.clusterOf.toHost();
        REQUIRE(of.size() == mesh.count());
        CHECK(clusters.level <= level);
        uint32_t last = 0;
        std::set<uint32_t> found;
        for (const uint32_t triangle : order) {
          REQUIRE(of[triangle] >= last);
          last = of[triangle];
          found.insert(last);
        }
        CHECK(found.size() == clusters.representatives.size());
        CHECK(last + 1 == found.size());
        if (!coarser.empty()) {
          std::map<uint32_t, uint32_t> parent;
          for (uint32_t i = 0; i < mesh.count(); ++i)
            REQUIRE(parent.emplace(of[i], coarser[i]).first->second == coarser[i]);
        }
        coarser = of;
      }
    }
}

TEST_CASE("After the first pass every triangle is with the representative that is nearest to it") {
  const Device device = openDevice("cpu");
  const TestMesh mesh = makeInput("random", 4000);
  const Input input(device, mesh.hostView());
  for (const std::string k : {"2", "8", "13"}) {
    const PassClusters clusters = kmeans::passClusters(device, input.of, parameters({"kmeans.k=" + k}), 1);
    REQUIRE(clusters.level == 1);
    REQUIRE(clusters.representatives.size() == std::stoul(k));
    for (uint32_t i = 0; i < mesh.count(); ++i) {
      const Box box = input.of.boxes[i];
      const double own = squaredDistance(box, clusters.representatives[clusters.clusterOf.data()[i]]);
      for (const Box& other : clusters.representatives) REQUIRE(own <= squaredDistance(box, other) * (1 + 1e-4));
    }
  }
}

TEST_CASE("Too few triangles for a pass are one cluster, and no triangles are none") {
  const Device device = openDevice("cpu");
  const TestMesh mesh = makeInput("random", 10);
  const Input input(device, mesh.hostView());
  const PassClusters clusters = kmeans::passClusters(device, input.of, parameters(), 3);
  CHECK(clusters.level == 0);
  REQUIRE(clusters.representatives.size() == 1);
  CHECK(clusters.representatives[0].lo == input.of.bounds->lo);
  for (uint32_t i = 0; i < mesh.count(); ++i) CHECK(clusters.clusterOf.data()[i] == 0);
  CHECK(kmeans::passClusters(device, Primitives{}, parameters(), 1).representatives.empty());
}

TEST_CASE("Every pixel has the colour of the cluster whose triangle it shows") {
  const Scene scene = balls();
  const RenderSettings wanted = settings(60, 40, 1, 1, 5);
  for (const Device& device : devices()) {
    const Traced traced(device, scene);
    const Input input(device, trianglesOf(traced.scene()));
    const PassClusters clusters = kmeans::passClusters(device, input.of, parameters(), 2);
    REQUIRE(clusters.representatives.size() > 8);
    const ClusterPicture picture =
        renderClusters(device, traced.scene().view(), traced.tracer(), clusters, ballsView, wanted, false);
    CHECK(picture.samples == 60 * 40);

    const Device cpu = openDevice("cpu");
    const Traced onHost(cpu, scene);
    const Pinhole pinhole = makePinhole(ballsView, wanted.width, wanted.height);
    const std::vector<uint32_t> of = clusters.clusterOf.toHost();
    std::set<uint32_t> seen;
    int differing = 0;
    for (uint32_t i = 0; i < 60 * 40; ++i) {
      INFO("pixel " << i);
      const Ray ray = cameraRay(pinhole, 60, i, randomKey(wanted.seed, i, 0));
      Hit hit{};
      bruteForce(onHost.scene())->closest(cpu, "all", 1, &ray, &hit);
      const vec3 colour = picture.image.pixels[i];
      const float shown = picture.cluster[i],
                  expected = hit.triangle == Hit::none ? -1.0f : static_cast<float>(of[hit.triangle]);
      if (shown != expected) {  // A ray through an edge may go to either side.
        ++differing;
        continue;
      }
      if (shown < 0) {
        CHECK(colour == vec3(0));
        continue;
      }
      const vec3 own = clusterColour(static_cast<uint32_t>(shown));
      const float light = colour.x / own.x;
      REQUIRE((light > 0.149f && light < 1.001f));
      REQUIRE(colour.y == Approx(own.y * light).epsilon(1e-4));
      REQUIRE(colour.z == Approx(own.z * light).epsilon(1e-4));
      seen.insert(static_cast<uint32_t>(shown));
    }
    CHECK(differing < 10);
    CHECK(seen.size() > 8);
    // Numbers cannot be averaged: the first sample's is kept.
    RenderSettings more = wanted;
    more.spp = 5;
    CHECK(renderClusters(device, traced.scene().view(), traced.tracer(), clusters, ballsView, more, false).cluster ==
          picture.cluster);
  }
}

TEST_CASE("The picture of clusters is the same bit for bit for any number of threads and any size of the queue") {
  const Scene scene = balls();
  const RenderSettings wanted = settings(31, 20, 4, 1, 5);
  ClusterPicture expected;
  for (const int threads : {1, 2, 5}) {
    const Device device = openDevice("cpu", threads);
    const Traced traced(device, scene);
    const Input input(device, trianglesOf(traced.scene()));
    const PassClusters clusters = kmeans::passClusters(device, input.of, parameters(), 1);
    for (const uint32_t queue : {0u, 100u, 31u * 20u, 1000u}) {
      const ClusterPicture picture =
          renderClusters(device, traced.scene().view(), traced.tracer(), clusters, ballsView, wanted, true, {}, queue);
      if (expected.image.pixels.empty()) expected = picture;
      CHECK(identical(picture.image, expected.image));
      CHECK(picture.cluster == expected.cluster);
    }
  }
}

TEST_CASE("The colours of clusters that are near in number are far apart") {
  for (uint32_t i = 0; i < 64; ++i) {
    const vec3 a = clusterColour(i);
    for (int c = 0; c < 3; ++c) CHECK((a[c] > 0 && a[c] <= 1));
    for (uint32_t j = i + 1; j < i + 4; ++j) CHECK(glm::length(a - clusterColour(j)) > 0.2f);
  }
}

TEST_CASE("A representative is drawn as a box: full before a surface, faint behind it") {
  const Device device = chosenDevice();
  SceneMaker maker;  // A wall at z = 0, seen from z = 10.
  maker.parallelogram({-20, -20, 0}, {40, 0, 0}, {0, 40, 0}, maker.material(vec3(0.5f)));
  const Traced traced(device, maker.scene);
  const Camera camera = lookAt({0, 0, 10}, {0, 0, 0}, 60);
  const RenderSettings wanted = settings(200, 200, 2, 1);
  const auto render = [&](const std::vector<Box>& boxes) {
    PassClusters clusters;
    clusters.clusterOf = Buffer<uint32_t>(device, 2);
    clusters.clusterOf.fill(0);
    clusters.representatives = boxes;
    return renderClusters(device, traced.scene().view(), traced.tracer(), clusters, camera, wanted).image;
  };
  const auto box = [](vec3 lo, vec3 hi) {
    Box b;
    b.lo = lo;
    b.hi = hi;
    return b;
  };
  // At z = 5, 5 from the eye, 1 is 200 / (2 tan 30°) / 5 = 34.64 pixels; at z = -5 11.55 pixels.
  const float unit = 100 / std::tan(30 * float(M_PI) / 180);
  const auto column = [&](float x, float depth) { return static_cast<int>(100 + x * unit / depth); };
  const Image plain = render({Box{}});
  const Image front = render({box({-1, -1, 5}, {1, 1, 5})});
  const Image behind = render({box({-2, -2, -5}, {2, 2, -5})});
  const vec3 wall = plain.at(100, 100);
  CHECK(front.at(100, 100) == wall);
  CHECK(front.at(column(1, 5), 100).y > 0.6f);
  CHECK(front.at(column(-1, 5), 100).y > 0.6f);
  CHECK(front.at(100, column(1, 5)).y > 0.6f);
  CHECK(front.at(column(1, 5) + 6, 100) == plain.at(column(1, 5) + 6, 100));
  const vec3 faint = behind.at(column(2, 15), 100), under = plain.at(column(2, 15), 100);
  CHECK(faint.y > under.y + 0.1f);
  CHECK(faint.y < front.at(column(1, 5), 100).y - 0.1f);
  // Behind the eye, around it, beside the image, and no box at all.
  const vec3 far(1e30f);
  const Image odd = render({box({-1, -1, 11}, {1, 1, 12}), box({90, 0, 0}, {91, 1, 1}), box(-far, far), Box{}});
  CHECK(allFinite(odd));
  CHECK(identical(render({box({-1, -1, 11}, {1, 1, 12})}), plain));
}

TEST_CASE("The tiles miss no edge, and the image's border is in the last of them") {
  const Device device = openDevice("cpu");
  const TestMesh mesh = makeInput("random", 60);
  OwnedPrimitives primitives = primitivesOf(device, mesh.hostView());
  const Box bounds = *primitives.bounds();
  const vec3 middle = (bounds.lo + bounds.hi) * 0.5f;
  const Pinhole pinhole = makePinhole(lookAt(bounds.lo - (bounds.hi - bounds.lo) * 0.3f, middle, 70), 160, 96);
  const EdgesOnScreen edges(device, {primitives.boxes(), 60}, pinhole, 160, 96, 2.5f);
  const EdgesView tiled = edges.view();
  uint32_t count = 0;
  for (uint32_t i = 0; i < tiled.firstOf[10 * 6]; ++i) count = std::max(count, tiled.inTile[i] + 1);
  REQUIRE(count > 100);
  std::vector<uint32_t> firstOf{0}, all;
  for (int tile = 0; tile < 10 * 6; ++tile) {
    for (uint32_t i = 0; i < count; ++i) all.push_back(i);
    firstOf.push_back(static_cast<uint32_t>(all.size()));
  }
  const EdgesView whole{tiled.edges, firstOf.data(), all.data(), tiled.tilesAcross, tiled.tilesDown, tiled.halfWidth};
  int onLine = 0;
  for (int i = 0; i < 30000; ++i) {
    const uint64_t bits = randomBits(randomKey(1, 2, 3), static_cast<uint32_t>(i), 0);
    const float x = i % 10 == 0 ? 160 : 160 * unitFloat(highWord(bits));
    const float y = i % 15 == 0 ? 96 : 96 * unitFloat(lowWord(bits));
    const EdgeHit a = nearestEdge(tiled, x, y), b = nearestEdge(whole, x, y);
    REQUIRE((a.box == b.box && a.depth == b.depth && a.isRim == b.isRim));
    onLine += a.box != EdgeHit::none;
  }
  CHECK(onLine > 1000);
  CHECK(onLine < 29000);
}
