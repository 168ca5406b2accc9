// Powers and records of all lights, and the table by which an image of the sky is sampled.
#include "tracer/lights/light_table.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <numbers>

#include "tracer/lights/lights.h"

namespace copse {

namespace {

using dvec3 = glm::dvec3;

/// The cells of a sky's table: more would cost memory and cache, and gain little.
constexpr int largestTableWidth = 1024, largestTableHeight = 512;

/// Adds a record if the light has power.
bool addLight(std::vector<LightRecord>& lights, std::vector<double>& powers, LightKind kind, const vec3& corner,
              const vec3& edge1, const vec3& edge2, const vec3& radiance) {
  const double cross = glm::length(glm::cross(dvec3(edge1), dvec3(edge2)));
  const double part = kind == LightKind::triangle ? 0.5 : 1, sides = kind == LightKind::triangle ? 2 : 1;
  const double power = sides * part * cross * luminance(radiance) * pi;
  const float inverse = static_cast<float>(1 / cross);
  if (!(power > 0) || !std::isfinite(power) || !std::isfinite(inverse)) return false;
  LightRecord light;
  light.corner = corner;
  light.edge1 = edge1;
  light.edge2 = edge2;
  light.density = static_cast<float>(1 / (part * cross));  // Times the light's probability, once that is known.
  light.inverseCross = inverse;
  light.kind = kind;
  light.radiance = radiance;
  light.offset = errorAlong(unitNormal(edge1, edge2), corner, edge1, edge2) +
                 distanceError * largest(maxOf(glm::abs(edge1), glm::abs(edge2)));
  lights.push_back(light);
  powers.push_back(power);
  return true;
}

double skyPower(const Scene& scene, double meanLuminance) {
  const Box box = scene.bounds();
  const double radius = box.empty() ? 0 : glm::length(dvec3(box.hi) - dvec3(box.lo)) / 2;
  return pi * pi * (radius > 0 ? radius * radius : 1) * meanLuminance;
}

}  // namespace

vec3 usableRadiance(const vec3& radiance) {
  vec3 usable(0);
  for (int k = 0; k < 3; ++k)
    if (std::isfinite(radiance[k]) && radiance[k] > 0) usable[k] = radiance[k];
  return usable;
}

SkyTable makeSkyTable(const Image& sky) {
  SkyTable table;
  const int width = sky.width, height = sky.height;
  table.width = static_cast<uint32_t>(std::min(width, largestTableWidth));
  table.height = static_cast<uint32_t>(std::min(height, largestTableHeight));
  table.weights.assign(static_cast<std::size_t>(table.width) * table.height, 0);
  // A bilinear image is not black beside a bright pixel: a pixel's share is the integral over its own square, which
  // takes 6/8 of itself and 1/8 of each neighbour along each axis.
  std::vector<double> rows(static_cast<std::size_t>(width) * 3);
  double weightSum = 0, sineSum = 0;
  for (int y = 0; y < height; ++y) {
    for (int k = 0; k < 3; ++k) {
      const int from = std::clamp(y + k - 1, 0, height - 1);
      for (int x = 0; x < width; ++x)
        rows[static_cast<std::size_t>(k) * width + x] = luminance(usableRadiance(sky.at(x, from)));
    }
    const double sine = std::sin(std::numbers::pi * (y + 0.5) / height);
    sineSum += sine * width;
    const auto column = [&](int x) {
      const double* row = rows.data() + x;
      return (row[0] + 6 * row[width] + row[2 * static_cast<std::size_t>(width)]) / 8;
    };
    for (int x = 0; x < width; ++x) {
      const double mean = (column((x + width - 1) % width) + 6 * column(x) + column((x + 1) % width)) / 8;
      const std::size_t cell = static_cast<std::size_t>(static_cast<int64_t>(y) * table.height / height) * table.width +
                               static_cast<std::size_t>(static_cast<int64_t>(x) * table.width / width);
      table.weights[cell] += mean * sine;
      weightSum += mean * sine;
    }
  }
  table.meanLuminance = sineSum > 0 ? weightSum / sineSum : 0;
  // Where a cell's border cuts a pixel, the pixel's share went to one side only; neither side may be left with nothing.
  if (width % table.width || height % table.height) {
    const double floor = weightSum / static_cast<double>(table.weights.size()) * 1e-3;
    for (double& weight : table.weights) weight += floor;
  }
  return table;
}

LightTable makeLightTable(const Scene& scene) {
  LightTable table;
  std::vector<double> powers;
  for (const QuadLight& quad : scene.quads)
    addLight(table.lights, powers, LightKind::quad, quad.corner, quad.edgeU, quad.edgeV, usableRadiance(quad.radiance));
  table.firstTriangle = static_cast<uint32_t>(table.lights.size());
  for (std::size_t i = 0; i < scene.triangles.size(); ++i) {
    if (!scene.emits(i)) continue;
    const uvec3 t = scene.triangles[i];
    const vec3 corner = scene.positions[t.x];
    if (addLight(table.lights, powers, LightKind::triangle, corner, scene.positions[t.y] - corner,
                 scene.positions[t.z] - corner, usableRadiance(scene.materials[scene.materialOf[i]].ke)))
      table.emittingTriangles.push_back(static_cast<uint32_t>(i));
  }
  if (scene.sky) {
    const Image& image = scene.sky->image;
    const double mean =
        image.pixels.empty() ? luminance(usableRadiance(scene.sky->radiance)) : makeSkyTable(image).meanLuminance;
    const double power = skyPower(scene, mean);
    if (power > 0 && std::isfinite(power)) {
      LightRecord light{};
      light.kind = LightKind::sky;
      light.density = 1;
      table.lights.push_back(light);
      powers.push_back(power);
    }
  }

  table.cells = aliasTable(powers);
  if (table.cells.empty()) return {};
  for (std::size_t i = 0; i < table.lights.size(); ++i) {
    table.lights[i].density *= table.cells[i].probability;
    if (table.lights[i].kind == LightKind::sky) table.skyProbability = table.cells[i].probability;
  }
  return table;
}

}  // namespace copse
