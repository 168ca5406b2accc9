// What generators build with: grids, surfaces of revolution, boxes and tubes, in frames. In counting mode the same
// calls only add up triangles, in constant time each, so that a tessellation can be chosen before any is made.
#pragma once

#include <cmath>
#include <cstdint>
#include <numbers>
#include <vector>

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "tracer/scene/scene.h"

namespace copse::generator {

using glm::dvec2;
using glm::dvec3;
constexpr double pi = std::numbers::pi;

/// A place with directions; points in it are given as (along x, along y, along z).
struct Frame {
  dvec3 origin{0, 0, 0}, x{1, 0, 0}, y{0, 1, 0}, z{0, 0, 1};

  dvec3 operator()(double a, double b, double c) const { return origin + a * x + b * y + c * z; }
  dvec3 operator()(const dvec3& p) const { return (*this)(p.x, p.y, p.z); }
  Frame at(double a, double b, double c) const { return {(*this)(a, b, c), x, y, z}; }
  Frame scaled(double s) const { return {origin, s * x, s * y, s * z}; }
  /// Turned about y, from z towards x.
  Frame turned(double angle) const {
    const double c = std::cos(angle), s = std::sin(angle);
    return {origin, c * x - s * z, y, s * x + c * z};
  }
};

/// The outline that a lathe turns: radius and height, from the bottom up. Curves take `steps` lines.
class Profile {
 public:
  Profile(double radius, double height) : points{{radius, height}} {}

  Profile& to(double radius, double height) {
    points.push_back({radius, height});
    return *this;
  }
  /// A quarter of an ellipse that leaves sideways and arrives upright.
  Profile& outUp(double radius, double height, uint32_t steps) { return quarter(radius, height, steps, true); }
  /// A quarter of an ellipse that leaves upright and arrives sideways.
  Profile& upOut(double radius, double height, uint32_t steps) { return quarter(radius, height, steps, false); }
  /// A round moulding that stands out by `out` and ends at the radius that it left.
  Profile& torus(double out, double height, uint32_t steps) {
    const dvec2 p = points.back();
    return outUp(p.x + out, 0.5 * (p.y + height), steps).upOut(p.x, height, steps);
  }
  /// Leaves and arrives upright.
  Profile& ease(double radius, double height, uint32_t steps) {
    const dvec2 a = points.back();
    for (uint32_t i = 1; i <= steps; ++i) {
      const double t = static_cast<double>(i) / steps;
      to(a.x + (radius - a.x) * t * t * (3 - 2 * t), a.y + (height - a.y) * t);
    }
    return *this;
  }

  std::vector<dvec2> points;

 private:
  Profile& quarter(double radius, double height, uint32_t steps, bool sidewaysFirst) {
    const dvec2 a = points.back();
    for (uint32_t i = 1; i <= steps; ++i) {
      const double angle = 0.5 * pi * i / steps, s = std::sin(angle), c = 1 - std::cos(angle);
      to(a.x + (radius - a.x) * (sidewaysFirst ? s : c), a.y + (height - a.y) * (sidewaysFirst ? c : s));
    }
    points.back() = {radius, height};  // To the last bit: a radius of 0 closes a lathe's surface in one point.
    return *this;
  }
};

class MeshBuilder {
 public:
  /// Adds to `scene`, or only counts where there is none.
  explicit MeshBuilder(Scene* scene) : scene_(scene) {}

  void use(uint32_t material) { material_ = material; }
  uint64_t count() const { return count_; }

  void triangle(const dvec3& a, const dvec3& b, const dvec3& c);
  void quad(const dvec3& a, const dvec3& b, const dvec3& c, const dvec3& d);
  /// All six faces between two corners.
  void box(const Frame& frame, const dvec3& lo, const dvec3& hi);
  /// A ring where the profile has radius 0 is one point.
  void lathe(const Frame& frame, const Profile& profile, uint32_t sides);
  /// A tube of `sides` along the points, open at its ends.
  void tube(const std::vector<dvec3>& path, double radius, uint32_t sides);
  /// The same for a path with any bends: the ring's direction is carried along, so that the tube does not twist.
  void bentTube(const std::vector<dvec3>& path, double radius, uint32_t sides);

  /// nu x nv cells of two triangles over place(u, v), u and v in [0, 1]; `closed` joins u = 1 to u = 0.
  template <typename Place>
  void grid(uint32_t nu, uint32_t nv, const Place& place, bool closed = false) {
    count_ += 2ull * nu * nv;
    if (!scene_) return;
    const uint32_t first = static_cast<uint32_t>(scene_->positions.size()), columns = closed ? nu : nu + 1;
    for (uint32_t j = 0; j <= nv; ++j)
      for (uint32_t i = 0; i < columns; ++i)
        scene_->positions.push_back(vec3(place(static_cast<double>(i) / nu, static_cast<double>(j) / nv)));
    for (uint32_t j = 0; j < nv; ++j)
      for (uint32_t i = 0; i < nu; ++i) {
        const uint32_t next = closed && i + 1 == nu ? 0 : i + 1, row = first + j * columns;
        add(row + i, row + next, row + columns + next);
        add(row + i, row + columns + next, row + columns + i);
      }
  }

 private:
  uint32_t vertex(const dvec3& p) {
    scene_->positions.push_back(vec3(p));
    return static_cast<uint32_t>(scene_->positions.size() - 1);
  }
  void add(uint32_t a, uint32_t b, uint32_t c) {
    scene_->triangles.push_back({a, b, c});
    scene_->materialOf.push_back(material_);
  }

  Scene* scene_;
  uint64_t count_ = 0;
  uint32_t material_ = 0;
};

}  // namespace copse::generator
