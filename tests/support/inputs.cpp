// The generators behind inputs.h.
#include "tests/support/inputs.h"

#include <cmath>
#include <functional>
#include <map>
#include <random>
#include <stdexcept>

#include "builder/parallel/sanitizers.h"

namespace copse::test {

namespace {

/// Uniform numbers that do not depend on the standard library's distributions.
class Draw {
 public:
  explicit Draw(uint32_t seed) : engine_(seed) {}
  /// In [0, 1).
  float unit() { return static_cast<float>(engine_() >> 8) * 0x1p-24f; }
  vec3 point() {
    const float x = unit(), y = unit(), z = unit();
    return {x, y, z};
  }
  /// In [-1, 1)³.
  vec3 offset() { return point() * 2.0f - vec3(1); }

 private:
  std::mt19937 engine_;
};

struct Triangle {
  vec3 a, b, c;
};

Triangle around(Draw& draw, const vec3& centre, float size) {
  const vec3 a = centre + size * draw.offset(), b = centre + size * draw.offset(), c = centre + size * draw.offset();
  return {a, b, c};
}

/// The edge length with which `count` triangles fill a unit cube about evenly.
float edge(uint32_t count) { return 0.7f / std::cbrt(static_cast<float>(count) + 1); }

using Make = std::function<Triangle(Draw&, uint32_t i, uint32_t count)>;

Triangle random(Draw& draw, uint32_t, uint32_t count) {
  const vec3 centre = draw.point();
  return around(draw, centre, edge(count));
}

Triangle moved(const Triangle& t, float scale, const vec3& by) {
  return {t.a * scale + by, t.b * scale + by, t.c * scale + by};
}

Triangle equalCentres(Draw& draw, uint32_t, uint32_t) {
  const vec3 corner = draw.offset() + vec3(0, 0, 1e-3f);
  return {-corner, corner, corner * draw.unit()};
}

Triangle coplanar(Draw& draw, uint32_t, uint32_t count) {
  Triangle t = random(draw, 0, count);
  t.a.z = t.b.z = t.c.z = 0.3f;
  return t;
}

Triangle collinear(Draw& draw, uint32_t, uint32_t count) {
  Triangle t = random(draw, 0, count);
  t.a.y = t.b.y = t.c.y = -1;
  t.a.z = t.b.z = t.c.z = 2;
  return t;
}

/// Two triangles per cell, cells in a cube; many centres share a coordinate.
Triangle grid(Draw&, uint32_t i, uint32_t count) {
  const auto side = static_cast<uint32_t>(std::ceil(std::cbrt(count / 2.0)));
  const uint32_t cell = i / 2;
  const vec3 at(static_cast<float>(cell % side), static_cast<float>(cell / side % side),
                static_cast<float>(cell / side / side));
  if (i % 2) return {at, at + vec3(1, 0, 0), at + vec3(1, 1, 0)};
  return {at, at + vec3(1, 1, 0), at + vec3(0, 1, 0)};
}

Triangle twoClusters(Draw& draw, uint32_t i, uint32_t count) {
  return moved(random(draw, i, count), 1, i % 3 ? vec3(0) : vec3(20000, -7000, 300));
}

Triangle oneHuge(Draw& draw, uint32_t i, uint32_t count) {
  if (i == count / 2) return {vec3(-1e4f, -1e4f, 0.5f), vec3(1e4f, -1e4f, 0.5f), vec3(0, 2e4f, 0.6f)};
  return random(draw, i, count);
}

/// Points, and edges with three corners on a line.
Triangle zeroArea(Draw& draw, uint32_t i, uint32_t count) {
  const Triangle t = random(draw, i, count);
  if (i % 2) return {t.a, t.a, t.a};
  return {t.a, t.b, t.a};
}

Triangle shrinking(Draw& draw, uint32_t i, uint32_t count) {
  const float scale = std::ldexp(1.0f, -static_cast<int>(i % 100));
  return moved(random(draw, i, count), scale, vec3(scale, 0, 0));
}

const std::map<std::string, Make>& makers() {
  static const std::map<std::string, Make> all{
      {"random", random},
      {"identical",
       [](Draw&, uint32_t, uint32_t) {
         return Triangle{{0.1f, 0.2f, 0.3f}, {1, 0.3f, 0.5f}, {0, 1, 0.7f}};
       }},
      {"equal-centres", equalCentres},
      {"coplanar", coplanar},
      {"collinear", collinear},
      {"grid", grid},
      {"two-clusters", twoClusters},
      {"one-huge", oneHuge},
      {"zero-area", zeroArea},
      {"negative", [](Draw& d, uint32_t i, uint32_t n) { return moved(random(d, i, n), 5, vec3(-50, -60, -70)); }},
      {"large", [](Draw& d, uint32_t i, uint32_t n) { return moved(random(d, i, n), 1e3f, vec3(1e6f, -1e6f, 2e6f)); }},
      {"tiny", [](Draw& d, uint32_t i, uint32_t n) { return moved(random(d, i, n), 1e-6f, vec3(0)); }},
      {"shrinking", shrinking},
  };
  return all;
}

}  // namespace

uint32_t many(uint32_t count) {
#if defined(COPSE_ASAN) || defined(COPSE_TSAN)
  return count / 10;
#else
  return count;
#endif
}

const std::vector<uint32_t>& inputSizes() {
  static const std::vector<uint32_t> sizes{0,  1,  2,  3,  5,  8,    9,    16,   17,          31,
                                           32, 33, 63, 64, 65, 1023, 1024, 1025, many(100000)};
  return sizes;
}

const std::vector<std::string>& inputNames() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> all;
    for (const auto& [name, make] : makers()) all.push_back(name);
    return all;
  }();
  return names;
}

TestMesh makeInput(const std::string& name, uint32_t count, uint32_t seed) {
  const Make& make = makers().at(name);
  TestMesh mesh{name, {}, {}};
  mesh.positions.reserve(3 * static_cast<std::size_t>(count));
  mesh.indices.reserve(count);
  Draw draw(seed);
  for (uint32_t i = 0; i < count; ++i) {
    const Triangle t = make(draw, i, count);
    mesh.positions.insert(mesh.positions.end(), {t.a, t.b, t.c});
    mesh.indices.push_back(uvec3(3 * i, 3 * i + 1, 3 * i + 2));
  }
  return mesh;
}

}  // namespace copse::test
