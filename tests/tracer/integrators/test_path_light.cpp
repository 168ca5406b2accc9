// tracer/integrators/path against light that is known in closed form: furnaces, the irradiance under a rectangle,
// skies, albedos. Means are compared within their own standard errors; seeds are fixed, so a test that passes always
// passes.

#include <cmath>

#include "tests/support/catch.h"
#include "tests/support/devices.h"
#include "tests/support/path_scenes.h"
#include "tests/support/textures.h"

using namespace copse;
using namespace copse::test;
using glm::dvec3;

namespace {

/// Within 4.5 standard errors, and those small enough to show an error of `resolution` (relative).
void checkMean(const Mean& mean, double expected, double resolution = 0.005) {
  CHECK(mean.error < resolution / 4 * expected);
  CHECK(std::abs(mean.value - expected) < 4.5 * mean.error + 2e-6 * expected);
}

/// Irradiance at `point` from a polygon that lies wholly above its horizon and shines with radiance 1 (Lambert 1760).
double irradiance(const dvec3& point, const dvec3& normal, const std::vector<dvec3>& polygon) {
  double sum = 0;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const dvec3 a = glm::normalize(polygon[i] - point), b = glm::normalize(polygon[(i + 1) % polygon.size()] - point);
    sum += std::acos(glm::dot(a, b)) * glm::dot(normal, glm::normalize(glm::cross(a, b)));
  }
  return std::abs(sum) / 2;
}

/// A view whose pixels all see one point.
Camera stare(const vec3& eye, const vec3& at) { return lookAt(eye, at, 1e-3f); }

const std::vector<dvec3> rectangle{{-1, 2, -0.5}, {1, 2, -0.5}, {1, 2, 0.5}, {-1, 2, 0.5}};
const std::vector<vec3> floorPoints{{0, 0, 0}, {1.2f, 0, 0.3f}, {-3, 0, 2}};

SceneMaker floorScene(float kd) {
  SceneMaker maker;
  maker.parallelogram({-40, 0, -40}, {0, 0, 80}, {80, 0, 0}, maker.material(vec3(kd)));
  return maker;
}

/// The sky's bilinear lookup once more, in double precision.
double skyLookup(const Image& image, const dvec3& d, int channel) {
  const double x = (0.5 + std::atan2(d.x, -d.z) / (2 * M_PI)) * image.width - 0.5;
  const double y = std::acos(std::clamp(d.y, -1.0, 1.0)) / M_PI * image.height - 0.5;
  const double x0 = std::floor(x), y0 = std::floor(y);
  const auto at = [&](double column, double row) {
    const int i = (static_cast<int>(column) + image.width) % image.width;
    return static_cast<double>(image.at(i, std::clamp(static_cast<int>(row), 0, image.height - 1))[channel]);
  };
  const double fx = x - x0, fy = y - y0;
  const double upper = at(x0, y0) * (1 - fx) + at(x0 + 1, y0) * fx;
  const double lower = at(x0, y0 + 1) * (1 - fx) + at(x0 + 1, y0 + 1) * fx;
  return upper * (1 - fy) + lower * fy;
}

double skyIrradiance(const Image& image, const dvec3& normal, int channel) {
  const int rows = 600, columns = 1200;
  double sum = 0;
  for (int row = 0; row < rows; ++row) {
    const double polar = M_PI * (row + 0.5) / rows;
    for (int column = 0; column < columns; ++column) {
      const double azimuth = 2 * M_PI * (column + 0.5) / columns;
      const dvec3 d(std::sin(polar) * std::cos(azimuth), std::cos(polar), std::sin(polar) * std::sin(azimuth));
      const double cosine = glm::dot(d, normal);
      if (cosine > 0) sum += skyLookup(image, d, channel) * cosine * std::sin(polar);
    }
  }
  return sum * (M_PI / rows) * (2 * M_PI / columns);
}

/// Black but for two pixels, one of them a sun: neighbours of theirs are lit by interpolation alone.
Image sunAndGlow() {
  Image image{16, 8, std::vector<vec3>(128, vec3(0))};
  image.at(0, 2) = {50, 30, 10};
  image.at(9, 3) = {2, 4, 8};
  return image;
}

}  // namespace

TEST_CASE("White furnace: a convex body of albedo 1 under a sky of radiance 1 cannot be seen") {
  for (const Device& device : devices()) {
    for (const bool both : {true, false}) {
      SceneMaker maker;
      maker.sphere({0, 0, 0}, 1, 4, maker.material(vec3(1)));
      maker.sky(vec3(1));
      const Image image =
          Traced(device, maker.scene).render(lookAt({0, 1, 3}, {0, 0, 0}), settings(64, 48, 8, 64), {0, both}).image;
      for (const vec3& pixel : image.pixels) REQUIRE(pixel.y == Approx(1).epsilon(1e-4));
    }
  }
}

TEST_CASE("White furnace far from the origin, at a millionth and at a million times the size") {
  for (const Device& device : devices()) {
    for (const float size : {1e-6f, 1e6f, 1.0f}) {
      for (const float distance : {0.0f, 30.0f, 1000.0f}) {
        const vec3 centre = vec3(0.6f, -0.8f, 0.3f) * (size * distance);
        SceneMaker maker;
        maker.sphere(centre, size, 3, maker.material(vec3(1)));
        maker.sky(vec3(1));
        INFO("size " << size << ", " << distance << " sizes away");
        const Image image = Traced(device, maker.scene)
                                .render(lookAt(centre + vec3(0, size, 3 * size), centre, 30), settings(32, 32, 8, 8))
                                .image;
        CHECK(allFinite(image));
        // A ray that hit its own triangle again would lose a path's light; a misplaced vertex hides almost nothing.
        CHECK(meanOf(image).value == Approx(1).epsilon(2e-4));
      }
    }
  }
}

TEST_CASE("White furnace: in an open box of albedo 1 all light comes back out after enough bounces") {
  for (const Device& device : devices()) {
    SceneMaker maker;
    maker.box({-1, -1, 0}, {1, 1, 1}, maker.material(vec3(1)), 5);
    maker.sky(vec3(1));
    const Image image =
        Traced(device, maker.scene).render(lookAt({0, 0, 4}, {0, 0, 0}, 20), settings(32, 32, 48, 2000)).image;
    checkMean(meanOf(image), 1, 0.015);
  }
}

TEST_CASE("In a closed body that emits 1 and reflects c the radiance is the sum of the powers of c up to the depth") {
  for (const Device& device : devices()) {
    for (const float c : {0.3f, 0.75f}) {
      SceneMaker maker;
      maker.sphere({0, 0, 0}, 1, 2, maker.material(vec3(c), vec3(1)));
      const Traced traced(device, maker.scene);
      for (const int depth : {0, 1, 2, 5, 500}) {
        for (const bool both : {true, false}) {
          INFO("c " << c << ", depth " << depth << ", both techniques " << both);
          double expected = 0;
          for (int k = 0; k <= depth; ++k) expected += std::pow(double{c}, k);
          const RenderSettings wanted = settings(24, 24, depth == 0 ? 1 : 24, depth);
          const Mean mean =
              meanOf(traced.render(lookAt({0.2f, 0.1f, -0.1f}, {1, 0.5f, 0.3f}, 60), wanted, {0, both}).image);
          if (depth == 0) {
            CHECK(mean.value == 1);
          } else {
            checkMean(mean, expected, depth > 5 ? 0.04 : 0.01);
          }
        }
      }
    }
  }
}

TEST_CASE("Irradiance under a quad light follows Lambert's formula, and is 0 above it") {
  for (const Device& device : devices()) {
    SceneMaker maker = floorScene(0.5f);
    maker.parallelogram({-40, 9, -40}, {80, 0, 0}, {0, 0, 80}, maker.material(vec3(0.5f)));
    maker.scene.quads.push_back({{-1, 2, -0.5f}, {2, 0, 0}, {0, 0, 1}, {10, 5, 1}});
    const Traced traced(device, maker.scene);
    for (const vec3& point : floorPoints) {
      INFO("floor at " << point.x << ", " << point.z);
      const double expected = 0.5 / M_PI * irradiance(point, {0, 1, 0}, rectangle);
      const Image image = traced.render(stare({5, 1, 3}, point), settings(32, 32, 16, 1)).image;
      for (int k = 0; k < 3; ++k) checkMean(meanOf(image, k), expected * maker.scene.quads[0].radiance[k], 0.01);
    }
    const Image above = traced.render(stare({5, 1, 3}, {1, 9, 0.5f}), settings(16, 16, 4, 1)).image;
    CHECK(meanOf(above).value == 0);
    const Image through = traced.render(stare({0, 1, 0}, {0, 2, 0}), settings(16, 16, 4, 0)).image;
    CHECK(meanOf(through).value == 0);  // A quad is no surface: it is not seen.
  }
}

TEST_CASE("The light samples of a hit are stratified over the lights in proportion to their power") {
  const auto lamp = [](double x) {
    return std::vector<dvec3>{{x, 2, 0}, {x + 0.01, 2, 0}, {x + 0.01, 2, 0.01}, {x, 2, 0.01}};
  };
  const auto quad = [](float x, float radiance, bool up) {
    return QuadLight{{x, 2, 0}, {0.01f, 0, 0}, {0, 0, up ? -0.01f : 0.01f}, vec3(radiance)};
  };
  for (const Device& device : devices()) {
    // Two of the same power, one of which shines away: of two samples one is always on the other.
    SceneMaker pair = floorScene(0.5f);
    pair.scene.quads = {quad(-1, 1000, true), quad(1, 1000, false)};
    const Image even = Traced(device, pair.scene).render(stare({5, 1, 3}, {0, 0, 0}), settings(16, 16, 1, 1)).image;
    for (const vec3& pixel : even.pixels)
      REQUIRE(pixel.x == Approx(1000 * 0.5 / M_PI * irradiance({0, 0, 0}, {0, 1, 0}, lamp(1))).epsilon(0.02));

    SceneMaker uneven = floorScene(0.5f);
    uneven.scene.quads = {quad(-1, 300, false), quad(0, 1700, false), quad(1, 900, false)};
    const Traced traced(device, uneven.scene);
    double expected = 0;
    for (const QuadLight& light : uneven.scene.quads)
      expected += light.radiance.x * 0.5 / M_PI * irradiance({0.4, 0, 0.2}, {0, 1, 0}, lamp(light.corner.x));
    for (const int samples : {1, 2, 3, 7}) {
      INFO(samples << " light samples");
      RenderSettings wanted = settings(64, 64, 16, 1);
      wanted.lightSamples = samples;
      checkMean(meanOf(traced.render(stare({5, 1, 3}, {0.4f, 0, 0.2f}), wanted).image, 0), expected, 0.01);
    }
  }
}

TEST_CASE("A rectangle of emitting triangles lights what is below and what is above it, by any mix of techniques") {
  for (const Device& device : devices()) {
    SceneMaker maker = floorScene(0.5f);
    const uint32_t black = maker.material(vec3(0), {10, 5, 1});
    maker.parallelogram({-1, 2, -0.5f}, {2, 0, 0}, {0, 0, 1}, black);
    maker.scene.quads.push_back({{30, 20, 30}, {1, 0, 0}, {0, 0, 1}, vec3(1e-7f)});  // Chosen only now and then.
    SceneMaker ceiling;
    ceiling.parallelogram({-40, 4, -40}, {80, 0, 0}, {0, 0, 80}, ceiling.material(vec3(0.5f)));
    ceiling.parallelogram({-1, 2, -0.5f}, {2, 0, 0}, {0, 0, 1}, ceiling.material(vec3(0), {10, 5, 1}));
    const Traced below(device, maker.scene), above(device, ceiling.scene);
    for (const vec3& point : floorPoints) {
      for (const int depth : {1, 3}) {
        for (const bool both : {true, false}) {
          INFO("at " << point.x << ", " << point.z << ", depth " << depth << ", both techniques " << both);
          const double expected = 0.5 / M_PI * irradiance(point, {0, 1, 0}, rectangle);
          const Image floor = below.render(stare({5, 1, 3}, point), settings(32, 32, 16, depth), {0, both}).image;
          checkMean(meanOf(floor, 0), 10 * expected, 0.02);
          const vec3 mirrored(point.x, 4, point.z);
          const Image roof = above.render(stare({5, 3, 3}, mirrored), settings(32, 32, 16, depth), {0, both}).image;
          checkMean(meanOf(roof, 1), 5 * expected, 0.02);
        }
      }
    }
    // Both sides are seen, at depth 0 too.
    for (const float eye : {0.5f, 3.5f})
      CHECK(meanOf(below.render(stare({0.2f, eye, 0}, {0.2f, 2, 0.1f}), settings(4, 4, 1, 0)).image, 0).value == 10);
  }
}

TEST_CASE("A sky image lights a surface as its own integral says, by any mix of techniques", "[medium]") {
  for (const Device& device : devices()) {
    const Image image = sunAndGlow();
    for (const vec3 up : {vec3(0, 1, 0), vec3(0, 0, 1), vec3(-0.8f, 0.6f, 0), vec3(0, 0.6f, -0.8f)}) {
      SceneMaker maker;
      const vec3 side = std::abs(up.x) > 0 ? vec3(0, 0, 1) : vec3(1, 0, 0), other = glm::cross(up, side);
      maker.parallelogram(-side - other, side * 2.0f, other * 2.0f, maker.material(vec3(0.5f)));
      maker.scene.sky = SkyLight{vec3(0), "", image};
      const Traced traced(device, maker.scene);
      for (const int depth : {1, 2}) {
        for (const bool both : {true, false}) {
          INFO("up " << up.x << ' ' << up.y << ' ' << up.z << ", depth " << depth << ", both techniques " << both);
          const Image seen =
              traced.render(stare(up * 2.0f + side * 0.5f, {0, 0, 0}), settings(32, 32, 48, depth), {0, both}).image;
          for (int k = 0; k < 3; ++k) {
            const double expected = 0.5 / M_PI * skyIrradiance(image, up, k);
            const Mean mean = meanOf(seen, k);
            CHECK(mean.error < 0.015 * expected);
            CHECK(std::abs(mean.value - expected) < 4.5 * mean.error + 2e-4 * expected);
          }
        }
      }
    }
  }
}

TEST_CASE("A sky image of one colour is the same as the constant sky, and large ones are sampled in blocks") {
  for (const Device& device : devices()) {
    for (const int width : {4, 1500}) {
      SceneMaker maker = floorScene(0.5f);
      maker.sphere({0, 1, 0}, 1, 3, maker.material({0.9f, 0.5f, 0.1f}));
      maker.sky({0.5f, 1, 2});
      const Camera camera = lookAt({0, 2, 5}, {0, 1, 0});
      const Image constant = Traced(device, maker.scene).render(camera, settings(40, 30, 48, 6)).image;
      maker.scene.sky->image = {width, width / 2, std::vector<vec3>(width * (width / 2), maker.scene.sky->radiance)};
      const Image image = Traced(device, maker.scene).render(camera, settings(40, 30, 48, 6, 9)).image;
      for (int k = 0; k < 3; ++k) CHECK(meanOf(image, k).value == Approx(meanOf(constant, k).value).epsilon(0.01));
    }
  }
}

TEST_CASE("The sky image stands upright: +y at the top, -z in the middle, +x to its right") {
  Image image{64, 32, std::vector<vec3>(64 * 32, vec3(0))};
  const auto mark = [&](int x, int y, const vec3& colour) {
    for (int i = -2; i < 2; ++i)
      for (int j = -2; j < 2; ++j) image.at((x + i + 64) % 64, std::clamp(y + j, 0, 31)) = colour;
  };
  mark(32, 16, {1, 0, 0});
  mark(48, 16, {0, 1, 0});
  mark(0, 16, {0, 0, 1});
  for (int x = 0; x < 64; ++x) image.at(x, 0) = image.at(x, 1) = {1, 1, 0};
  SceneMaker maker;
  maker.scene.sky = SkyLight{vec3(0), "", image};
  const Traced traced(chosenDevice(), maker.scene);
  const auto seen = [&](const vec3& towards) {
    Camera camera = stare({0, 0, 0}, towards);
    camera.up = std::abs(towards.y) > 0.5f ? vec3(0, 0, 1) : vec3(0, 1, 0);
    return traced.render(camera, settings(1, 1, 1, 1)).image.at(0, 0);
  };
  CHECK(seen({0, 0, -1}) == vec3(1, 0, 0));
  CHECK(seen({1, 0, 0}) == vec3(0, 1, 0));
  CHECK(seen({0, 0, 1}) == vec3(0, 0, 1));
  CHECK(seen({-1, 0, 0}) == vec3(0, 0, 0));
  CHECK(seen({0, 1, 0}) == vec3(1, 1, 0));
  CHECK(seen({0, -1, 0}) == vec3(0, 0, 0));
}

TEST_CASE("A texture is bilinear, repeats, has v = 0 in its bottom row, and is held within [0, 1]") {
  for (const Device& device : devices()) {
    SceneMaker maker;
    const uint32_t material = maker.material(vec3(0.123f));
    maker.scene.materials[material].texture = 0;
    maker.scene.textures.push_back(textureOf({2, 2, {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {5, -1, NAN}}}));
    maker.parallelogram({0, 0, 1}, {1, 0, 0}, {0, 0, -1}, material);  // u along x, v along -z.
    maker.scene.uvs = {{0, 0}, {4, 0}, {4, 4}, {0, 4}};               // Four times over.
    maker.sky(vec3(1));
    const Traced traced(device, maker.scene);
    const auto seen = [&](float u, float v) {
      const vec3 point(u / 4, 0, 1 - v / 4);
      Camera camera = stare(point + vec3(0, 1, 0), point);
      camera.up = {0, 0, -1};
      return traced.render(camera, settings(1, 1, 1, 1)).image.at(0, 0);
    };
    const auto close = [](const vec3& a, const vec3& b) { return glm::length(a - b) < 1e-3f; };
    for (const float shift : {0.0f, 1.0f, 3.0f}) {
      CHECK(close(seen(shift + 0.25f, 0.75f), {1, 0, 0}));
      CHECK(close(seen(shift + 0.75f, 0.75f), {0, 1, 0}));
      CHECK(close(seen(0.25f, shift + 0.25f), {0, 0, 1}));
      CHECK(close(seen(shift + 0.75f, shift + 0.25f), {1, 0, 0}));
      CHECK(close(seen(shift + 0.5f, 0.75f), {0.5f, 0.5f, 0}));
      CHECK(close(seen(0.25f, shift + 0.6f), {0.7f, 0, 0.3f}));
    }
    // Where the image is missing the material's own colour stands in.
    maker.scene.textures[0].texels.reset();
    const Traced plain(device, maker.scene);
    const Image untextured = plain.render(stare({0.5f, 1, 0.4f}, {0.5f, 0, 0.4f}), settings(1, 1, 1, 1)).image;
    CHECK(close(untextured.at(0, 0), vec3(0.123f)));
  }
}

TEST_CASE("Albedos above 1 are held at 1, and the number of light samples changes noise alone") {
  for (const Device& device : devices()) {
    SceneMaker maker;
    maker.box({-1, -1, -1}, {1, 1, 1}, maker.material({7, 0.5f, -3}), 5);
    maker.scene.quads.push_back({{-0.5f, 0.9f, -0.5f}, {1, 0, 0}, {0, 0, 1}, vec3(3)});
    maker.triangle({-0.5f, -0.5f, 0}, {0, 0.5f, 0}, {0.5f, -0.5f, 0}, maker.material(vec3(0.2f), vec3(1)));
    maker.sky(vec3(0.2f));
    const Traced traced(device, maker.scene);
    const Camera camera = lookAt({0, 0, 4}, {0, 0, 0}, 25);
    const auto green = [&](int lightSamples, uint64_t seed) {
      RenderSettings wanted = settings(32, 32, 40, 6, seed);
      wanted.lightSamples = lightSamples;
      const Image image = traced.render(camera, wanted).image;
      CHECK(allFinite(image));
      return meanOf(image, 1).value;
    };
    const double one = green(1, 1);
    for (const int lightSamples : {3, 9}) CHECK(green(lightSamples, 2) == Approx(one).epsilon(0.015));
  }
}
