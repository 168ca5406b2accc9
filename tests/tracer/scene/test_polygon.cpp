// Polygons into triangles: the area and the cover of outlines that touch themselves in every way, and of large ones.
#include "tracer/scene/io/polygon.h"

#include <cmath>
#include <random>

#include "tests/support/catch.h"
#include "tests/support/lattice_polygon.h"
#include "tracer/scene/io/orientation.h"

using namespace copse;
using namespace copse::test;

namespace {

struct Cut {
  std::vector<vec3> corners;
  std::vector<uvec3> triangles;
  bool isRight;

  explicit Cut(std::vector<vec3> polygon) : corners(std::move(polygon)), isRight(triangulate(corners, triangles)) {}

  double side(const uvec3& t) const { return twice(corners[t.x], corners[t.y], corners[t.z]); }
  /// Twice the area in the xy plane, where each triangle counts as if it were apart.
  double doubleArea() const {
    double sum = 0;
    for (const uvec3& t : triangles) sum += std::abs(side(t));
    return sum;
  }
  double doublePolygonArea() const {
    double sum = 0;
    for (std::size_t i = 0; i < corners.size(); ++i)
      sum += twice({0, 0, 0}, corners[i], corners[(i + 1) % corners.size()]);
    return std::abs(sum);
  }
  int countAround(const vec3& p) const {
    int count = 0;
    for (const uvec3& t : triangles) {
      const double a = twice(corners[t.x], corners[t.y], p), b = twice(corners[t.y], corners[t.z], p),
                   c = twice(corners[t.z], corners[t.x], p);
      count += (a > 0 && b > 0 && c > 0) || (a < 0 && b < 0 && c < 0);
    }
    return count;
  }
  static double twice(const vec3& a, const vec3& b, const vec3& c) {
    return (double{b.x} - a.x) * (double{c.y} - a.y) - (double{b.y} - a.y) * (double{c.x} - a.x);
  }
};

std::vector<vec3> flat(const std::vector<glm::ivec2>& points) {
  std::vector<vec3> polygon;
  for (const glm::ivec2 p : points) polygon.push_back({p.x, p.y, 0});
  return polygon;
}

/// In the tilted plane z = x - 2 y of a skewed lattice, in which all coordinates are whole still.
std::vector<vec3> skewed(const std::vector<glm::ivec2>& points, const glm::ivec2& u, const glm::ivec2& v) {
  std::vector<vec3> polygon;
  for (const glm::ivec2 p : points) {
    const glm::ivec2 q = p.x * u + p.y * v;
    polygon.push_back({q.x, q.y, q.x - 2 * q.y});
  }
  return polygon;
}

}  // namespace

TEST_CASE("a side of a line is exact where doubles round") {
  std::mt19937 random(5);
  const auto coordinate = [&] { return static_cast<int64_t>(random() % (1u << 24)); };
  for (int i = 0; i < 20'000; ++i) {
    // Whole numbers of 24 bits at scales so far apart that their differences do not fit into a double.
    const int64_t scale = i % 2 ? int64_t{1} << 32 : 1;
    const int64_t ax = coordinate(), ay = coordinate(), k = 1 + static_cast<int64_t>(random() % 5);
    const int64_t dx = coordinate() * scale, dy = coordinate() * scale, off = static_cast<int64_t>(random() % 3) - 1;
    const int64_t bx = ax + dx, by = ay + dy, cx = ax + k * dx, cy = ay + k * dy + off;
    const __int128 exact = __int128{bx - ax} * (cy - ay) - __int128{by - ay} * (cx - ax);
    if (std::max(cx, cy) >= int64_t{1} << 53) continue;
    const double found = orientation({double(ax), double(ay)}, {double(bx), double(by)}, {double(cx), double(cy)});
    REQUIRE((exact > 0) == (found > 0));
    REQUIRE((exact < 0) == (found < 0));
  }
}

TEST_CASE("doubled corners, spikes, holes by bridges and islands change no area") {
  const auto area = [](const std::vector<glm::ivec2>& points) {
    const Cut cut(flat(points));
    CHECK(cut.isRight);
    CHECK(cut.triangles.size() == points.size() - 2);
    return cut.doubleArea() / 2;
  };
  CHECK(area({{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}}) == 3);
  CHECK(area({{0, 0}, {2, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {1, 2}, {0, 2}}) == 3);
  CHECK(area({{0, 0}, {3, 0}, {3, 0}, {3, 2}, {2, 2}, {2, 1}, {2, 1}, {1, 1}, {1, 2}, {1, 2}, {0, 2}}) == 5);
  CHECK(area({{0, 0}, {4, 0}, {4, 2}, {4, 4}, {4, 2}, {2, 2}, {2, 4}, {0, 4}}) == 12);  // A spike out.
  CHECK(area({{0, 0}, {2, 0}, {2, 2}, {2, 0}, {4, 0}, {4, 4}, {0, 4}}) == 16);          // A spike in.
  CHECK(area({{0, 0}, {5, 0}, {5, 5}, {0, 5}, {0, 0}, {1, 1}, {1, 3}, {3, 3}, {3, 1}, {1, 1}}) == 21);
  // Two squares joined by a way with a bend, which is outside of both.
  CHECK(area({{0, 0}, {1, 0}, {1, 1}, {2, 3}, {3, 1}, {3, 0}, {4, 0}, {4, 1}, {3, 1}, {2, 3}, {1, 1}, {0, 1}}) == 2);
  // A hole at the end of a way with a bend, which is inside.
  CHECK(area({{0, 0}, {9, 0}, {9, 9}, {0, 9}, {0, 0}, {1, 5}, {4, 4}, {4, 5}, {5, 5}, {5, 4}, {4, 4}, {1, 5}}) == 80);
}

TEST_CASE("outlines of random cells are covered exactly once, however they touch themselves") {
  std::mt19937 random(20'27);
  std::uniform_real_distribution<> share(0.3, 0.95);
  for (int i = 0; i < 3'000; ++i) {
    const int width = 1 + static_cast<int>(random() % 8), height = 1 + static_cast<int>(random() % 8);
    const LatticePolygon shape =
        randomLatticePolygon(random, width, height, share(random), i % 4 ? 0 : i % 6, i % 3 ? 0 : 0.15);
    const glm::ivec2 us[] = {{1, 0}, {3, 1}, {-2, 7}}, vs[] = {{0, 1}, {-1, 4}, {5, 3}};
    const int k = i % 3;
    const int scale = std::abs(us[k].x * vs[k].y - us[k].y * vs[k].x);
    INFO("polygon " << i << " with " << shape.outline.size() << " corners");
    const Cut cut(skewed(shape.outline, us[k], vs[k]));
    REQUIRE(cut.isRight);
    REQUIRE(cut.triangles.size() == shape.outline.size() - 2);
    REQUIRE(cut.doubleArea() == 2.0 * 4 * shape.coveredCells() * scale);
    if (i % 10) continue;
    for (int y = 0; y < height; ++y)
      for (int x = 0; x < width; ++x) {
        const glm::vec2 p(2 * static_cast<float>(x) + 0.83f, 2 * static_cast<float>(y) + 1.31f);
        const glm::vec2 q = p.x * glm::vec2(us[k]) + p.y * glm::vec2(vs[k]);
        REQUIRE(cut.countAround({q, 0}) == shape.cells[static_cast<std::size_t>(y * width + x)]);
      }
  }
}

TEST_CASE("simple polygons of any size are covered, in about n log n") {
  std::mt19937 random(3);
  for (const int n : {5, 7, 30, 200, 3'000, 12'000}) {
    std::vector<vec3> coast, comb = {{0, -1, 0}, {float(n), -1, 0}}, spiral;
    for (int i = 0; i < n; ++i) {  // Around its middle, so it is simple.
      const double angle = 2 * M_PI * i / n, radius = 0.2 + 0.8 * static_cast<double>(random() % 1000) / 1000;
      coast.push_back({radius * std::cos(angle), radius * std::sin(angle), 0});
    }
    for (int i = n - 2; i > 0; --i) comb.push_back({float(i), i % 2 ? 50.0f : 0.0f, 0});
    for (int i = 0; i < 2 * n; ++i) {
      const double angle = 40.0 * (i < n ? i : 2 * n - 1 - i) / n, radius = angle + (i < n ? 1 : 3);
      spiral.push_back({radius * std::cos(angle), radius * std::sin(angle), 0});
    }
    if (n < 100) spiral = coast;  // Too coarse.
    for (const auto& polygon : {coast, comb, spiral}) {
      const Cut cut(polygon);
      INFO(polygon.size());
      CHECK(cut.isRight);
      CHECK(cut.triangles.size() == polygon.size() - 2);
      CHECK(cut.doubleArea() == Approx(cut.doublePolygonArea()).epsilon(1e-9));
    }
  }
}

TEST_CASE("a polygon that crosses itself is told apart, and gives n - 2 triangles in bounded time") {
  CHECK_FALSE(Cut({{0, 0, 0}, {3, 3, 0}, {3, 0, 0}, {0, 2, 0}}).isRight);
  CHECK_FALSE(Cut({{0, 0, 0}, {2, 2, 0}, {2, 0, 0}, {0, 2, 0}}).isRight);  // Both halves alike: no area in all.
  CHECK_FALSE(Cut({{0, 0, 0}, {4, 4, 0}, {4, 0, 0}, {0, 3, 0}, {-1, 1, 0}}).isRight);
  CHECK(Cut({{0, 0, 0}, {1, 1, 0}, {2, 2, 0}, {3, 3, 0}, {4, 4, 0}}).isRight);
  CHECK(Cut({{0, 0, 0}, {1, 1, 1}, {3, 3, 3}, {2, 2, 2}}).isRight);
  std::mt19937 random(4);
  for (const int n : {6, 20, 100, 300}) {
    std::vector<vec3> polygon;
    for (int i = 0; i < n; ++i) polygon.push_back({random() % 1000, random() % 1000, 0});
    const Cut cut(polygon);
    CHECK_FALSE(cut.isRight);
    CHECK(cut.triangles.size() == polygon.size() - 2);
  }
}

TEST_CASE("a quad is cut by the diagonal that stays inside, the shorter where both do") {
  using Triangles = std::vector<uvec3>;
  const Triangles first = {{0, 1, 2}, {0, 2, 3}}, second = {{0, 1, 3}, {1, 2, 3}};
  CHECK(Cut({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}).triangles == first);
  CHECK(Cut({{0, 0, 0}, {2, 0, 0}, {3, 1, 0}, {0, 1, 0}}).triangles == second);
  CHECK(Cut({{0, 0, 0}, {2, -2, 0}, {0, 4, 0}, {-2, -2, 0}}).triangles == first);
  CHECK(Cut({{-2, -2, 0}, {0, 0, 0}, {2, -2, 0}, {0, 4, 0}}).triangles == second);
  CHECK(Cut({{0, 0, 0}, {3, 0, 0}, {2, 0, 0}, {0, 2, 0}}).triangles == first);  // A spike.
  CHECK(Cut({{0, 0, 0}, {2, 0, 0}, {2, 0, 0}, {0, 2, 0}}).isRight);
}
