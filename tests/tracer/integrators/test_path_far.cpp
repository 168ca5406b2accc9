// Coordinates far from 0, views from far away, scenes a million wide, and turned skies: the picture is that of the same
// scene near 0. Means are compared within their own standard errors; seeds are fixed.
#include <cmath>
#include <glm/common.hpp>

#include "tests/support/catch.h"
#include "tests/support/devices.h"
#include "tests/support/path_scenes.h"
#include "tracer/integrators/pinhole.h"
#include "tracer/integrators/reference/reference.h"
#include "tracer/integrators/surfaces/surface_buffers.h"
#include "tracer/materials/surface.h"

using namespace copse;
using namespace copse::test;
using glm::dvec3;

namespace {

/// A table 0.75 high on a floor.
Scene table(const vec3& place, float scale = 1) {
  SceneMaker maker;
  const uint32_t white = maker.material(vec3(0.7f));
  maker.parallelogram(place + scale * vec3(-6, 0, -6), scale * vec3(0, 0, 12), scale * vec3(12, 0, 0), white);
  maker.box(place + scale * vec3(-1, 0.75f, -2), place + scale * vec3(1, 0.875f, 2), white);
  maker.sky(vec3(1));
  return maker.scene;
}

/// What the floor's middle under the table shows.
Mean underTable(const Device& device, const Scene& scene, const vec3& place, float scale = 1) {
  const Camera camera = lookAt(place + scale * vec3(0, 0.5f, 0), place, 20);
  return meanOf(Traced(device, scene).render(camera, settings(24, 24, 64, 3)).image);
}

void checkAlike(const Mean& a, const Mean& b) {
  CHECK(std::abs(a.value - b.value) <= 4.5 * std::hypot(a.error, b.error) + 2e-6 * a.value);
}

Mean differenceOf(const Image& a, const Image& b) {
  Image difference = a;
  for (std::size_t i = 0; i < a.pixels.size(); ++i) difference.pixels[i] = glm::abs(a.pixels[i] - b.pixels[i]);
  return meanOf(difference);
}

}  // namespace

TEST_CASE("A shadow stays under its table at the coordinates of maps, where floats hold them") {
  for (const Device& device : devices()) {
    const Mean here = underTable(device, table(vec3(0)), vec3(0));
    CHECK(here.error < 0.01 * here.value);
    CHECK(here.value < 0.3);  // It is dark there.
    for (const vec3 place : {vec3(155'000, 0, 463'000), vec3(1e6f, 16, -1e6f)}) {
      INFO(place.x);
      checkAlike(underTable(device, table(place), place), here);
    }
    checkAlike(underTable(device, table(vec3(0), 1e6f), vec3(0), 1e6f), here);
  }
}

TEST_CASE("A table's shadow shows on a floor that is a million tables wide") {
  for (const Device& device : devices()) {
    Scene scene = table(vec3(0));
    const Mean here = underTable(device, scene, vec3(0));
    for (vec3& p : scene.positions)
      if (p.y == 0) p *= 2e5f;
    checkAlike(underTable(device, scene, vec3(0)), here);
  }
}

TEST_CASE("Points off a surface lie beyond its plane, and no farther than their error's bound") {
  uint64_t key = randomKey(7, 0, 0);
  const auto random = [&](float size) { return (2 * unitFloat(highWord(key = randomBits(key, 1, 0))) - 1) * size; };
  for (int i = 0; i < 200'000; ++i) {
    const float away = std::exp2(random(20)), size = std::exp2(random(10));
    const vec3 a(random(away), random(away), random(away));
    const vec3 b = a + vec3(random(size), random(size), random(size)),
               c = a + vec3(random(size), random(size), random(size));
    const vec3 edge1 = b - a, edge2 = c - a, normal = unitNormal(edge1, edge2);
    if (!(glm::length(normal) > 0)) continue;
    float u = (random(1) + 1) / 2, v = (random(1) + 1) / 2;
    if (u + v > 1) u = 1 - u, v = 1 - v;
    const vec3 origin = (a + edge1 * u + edge2 * v) + normal * errorAlong(normal, a, edge1, edge2);
    const dvec3 exact = glm::cross(dvec3(b) - dvec3(a), dvec3(c) - dvec3(a));
    // A sliver's normal in float is not that of its plane: nothing to bound.
    const double longest = std::max({glm::length(dvec3(edge1)), glm::length(dvec3(edge2))});
    if (glm::length(exact) < 1e-3 * longest * longest) continue;
    const double height = glm::dot(dvec3(origin) - dvec3(a), glm::normalize(exact));
    REQUIRE(height > 0);
    const dvec3 bound = dvec3(glm::abs(a) + glm::abs(edge1) + glm::abs(edge2)) * 0x1p-20;
    REQUIRE(height < glm::dot(glm::abs(glm::normalize(exact)), bound) * 1.01);
  }
}

TEST_CASE("A view from a million sizes away shows what one from near by does") {
  SceneMaker maker;
  maker.sphere({1, 2, 0.5f}, 2, 3, maker.material({0.7f, 0.5f, 0.3f}));
  maker.parallelogram({-3, -1, -1}, {6, 0, 0}, {0, 6, 0}, maker.material({0.2f, 0.6f, 0.4f}));
  maker.sky(vec3(1));
  const dvec3 at(0.3, 1.7, 0.2), way = glm::normalize(dvec3(0.3, 0.2, 1));
  const auto view = [&](double distance, bool starts) {
    Camera camera{"far", vec3(0), vec3(0), {0, 1, 0}, static_cast<float>(std::atan(4 / distance) * 360 / M_PI)};
    camera.setEye(at + way * distance);
    camera.setAt(at);
    if (starts) camera.start = distance - 20;
    return camera;
  };
  const RenderSettings wanted = settings(32, 32, 32, 2);
  const Camera far = view(8e6, true);
  for (const Device& device : devices()) {
    const Traced traced(device, maker.scene);
    const Image image = traced.render(far, wanted).image;
    // From 400 on a float still tells the pixels apart, and the perspective is 1 % of what it is from 4.
    const Image near = traced.render(view(4000, false), wanted).image;
    const double difference = differenceOf(image, near).value;
    CHECK(difference < 0.02 * meanOf(near).value);
    const Image lost = traced.render(view(8e6, false), wanted).image;
    CHECK(differenceOf(lost, near).value > 4 * difference);
    const SurfaceResult surfaces = renderSurfaces(device, traced.scene().view(), traced.tracer(), far, wanted);
    CHECK(surfaces.buffers.depth.at(16 * 32 + 16) == Approx(8e6).epsilon(1e-6));
  }
  const Image reference = renderReference(maker.scene, far, wanted, 2).image;
  const Image again = Traced(devices().front(), maker.scene).render(far, wanted).image;
  CHECK(differenceOf(again, reference).value < 0.03 * meanOf(reference).value);
}

TEST_CASE("A near view's rays start at the eye to the last bit") {
  const Pinhole pinhole = makePinhole(lookAt({0.1f, -7.3f, 1e-3f}, {1, 2, 3}), 640, 480);
  for (const float x : {0.0f, 17.25f, 640.0f}) CHECK(pinhole.origin(x, 480 - x / 2) == vec3(0.1f, -7.3f, 1e-3f));
}

namespace {

/// About +y, counter-clockwise from above.
vec3 turned(const vec3& v, double degrees) {
  const double c = std::cos(degrees * M_PI / 180), s = std::sin(degrees * M_PI / 180);
  return {c * v.x + s * v.z, v.y, -s * v.x + c * v.z};
}

Image markedSky() {
  Image image{64, 32, std::vector<vec3>(64 * 32, vec3(0.25f))};
  const auto mark = [&](int x, const vec3& colour) {
    for (int i = -2; i < 2; ++i)
      for (int j = 12; j < 20; ++j) image.at((x + i + 64) % 64, j) = colour;
  };
  mark(32, {8, 0, 0});  // -z
  mark(48, {0, 4, 0});  // +x
  mark(0, {0, 0, 16});  // +z
  return image;
}

}  // namespace

TEST_CASE("A sky turned by 90 degrees has its centre at -x: counter-clockwise from above") {
  SceneMaker maker;
  maker.scene.sky = SkyLight{vec3(0), "", markedSky(), 90};
  const auto seen = [&](const vec3& towards) {
    const Camera camera = lookAt({0, 0, 0}, towards, 1e-3f);
    const Image image = Traced(chosenDevice(), maker.scene).render(camera, settings(1, 1, 1, 1)).image;
    CHECK(renderReference(maker.scene, camera, settings(1, 1, 1, 1), 1).image.at(0, 0) == image.at(0, 0));
    return image.at(0, 0);
  };
  CHECK(seen({-1, 0, 0}) == vec3(8, 0, 0));
  CHECK(seen({0, 0, -1}) == vec3(0, 4, 0));
  CHECK(seen({1, 0, 0}) == vec3(0, 0, 16));
  CHECK(seen({0, 0, 1}) == vec3(0.25f));
  for (const double rotation : {-270.0, 450.0}) {
    maker.scene.sky->rotation = rotation;
    CHECK(seen({-1, 0, 0}) == vec3(8, 0, 0));
  }
}

TEST_CASE("A turned sky lights a scene as the sky lights the scene that is turned back, by any mix of techniques") {
  for (const Device& device : devices())
    for (const double rotation : {37.0, -120.0, 180.0})
      for (const bool both : {true, false}) {
        const auto lit = [&](double sky, double back) {
          const vec3 up = turned(glm::normalize(vec3(0.6f, 0.5f, 0.3f)), -back);
          const vec3 side = turned(glm::normalize(glm::cross(vec3(0.6f, 0.5f, 0.3f), vec3(0, 1, 0))), -back);
          SceneMaker maker;
          maker.parallelogram(-side - glm::cross(up, side), side * 2.0f, glm::cross(up, side) * 2.0f,
                              maker.material(vec3(0.5f)));
          maker.scene.sky = SkyLight{vec3(0), "", markedSky(), sky};
          const Camera camera = lookAt(up * 2.0f + side * 0.5f, {0, 0, 0}, 1e-3f);
          return Traced(device, maker.scene).render(camera, settings(32, 32, 16, 2), {0, both}).image;
        };
        const Image sky = lit(rotation, 0), scene = lit(0, rotation);
        for (int k = 0; k < 3; ++k) {
          INFO("rotation " << rotation << ", both techniques " << both << ", channel " << k);
          CHECK(meanOf(scene, k).error < 0.05 * meanOf(scene, k).value + 1e-6);
          checkAlike(meanOf(sky, k), meanOf(scene, k));
        }
      }
}
