// What the camera sees of surfaces: their normals, albedo and depth, alone and with an image of light, and in files.
#include <cmath>
#include <cstring>

#include "builder/base/error.h"
#include "tests/support/catch.h"
#include "tests/support/devices.h"
#include "tests/support/files.h"
#include "tests/support/path_scenes.h"
#include "tests/support/textures.h"
#include "tracer/image/image_io.h"
#include "tracer/integrators/primary_rays.h"

using namespace copse;
using namespace copse::test;

namespace {

SurfaceBuffers buffersOf(const Traced& traced, const Device& device, const Camera& camera, const RenderSettings& wanted,
                         uint32_t queue = 0) {
  const SurfaceResult result =
      renderSurfaces(device, traced.scene().view(), traced.tracer(), camera, wanted, {}, queue);
  CHECK(result.samples == static_cast<uint64_t>(wanted.spp) * wanted.width * wanted.height);
  return result.buffers;
}

/// The x axis to the right, a wall at z = `z` that covers what is left of x = 0 for a camera at the origin.
Scene halfWall(float z, const vec3& kd = {0.2f, 0.4f, 0.6f}) {
  SceneMaker maker;
  maker.parallelogram({-50, -50, z}, {50, 0, 0}, {0, 100, 0}, maker.material(kd));
  maker.sky({1, 1, 1});
  return maker.scene;
}

const Camera alongMinusZ = lookAt({0, 0, 0}, {0, 0, -1}, 60);

bool same(const std::vector<float>& a, const std::vector<float>& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(float)) == 0;
}

bool same(const SurfaceBuffers& a, const SurfaceBuffers& b) {
  return identical(a.normals, b.normals) && identical(a.albedo, b.albedo) && same(a.depth, b.depth);
}

/// Surfaces of every direction, textured and plain, with sky between them.
Scene garden() {
  SceneMaker maker;
  const uint32_t textured = maker.material({0.2f, 0.2f, 0.9f});
  maker.scene.materials[textured].texture = 0;
  maker.scene.textures.push_back(textureOf({2, 2, {{0.9f, 0.1f, 0.1f}, {0.1f, 0.9f, 0.1f}, vec3(0.2f), vec3(0.8f)}}));
  maker.parallelogram({-3, 0, -3}, {0, 0, 6}, {6, 0, 0}, textured);
  maker.sphere({0, 1, 0}, 1, 2, maker.material({0.3f, 0.6f, 0.9f}));
  maker.scene.quads.push_back({{-0.5f, 2.9f, -0.5f}, {1, 0, 0}, {0, 0, 1}, {6, 6, 5}});
  maker.sky({0.3f, 0.4f, 0.5f});
  return maker.scene;
}

const Camera gardenView = lookAt({1, 2, 5}, {0, 0.8f, 0}, 50);

}  // namespace

TEST_CASE("The depth of a wall is its distance along the view, wherever on the image it is seen") {
  for (const Device& device : devices()) {
    const Traced traced(device, halfWall(-4));
    const SurfaceBuffers buffers = buffersOf(traced, device, alongMinusZ, settings(40, 30, 3, 1));
    for (int y = 0; y < 30; ++y)
      for (int x = 0; x < 40; ++x) {
        INFO("pixel " << x << ", " << y);
        const float z = buffers.depth[static_cast<std::size_t>(y) * 40 + x];
        if (x < 20)
          REQUIRE(z == Approx(4).epsilon(1e-5));
        else
          REQUIRE((std::isinf(z) && z > 0));
      }
  }
}

TEST_CASE("The normal of a wall faces the eye from either side, and is 0 where nothing is seen") {
  for (const Device& device : devices()) {
    for (const float z : {-4.0f, 4.0f}) {
      const Traced traced(device, halfWall(z));
      const Camera camera = lookAt({0, 0, 0}, {0, 0, z}, 60);
      const SurfaceBuffers buffers = buffersOf(traced, device, camera, settings(40, 30, 2, 1));
      const int wall = z < 0 ? 5 : 35, nothing = z < 0 ? 35 : 5;
      CHECK(buffers.normals.at(wall, 15) == vec3(0, 0, z < 0 ? 1 : -1));
      CHECK(buffers.normals.at(nothing, 15) == vec3(0));
      CHECK(buffers.albedo.at(nothing, 15) == vec3(0));
    }
  }
}

TEST_CASE("A slanted floor has its own unit normal") {
  SceneMaker maker;
  maker.parallelogram({-50, -30, 40}, {100, 0, 0}, {0, 60, -80}, maker.material(vec3(0.5f)));
  const Device device = chosenDevice();
  const Traced traced(device, maker.scene);
  const SurfaceBuffers buffers = buffersOf(traced, device, lookAt({0, 10, 0}, {0, 0, -1}, 40), settings(8, 8, 1, 1));
  for (const vec3& normal : buffers.normals.pixels) {
    CHECK(normal.x == Approx(0).margin(1e-6));
    CHECK(normal.y == Approx(0.8).epsilon(1e-5));
    CHECK(normal.z == Approx(0.6).epsilon(1e-5));
  }
}

TEST_CASE("Albedo is kd, a texture's mean over the pixel's samples, and shares the pixel with what is not hit") {
  const Device device = chosenDevice();
  const Traced wall(device, halfWall(-4));
  const RenderSettings wanted = settings(41, 31, 64, 1);
  const SurfaceBuffers buffers = buffersOf(wall, device, alongMinusZ, wanted);
  CHECK(buffers.albedo.at(3, 15).y == Approx(0.4).epsilon(1e-5));
  // The wall ends in the middle of the middle column: its share is the same in all buffers.
  const float share = buffers.albedo.at(20, 15).y / 0.4f;
  CHECK(share == Approx(0.5).margin(0.2));
  CHECK(buffers.normals.at(20, 15).z == Approx(share).epsilon(1e-4));
  CHECK(buffers.depth[15 * 41 + 20] == Approx(4).epsilon(1e-5));

  SceneMaker maker;
  const uint32_t striped = maker.material(vec3(0.9f));
  maker.scene.materials[striped].texture = 0;
  Image stripes{64, 1, std::vector<vec3>(64, vec3(0))};
  for (int x = 0; x < 64; x += 2) stripes.at(x, 0) = {1, 0.5f, 0};
  maker.scene.textures.push_back(textureOf(stripes));
  maker.parallelogram({-2, -2, -4}, {4, 0, 0}, {0, 4, 0}, striped);
  const Traced traced(device, maker.scene);
  const SurfaceBuffers fine = buffersOf(traced, device, lookAt({0, 0, 0}, {0, 0, -1}, 40), settings(3, 3, 2000, 1));
  CHECK(fine.albedo.at(1, 1).x == Approx(0.5).margin(0.03));
  CHECK(fine.albedo.at(1, 1).y == Approx(0.25).margin(0.02));
  CHECK(fine.albedo.at(1, 1).z == 0);
}

TEST_CASE("Buffers are the same bit for bit for any number of threads and any size of the queue") {
  const Scene scene = garden();
  const RenderSettings wanted = settings(37, 23, 5, 1, 9);
  const Device one = openDevice("cpu", 1);
  const Traced first(one, scene);
  const SurfaceBuffers expected = buffersOf(first, one, gardenView, wanted);
  for (const int threads : {1, 2, 5}) {
    const Device device = openDevice("cpu", threads);
    const Traced traced(device, scene);
    for (const uint32_t queue : {0u, 64u, 700u, 37u * 23u, 2000u}) {
      INFO(threads << " threads, queue of " << queue);
      CHECK(same(buffersOf(traced, device, gardenView, wanted, queue), expected));
    }
  }
}

TEST_CASE("A path render with buffers has the same light bit for bit, and the buffers of a render without light") {
  const Scene scene = garden();
  for (const Device& device : devices()) {
    const Traced traced(device, scene);
    for (const uint32_t queue : {0u, 500u}) {
      const RenderSettings wanted = settings(33, 21, 4, 4, 3);
      const PathResult plain = traced.render(gardenView, wanted, {.queue = queue});
      const PathResult with = traced.render(gardenView, wanted, {.queue = queue, .surfaces = true});
      CHECK_FALSE(plain.surfaces);
      REQUIRE(with.surfaces);
      CHECK(identical(plain.image, with.image));
      CHECK(with.rays.primary == plain.rays.primary);
      CHECK(with.rays.shadow == plain.rays.shadow);
      CHECK(same(*with.surfaces, buffersOf(traced, device, gardenView, wanted)));
    }
  }
}

TEST_CASE("Buffers that are stopped hold the samples done, each pixel divided by its own number") {
  const Device device = chosenDevice();
  const Traced traced(device, garden());
  const uint32_t pixels = 24 * 16;
  const SurfaceBuffers one = buffersOf(traced, device, gardenView, settings(24, 16, 1, 1));
  const SurfaceBuffers two = buffersOf(traced, device, gardenView, settings(24, 16, 2, 1));
  std::atomic<bool> stop{false};
  const Watch watch{[&](double) { stop = true; }, &stop};
  const SurfaceResult result = renderSurfaces(device, traced.scene().view(), traced.tracer(), gardenView,
                                              settings(24, 16, 8, 1), watch, pixels + pixels / 2);
  CHECK(result.samples == pixels + pixels / 2);
  const PixelOrder order(device, 24, 16);
  std::vector<uint32_t> pixelAt(pixels);
  copyToHost(device, pixelAt.data(), order.pixelAt(), pixels * sizeof(uint32_t));
  for (uint32_t place = 0; place < pixels; ++place) {
    const uint32_t i = pixelAt[place];
    INFO("pixel " << i);
    const SurfaceBuffers& expected = place < pixels / 2 ? two : one;
    REQUIRE(result.buffers.normals.pixels[i] == expected.normals.pixels[i]);
    REQUIRE(result.buffers.albedo.pixels[i] == expected.albedo.pixels[i]);
    REQUIRE(std::memcmp(&result.buffers.depth[i], &expected.depth[i], sizeof(float)) == 0);
  }
}

TEST_CASE("An empty scene has no surfaces, and invalid settings and views are refused") {
  const Device device = chosenDevice();
  const Traced nothing(device, {});
  const SurfaceBuffers buffers = buffersOf(nothing, device, alongMinusZ, settings(4, 3, 2, 1));
  for (const float z : buffers.depth) CHECK(std::isinf(z));
  const auto render = [&](const Camera& camera, const RenderSettings& wanted) {
    return renderSurfaces(device, nothing.scene().view(), nothing.tracer(), camera, wanted);
  };
  CHECK_THROWS_AS(render(alongMinusZ, settings(0, 3, 2, 1)), InputError);
  CHECK_THROWS_AS(render(alongMinusZ, settings(4, 3, 0, 1)), InputError);
  CHECK_THROWS_AS(render(lookAt({0, 0, 0}, {0, 0, 0}), settings(4, 3, 1, 1)), InputError);
}

TEST_CASE("An EXR returns every channel that was written, and its RGB as if there were no others") {
  Folder folder;
  Image image{3, 2, {}};
  Channel normal{"N.X", {}}, depth{"Z", {}};
  for (int i = 0; i < 6; ++i) {
    image.pixels.push_back({0.1f * i, 1.0f / (i + 1), -2.0f * i});
    normal.values.push_back(0.25f * i - 1);
    depth.values.push_back(i == 4 ? INFINITY : 3.5f + i);
  }
  writeExr(folder / "a.exr", image, {{"copse", "{}"}}, {depth, normal});
  std::map<std::string, std::string> attributes;
  CHECK(identical(readExr(folder / "a.exr", &attributes), image));
  CHECK(attributes.at("copse") == "{}");
  CHECK(same(readExrChannel(folder / "a.exr", "N.X"), normal.values));
  CHECK(same(readExrChannel(folder / "a.exr", "Z"), depth.values));
  CHECK(readExrChannel(folder / "a.exr", "G")[2] == image.pixels[2].y);
  CHECK_THROWS_WITH(readExrChannel(folder / "a.exr", "N.Y"), Contains("a.exr") && Contains("N.Y"));
  CHECK_THROWS_AS(readExrChannel(folder / "none.exr", "Z"), InputError);
  depth.values.pop_back();
  CHECK_THROWS_AS(writeExr(folder / "b.exr", image, {}, {depth}), InputError);
  CHECK(folder.fileCount() == 1);
}
