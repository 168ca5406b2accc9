// The plane of a polygon, the two ways to cut a quad, and ear clipping for more corners.
#include "tracer/scene/io/polygon.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>

#include "tracer/scene/io/ear_clipping.h"

namespace copse {
namespace {

using dvec2 = glm::dvec2;
using dvec3 = glm::dvec3;

dvec3 newellNormal(std::span<const vec3> corners) {
  dvec3 normal(0);
  const dvec3 origin = corners[0];
  for (std::size_t i = 0; i < corners.size(); ++i)
    normal += glm::cross(dvec3(corners[i]) - origin, dvec3(corners[(i + 1) % corners.size()]) - origin);
  return normal;
}

/// Along the axis in which the normal is longest, so that the polygon keeps most of its area, counter-clockwise. So
/// the coordinates stay as they are, and what lies on one line in space does so in the plane.
std::vector<dvec2> project(std::span<const vec3> corners, const dvec3& normal) {
  const dvec3 size = glm::abs(normal);
  const int axis = size.x > size.y && size.x > size.z ? 0 : size.y > size.z ? 1 : 2;
  const int u = (axis + 1) % 3, v = (axis + 2) % 3;
  const bool flip = normal[axis] < 0;
  std::vector<dvec2> flat;
  flat.reserve(corners.size());
  for (const vec3& p : corners) flat.push_back(flip ? dvec2(p[v], p[u]) : dvec2(p[u], p[v]));
  return flat;
}

/// By the diagonal that stays inside; if both do, the shorter.
bool cutQuad(std::span<const vec3> corners, const dvec3& normal, std::vector<uvec3>& triangles) {
  const auto side = [&](int a, int b, int c) {
    const dvec3 origin = corners[a];
    return glm::dot(glm::cross(dvec3(corners[b]) - origin, dvec3(corners[c]) - origin), normal);
  };
  const bool first = side(0, 1, 2) >= 0 && side(0, 2, 3) >= 0;
  const bool second = side(0, 1, 3) >= 0 && side(1, 2, 3) >= 0;
  const bool shorter = glm::distance(corners[0], corners[2]) <= glm::distance(corners[1], corners[3]);
  if (first && (!second || shorter)) {
    triangles.insert(triangles.end(), {{0, 1, 2}, {0, 2, 3}});
  } else {
    triangles.insert(triangles.end(), {{0, 1, 3}, {1, 2, 3}});
  }
  return first || second;
}

/// Whether the triangles' areas sum up to no more than the polygon's, but for what rounding may do.
bool coversOnce(std::span<const vec3> corners, const dvec3& normal, std::span<const uvec3> triangles) {
  const dvec3 origin = corners[0];
  const double length = glm::length(normal);
  double extent = 0, area = 0;
  for (const vec3& p : corners) extent = std::max(extent, glm::distance(dvec3(p), origin));
  for (const uvec3& t : triangles) {
    const dvec3 a = corners[t.x];
    const dvec3 one = glm::cross(dvec3(corners[t.y]) - a, dvec3(corners[t.z]) - a);
    area += length > 0 ? std::abs(glm::dot(one, normal)) / length : glm::length(one);
  }
  return area - length <= 1e-6 * extent * extent;
}

}  // namespace

bool triangulate(std::span<const vec3> corners, std::vector<uvec3>& triangles) {
  const uint32_t n = static_cast<uint32_t>(corners.size());
  const std::size_t begin = triangles.size();
  if (n == 3) {
    triangles.push_back({0, 1, 2});
    return true;
  }
  const dvec3 normal = newellNormal(corners);
  const double length = glm::length(normal);
  // The normal is 0 where all lies on one line, and where the parts of a polygon that crosses itself cancel out.
  const bool isFan = !(length > 0) || !std::isfinite(length);
  for (uint32_t i = 2; isFan && i < n; ++i) triangles.push_back({0, i - 1, i});
  if (isFan && length != 0) return true;  // These will be dropped.
  const bool isSimple =
      !isFan && (n == 4 ? cutQuad(corners, normal, triangles) : clipEars(project(corners, normal), triangles));
  return isSimple || coversOnce(corners, normal, std::span(triangles).subspan(begin));
}

void noteCrossingFaces(const std::string& file, std::size_t count, std::vector<std::string>& notes) {
  if (count == 0) return;
  notes.push_back(fmt::format("{}: cut {} {} into triangles that overlap or leave {}", file, count,
                              count == 1 ? "face that crosses itself" : "faces that cross themselves",
                              count == 1 ? "it" : "them"));
}

}  // namespace copse
