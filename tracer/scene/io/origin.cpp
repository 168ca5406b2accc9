// Bounds in double, the move and the rounding; where the rays of a far view start.
#include "tracer/scene/io/origin.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <limits>

namespace copse {
namespace {

using glm::dvec3;

double largest(const dvec3& v) { return std::max({v.x, v.y, v.z}); }

/// The depth of the nearest corner of a box along a view.
double nearestDepth(const Box& box, const dvec3& eye, const dvec3& forward) {
  double nearest = std::numeric_limits<double>::infinity();
  for (int corner = 0; corner < 8; ++corner) {
    const dvec3 p(corner & 1 ? box.hi.x : box.lo.x, corner & 2 ? box.hi.y : box.lo.y, corner & 4 ? box.hi.z : box.lo.z);
    nearest = std::min(nearest, glm::dot(p - eye, forward));
  }
  return nearest;
}

}  // namespace

dvec3 originOf(std::span<const dvec3> positions) {
  dvec3 lo(std::numeric_limits<double>::infinity()), hi = -lo;
  for (const dvec3& p : positions) {
    if (!std::isfinite(p.x + p.y + p.z)) continue;
    lo = glm::min(lo, p);
    hi = glm::max(hi, p);
  }
  if (!(lo.x <= hi.x)) return dvec3(0);
  const dvec3 middle = lo + 0.5 * (hi - lo);
  const double size = largest(hi - lo);
  if (!(largest(glm::abs(middle)) > farFrom * size)) return dvec3(0);
  if (!(size > 0)) return middle;
  const double step = std::exp2(std::floor(std::log2(size)));
  return glm::round(middle / step) * step;
}

void moveToOrigin(Scene& scene) {
  const dvec3 origin = scene.origin = originOf(scene.exactPositions);
  scene.positions.reserve(scene.exactPositions.size());
  for (const dvec3& p : scene.exactPositions) scene.positions.push_back(vec3(p - origin));
  scene.exactPositions = {};
  for (QuadLight& quad : scene.quads) {
    quad.corner = vec3(dvec3(quad.corner) + quad.cornerRest - origin);
    quad.cornerRest = dvec3(0);
  }
  for (Camera& camera : scene.cameras) {
    camera.setEye(camera.exactEye() - origin);
    camera.setAt(camera.exactAt() - origin);
  }
}

void finishViews(Scene& scene) {
  const Box bounds = scene.bounds();
  const double size = bounds.empty() ? 0 : glm::length(dvec3(bounds.hi) - dvec3(bounds.lo));
  for (Camera& camera : scene.cameras) {
    const dvec3 eye = camera.exactEye(), forward = glm::normalize(camera.exactAt() - eye);
    const double depth = size > 0 ? nearestDepth(bounds, eye, forward) : 0;
    if (depth > farFrom * size) {
      camera.start = depth - size;
    } else if (vec3(eye) != vec3(camera.exactAt())) {
      camera.eyeRest = camera.atRest = dvec3(0);
    }
  }
}

}  // namespace copse
