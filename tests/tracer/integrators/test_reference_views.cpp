// Which way round things are in the reference tracer: cameras, textures, skies.
#include <cmath>
#include <numbers>

#include "tests/support/catch.h"
#include "tests/support/small_scenes.h"
#include "tests/support/textures.h"
#include "tracer/integrators/reference/reference.h"

using namespace copse;
using namespace copse::test;

namespace {

RenderSettings settingsOf(int width, int height, int spp, int maxDepth) {
  RenderSettings settings;
  settings.width = width;
  settings.height = height;
  settings.spp = spp;
  settings.maxDepth = maxDepth;
  return settings;
}

Image render(const Scene& scene, const Camera& camera, const RenderSettings& settings) {
  return renderReference(scene, camera, settings, 0).image;
}

/// What the camera at the origin sees of a sky in one narrow direction.
vec3 skyTowards(const Scene& scene, vec3 direction) {
  const vec3 up = std::abs(direction.y) > 0.9f ? vec3(0, 0, 1) : vec3(0, 1, 0);
  return render(scene, {"", {0, 0, 0}, direction, up, 0.01f}, settingsOf(1, 1, 1, 0)).pixels[0];
}

}  // namespace

TEST_CASE("A camera shows what is up at the top, what is right on the right, and vfov from edge to edge") {
  Scene scene;
  scene.materials.push_back({"red", vec3(0), vec3(1, 0, 0), -1});
  scene.materials.push_back({"green", vec3(0), vec3(0, 1, 0), -1});
  // Looking down -z from the origin at 45 degrees: at distance 10 the view is 2 * 10 * tan(22.5°) high.
  const float half = 10 * std::tan(std::numbers::pi_v<float> / 8);
  addQuad(scene, {-100, half / 2, -10}, {200, 0, 0}, {0, half / 2, 0}, 0);  // The top quarter of the image.
  addQuad(scene, {half, -100, -10}, {100, 0, 0}, {0, 100, 0}, 1);           // Right of the square in the lower half.
  const Image image = render(scene, {"", {0, 0, 0}, {0, 0, -1}, {0, 1, 0}, 45}, settingsOf(64, 32, 4, 0));
  for (int y = 0; y < 32; ++y)
    for (int x = 0; x < 64; ++x) {
      const vec3 want = y < 8 ? vec3(1, 0, 0) : y >= 16 && x >= 48 ? vec3(0, 1, 0) : vec3(0);
      REQUIRE(image.at(x, y) == want);
    }
}

TEST_CASE("A pixel is the mean over its square") {
  Scene scene;
  scene.materials.push_back({"glow", vec3(0), vec3(1), -1});
  addQuad(scene, {0.25f, -100, -1}, {100, 0, 0}, {0, 200, 0}, 0);  // Covers three eighths of a view 2 wide.
  const Image image = render(scene, {"", {0, 0, 0}, {0, 0, -1}, {0, 1, 0}, 90}, settingsOf(1, 1, 20000, 0));
  CHECK(image.pixels[0].x == Approx(0.375).margin(4 * std::sqrt(0.375 * 0.625 / 20000)));
}

TEST_CASE("A texture's v runs from the bottom row up, its u from the left, and both repeat") {
  Scene scene = floorScene(0.25f, 1);  // Seen from above with -z up: u along x, v along -z.
  scene.uvs = {{0, 0}, {0, 1}, {1, 1}, {1, 0}};
  for (vec2& uv : scene.uvs) uv = uv * 2.0f - vec2(3, 5);
  // addQuad's corners are (-1,-1), (-1,1), (1,1) and (1,-1) in (x, z); v = 1 at z = -1.
  scene.uvTriangles = {{1, 0, 3}, {1, 3, 2}};
  Image image{2, 2, {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0.5f, 0.5f, 0.5f}}};
  scene.textures.push_back(textureOf(image));
  scene.materials[0].texture = 0;
  scene.sky = SkyLight{{1, 1, 1}, "", {}};
  const Camera above{"", {0, 1, 0}, {0, 0, 0}, {0, 0, -1}, 0.01f};
  const auto colourAt = [&](float u, float v) {  // In the first of the two periods.
    Camera camera = above;
    camera.eye.x = camera.at.x = u - 1;
    camera.eye.z = camera.at.z = 1 - v;
    const Image seen = render(scene, camera, settingsOf(1, 1, 1, 1));
    return seen.pixels[0];
  };
  for (const float period : {0.0f, 1.0f}) {
    const auto near = [](vec3 a, vec3 b) { return glm::length(a - b) < 4e-3f; };
    CHECK(near(colourAt(period + 0.25f, 0.75f), vec3(1, 0, 0)));
    CHECK(near(colourAt(period + 0.75f, 0.75f), vec3(0, 1, 0)));
    CHECK(near(colourAt(0.25f, period + 0.25f), vec3(0, 0, 1)));
    CHECK(near(colourAt(0.75f, period + 0.25f), vec3(0.5f)));
    CHECK(near(colourAt(period + 0.5f, 0.75f), vec3(0.5f, 0.5f, 0)));    // Between two texels.
    CHECK(near(colourAt(period + 0.001f, 0.75f), vec3(0.5f, 0.5f, 0)));  // And across the seam.
    CHECK(near(colourAt(0.25f, period + 0.001f), vec3(0.5f, 0, 0.5f)));
  }
  scene.textures[0].texels.reset();
  CHECK(colourAt(0.25f, 0.75f).x == Approx(0.25));  // Kd where the texture was not read.
}

TEST_CASE("A sky image has -z in its centre, +x right of that and +y at the top") {
  Scene scene;
  scene.sky = SkyLight{};
  Image& image = scene.sky->image;
  image = {8, 4, std::vector<vec3>(32)};
  for (int y = 0; y < 4; ++y)
    for (int x = 0; x < 8; ++x) image.at(x, y) = {static_cast<float>(x), static_cast<float>(y), 1};
  // Columns are read between texel centres: the image's middle is between columns 3 and 4.
  CHECK(skyTowards(scene, {0, 0, -1}).x == Approx(3.5).margin(1e-3));
  CHECK(skyTowards(scene, {1, 0, 0}).x == Approx(5.5).margin(1e-3));
  CHECK(skyTowards(scene, {1, 0, -1}).x == Approx(4.5).margin(1e-3));
  CHECK(skyTowards(scene, {-1, 0, 0}).x == Approx(1.5).margin(1e-3));
  CHECK(skyTowards(scene, {0, 0, 1}).x == Approx(3.5).margin(1e-3));  // Across the seam: the mean of 7 and 0.
  CHECK(skyTowards(scene, {0, 0, -1}).y == Approx(1.5).margin(1e-3));
  CHECK(skyTowards(scene, {0, 1, 0}).y == Approx(0).margin(1e-3));
  CHECK(skyTowards(scene, {0, -1, 0}).y == Approx(3).margin(1e-3));
}

TEST_CASE("A floor gathers the light of a sky image over its upper half") {
  Scene scene = floorScene(0.5f, 10);
  scene.sky = SkyLight{};
  scene.sky->image = {64, 32, std::vector<vec3>(64 * 32)};
  for (int y = 0; y < 32; ++y)
    for (int x = 0; x < 64; ++x) {
      const float elevation = std::numbers::pi_v<float> * (0.5f - (y + 0.5f) / 32);
      scene.sky->image.at(x, y) = vec3(std::max(0.0f, std::sin(elevation)), y < 16 ? 3 : 100, 1);
    }
  const Camera camera{"", {0.5f, 1, 0.5f}, {0, 0, 0}, {0, 1, 0}, 0.001f};
  const Image image = render(scene, camera, settingsOf(16, 16, 256, 1));
  vec3 mean(0);
  for (const vec3& p : image.pixels) mean += p / 256.0f;
  CHECK(mean.x == Approx(0.5 * 2 / 3).epsilon(0.01));  // Twice the integral of cosine squared: 2/3.
  CHECK(mean.z == Approx(0.5).epsilon(1e-5));
}
