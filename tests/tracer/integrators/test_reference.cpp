// The reference tracer against closed forms: furnaces, enclosures, Lambert's formula for a polygon, lights and cameras.
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "builder/base/error.h"
#include "tests/support/catch.h"
#include "tests/support/small_scenes.h"
#include "tracer/integrators/reference/reference.h"

using namespace copse;
using namespace copse::test;
using glm::dvec3;

namespace {

constexpr double pi = std::numbers::pi;

struct Mean {
  double value = 0, error = 0;
};

/// The mean of the green channel over all pixels, with its standard error.
Mean meanOf(const Image& image) {
  double sum = 0, squares = 0;
  for (const vec3& p : image.pixels) sum += p.y, squares += double{p.y} * p.y;
  const double n = static_cast<double>(image.pixels.size());
  return {sum / n, std::sqrt(std::max(0.0, squares / n - sum / n * (sum / n)) / (n - 1))};
}

RenderSettings settingsOf(int side, int spp, int maxDepth) {
  RenderSettings settings;
  settings.width = settings.height = side;
  settings.spp = spp;
  settings.maxDepth = maxDepth;
  return settings;
}

Image render(const Scene& scene, const Camera& camera, const RenderSettings& settings) {
  return renderReference(scene, camera, settings, 0).image;
}

/// Lambert 1760, as in Baum et al. 1989: irradiance from a polygon of radiance 1 that lies above the horizon.
double polygonIrradiance(dvec3 point, dvec3 normal, const std::vector<dvec3>& corners) {
  double sum = 0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    const dvec3 a = glm::normalize(corners[i] - point), b = glm::normalize(corners[(i + 1) % corners.size()] - point);
    sum += std::acos(glm::dot(a, b)) * glm::dot(normal, glm::normalize(glm::cross(a, b)));
  }
  return std::abs(sum) / 2;
}

/// A camera above the origin that sees next to nothing but the point (0, 0, 0) of the floor.
const Camera atOrigin{"origin", {0.5f, 1, 0.5f}, {0, 0, 0}, {0, 1, 0}, 0.001f};

}  // namespace

TEST_CASE("In a white furnace a white scene cannot be seen, however concave") {
  Scene scene = floorScene(1, 4);
  addBox(scene, {-1, 0, -1}, {1, 1, 1}, 0);
  addBox(scene, {1, 0, 1}, {2, 3, 2}, 0);
  scene.sky = SkyLight{{1, 1, 1}, "", {}};
  const Image image = render(scene, {"", {6, 5, 7}, {0, 0, 0}, {0, 1, 0}, 50}, settingsOf(24, 4, 1000));
  for (const vec3& p : image.pixels) CHECK(p.y == Approx(1).epsilon(1e-6));
}

TEST_CASE("A convex grey body under an even sky shows its albedo at any depth but 0") {
  Scene scene = sphereScene(0.3f, {0, 0, 0}, 3);
  scene.sky = SkyLight{{2, 2, 2}, "", {}};
  for (const int depth : {0, 1, 2, 8}) {
    const Image image = render(scene, {"", {0, 0, 5}, {0, 0, 0}, {0, 1, 0}, 10}, settingsOf(4, 2, depth));
    for (const vec3& p : image.pixels) CHECK(p.y == Approx(depth == 0 ? 0 : 0.6).margin(1e-6));
  }
}

TEST_CASE("Inside a glowing sphere the light is the series of its bounces") {
  const double rho = 0.7, glow = 1.5;
  const Scene scene = sphereScene(float(rho), vec3(float(glow)), 2);
  double want = glow;
  for (int depth = 0; depth <= 4; ++depth) {
    const Mean mean = meanOf(render(scene, {"", {0.2f, 0.1f, 0}, {1, 0, 0}, {0, 1, 0}, 60}, settingsOf(24, 16, depth)));
    CHECK(mean.value == Approx(want).margin(4 * mean.error + 1e-6));
    CHECK(mean.error < 0.01 * want);
    want += glow * std::pow(rho, depth + 1);
  }
}

TEST_CASE("A floor under a quad light has the irradiance of Lambert's formula, and none on its dark side") {
  Scene scene = floorScene(0.8f, 10);
  const vec3 corner{-0.5f, 1.5f, -0.7f}, u{1.5f, 0, 0.2f}, v{0.1f, 0.3f, 1.2f};
  scene.quads.push_back({corner, v, u, vec3(3)});
  REQUIRE(glm::cross(v, u).y > 0);
  CHECK(meanOf(render(scene, atOrigin, settingsOf(8, 8, 1))).value == 0);
  scene.quads[0] = {corner, u, v, vec3(3)};
  const std::vector<dvec3> corners{corner, corner + u, corner + u + v, corner + v};
  const double want = 3 * 0.8 / pi * polygonIrradiance({0, 0, 0}, {0, 1, 0}, corners);
  for (const int lightSamples : {1, 4}) {
    RenderSettings settings = settingsOf(32, 64, 1);
    settings.lightSamples = lightSamples;
    const Mean mean = meanOf(render(scene, atOrigin, settings));
    CHECK(mean.value == Approx(want).margin(4 * mean.error));
    CHECK(mean.error < 0.003 * want);
  }
}

TEST_CASE("Glowing triangles shine to both sides and several lights add up") {
  Scene scene = floorScene(0.8f, 10);
  const std::vector<dvec3> small{{-0.5, 1, -0.5}, {0.5, 1, -0.5}, {0, 1, 0.5}}, large{{2, 3, 0}, {4, 3, 0}, {2, 3, 3}};
  for (const bool turned : {false, true}) {
    Scene lit = scene;
    lit.materials.push_back({"glow", vec3(0), vec3(5), -1});
    lit.materials.push_back({"dim", vec3(0), vec3(2), -1});
    addTriangle(lit, small[0], small[turned ? 2 : 1], small[turned ? 1 : 2], 1);
    addTriangle(lit, large[0], large[turned ? 2 : 1], large[turned ? 1 : 2], 2);
    const dvec3 origin(0), up(0, 1, 0);
    const double irradiance = 5 * polygonIrradiance(origin, up, small) + 2 * polygonIrradiance(origin, up, large);
    const double want = 0.8 / pi * irradiance;
    Camera camera = atOrigin;
    camera.eye = {1, 0.5f, 1};  // Below both.
    const Mean mean = meanOf(render(lit, camera, settingsOf(32, 64, 1)));
    CHECK(mean.value == Approx(want).margin(4 * mean.error));
    CHECK(mean.error < 0.008 * want);
  }
}

TEST_CASE("Light from a small source falls with the square of the distance") {
  double first = 0;
  for (const float distance : {10.0f, 20.0f, 40.0f}) {
    Scene scene = floorScene(1, 10);
    scene.quads.push_back({{-0.005f, distance, -0.005f}, {0.01f, 0, 0}, {0, 0, 0.01f}, vec3(1e4f)});
    const double value = meanOf(render(scene, atOrigin, settingsOf(8, 4, 1))).value;
    if (first == 0) first = value;
    CHECK(value * distance * distance == Approx(first * 100).epsilon(1e-5));
    CHECK(value == Approx(1 / pi / distance / distance).epsilon(1e-4));
  }
}

TEST_CASE("An occluder between a light and a floor casts a shadow") {
  Scene scene = floorScene(0.8f, 10);
  scene.quads.push_back({{-1, 2, -1}, {2, 0, 0}, {0, 0, 2}, vec3(3)});
  Camera camera = atOrigin;
  camera.eye = {1, 0.5f, 1};
  CHECK(meanOf(render(scene, camera, settingsOf(8, 8, 1))).value > 0.1);
  addBox(scene, {-3, 1, -3}, {3, 1.5f, 3}, 0);
  CHECK(meanOf(render(scene, camera, settingsOf(8, 8, 1))).value == 0);
}

TEST_CASE("A quad light is no surface: no camera sees it and rays go through") {
  Scene scene = sphereScene(0, vec3(1), 2);  // Glows, at the origin.
  scene.quads.push_back({{-1, -1, 2}, {2, 0, 0}, {0, 2, 0}, vec3(100)});
  const Image image = render(scene, {"", {0, 0, 5}, {0, 0, 0}, {0, 1, 0}, 5}, settingsOf(4, 2, 3));
  for (const vec3& p : image.pixels) CHECK(p == vec3(1));
}

TEST_CASE("Depth counts the hits that are lit, the camera ray's being the first") {
  // The camera sees a wall that light reaches only by way of the floor.
  Scene scene;
  scene.materials.push_back({"grey", vec3(0.5f), vec3(0), -1});
  addBox(scene, {-4, -1, -4}, {4, 0, 4}, 0);
  addBox(scene, {-1, 0.5f, -1.1f}, {1, 3, -1}, 0);
  scene.quads.push_back({{-3, 2, -0.999f}, {6, 0, 0}, {0, 0, 3}, vec3(5)});  // Shines down, in front of the wall.
  const Camera camera{"", {0, 1.8f, -4}, {0, 1.8f, -1.1f}, {0, 1, 0}, 5};    // Its back, turned from the light.
  CHECK(meanOf(render(scene, camera, settingsOf(8, 16, 0))).value == 0);
  CHECK(meanOf(render(scene, camera, settingsOf(8, 16, 1))).value == 0);
  CHECK(meanOf(render(scene, camera, settingsOf(8, 64, 2))).value > 0);
}

TEST_CASE("The image is the same for any number of threads and another for another seed") {
  Scene scene = floorScene(0.8f, 4);
  addBox(scene, {-1, 0, -1}, {1, 1, 1}, 0);
  scene.quads.push_back({{-1, 4, -1}, {2, 0, 0}, {0, 0, 2}, vec3(3)});
  scene.sky = SkyLight{{0.2f, 0.3f, 0.4f}, "", {}};
  const Camera camera{"", {5, 4, 6}, {0, 0, 0}, {0, 1, 0}, 40};
  RenderSettings settings = settingsOf(24, 2, 4);
  const ReferenceResult one = renderReference(scene, camera, settings, 1);
  const ReferenceResult three = renderReference(scene, camera, settings, 3);
  CHECK(one.image.pixels == three.image.pixels);
  for (int k = 0; k < 3; ++k) CHECK(one.rays[k] == three.rays[k]);
  CHECK(one.rays[0] == 24 * 24 * 2);
  CHECK(one.rays[1] > 0);
  CHECK(one.rays[2] > 0);
  CHECK(one.samplesDone == 2);
  settings.seed = 2;
  CHECK(renderReference(scene, camera, settings, 2).image.pixels != one.image.pixels);
}

TEST_CASE("A render that is stopped returns the rows so far at their full brightness") {
  Scene scene = sphereScene(0, vec3(1), 2);
  std::atomic<bool> stop{false};
  double last = 0;
  Watch watch;
  watch.stop = &stop;
  watch.progress = [&](double done) {
    CHECK(done >= last);
    last = done;
    stop = done > 0.6;
  };
  const Camera inside{"", {0, 0, 0}, {0, 0, 1}, {0, 1, 0}, 60};
  const ReferenceResult result = renderReference(scene, inside, settingsOf(16, 10, 1), 1, watch);
  CHECK(result.samplesDone > 5);
  CHECK(result.samplesDone < 10);
  for (const vec3& p : result.image.pixels) CHECK(p == vec3(1));
  stop = true;
  CHECK(renderReference(scene, inside, settingsOf(16, 10, 1), 2, {{}, &stop}).samplesDone == 0);
}

TEST_CASE("A scene without triangles shows its sky, and one without light is black") {
  Scene scene;
  scene.materials.push_back({});
  const Camera camera{"", {0, 0, 0}, {0, 0, 1}, {0, 1, 0}, 60};
  CHECK(render(scene, camera, settingsOf(2, 1, 2)).pixels == std::vector<vec3>(4, vec3(0)));
  scene.sky = SkyLight{{1, 2, 3}, "", {}};
  CHECK(render(scene, camera, settingsOf(2, 1, 2)).pixels == std::vector<vec3>(4, vec3(1, 2, 3)));
}

TEST_CASE("Settings without a pixel or a sample are errors") {
  const Scene scene = floorScene(1, 1);
  for (const RenderSettings& bad :
       {RenderSettings{.width = 0}, {.height = -1}, {.spp = 0}, {.maxDepth = -1}, {.lightSamples = 0}})
    CHECK_THROWS_AS(renderReference(scene, atOrigin, bad, 1), InputError);
}
