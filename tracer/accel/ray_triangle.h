// The watertight ray-triangle test of Woop, Benthin and Wald 2013: the triangle is sheared so that the ray runs along
// an axis, and three edge functions are compared with zero. Neighbours compute a shared edge alike, so no ray slips
// between them. An edge function that is exactly 0 in single precision, and a distance that is small beside those of
// the vertices, are computed again in double. No epsilon anywhere.
#pragma once

#include "builder/math/simd.h"
#include "tracer/accel/ray_box.h"

namespace copse::inline COPSE_ISA {

HD inline float absOf(float a) { return a < 0 ? -a : a; }

/// What the triangle test needs of a ray.
struct TriangleRay {
  uint32_t rowX, rowY, rowZ;  ///< Rows of a TraversalTriangle, in floats; rowZ is the ray's dominant axis.
  F32x4 originX, originY, originZ;
  F32x4 shearX, shearY, scaleZ;
  vec3 origin, direction;

  TriangleRay() = default;
  HD explicit TriangleRay(const Ray& ray) : origin(ray.origin), direction(ray.direction) {
    const vec3 o = ray.origin, d = ray.direction;
    const float ax = absOf(d.x), ay = absOf(d.y), az = absOf(d.z);
    if (az >= ax && az >= ay)
      set(0, 4, 8, vec3(o.x, o.y, o.z), vec3(d.x, d.y, d.z));
    else if (ay >= ax)
      set(8, 0, 4, vec3(o.z, o.x, o.y), vec3(d.z, d.x, d.y));
    else
      set(4, 8, 0, vec3(o.y, o.z, o.x), vec3(d.y, d.z, d.x));
  }

 private:
  HD void set(uint32_t x, uint32_t y, uint32_t z, const vec3& o, const vec3& d) {
    rowX = x, rowY = y, rowZ = z;
    // A triangle's fourth lane is not a coordinate; less 1 it is a harmless number.
    originX = F32x4(o.x, o.x, o.x, 1);
    originY = F32x4(o.y, o.y, o.y, 1);
    originZ = F32x4(o.z, o.z, o.z, 1);
    shearX = F32x4(d.x / d.z);
    shearY = F32x4(d.y / d.z);
    scaleZ = F32x4(1 / d.z);
  }
};

/// Where the ray enters the triangle's own box, or false where it misses that: by exactly BoxRay's arithmetic, so that
/// it enters every box around the triangle no later.
HD inline bool enterOwnBox(const BoxRay& boxes, const TraversalTriangle& triangle, F32x4 limits, float& near) {
  BinaryNode own;
  for (int c = 0; c < 2; ++c) {
    own.x[c] = minOf(triangle.x[0], minOf(triangle.x[1], triangle.x[2]));
    own.y[c] = minOf(triangle.y[0], minOf(triangle.y[1], triangle.y[2]));
    own.z[c] = minOf(triangle.z[0], minOf(triangle.z[1], triangle.z[2]));
    own.x[2 + c] = maxOf(triangle.x[0], maxOf(triangle.x[1], triangle.x[2]));
    own.y[2 + c] = maxOf(triangle.y[0], maxOf(triangle.y[1], triangle.y[2]));
    own.z[2 + c] = maxOf(triangle.z[0], maxOf(triangle.z[1], triangle.z[2]));
  }
  const BoxHits hits = boxes.test(own, limits);
  near = hits.near[0];
  return hits.hit(0);
}

/// Edge functions in double, where their products are exact.
COPSE_RARE HD inline F32x4 edgesInDouble(F32x4 x, F32x4 y) {
  float a[4], b[4], edge[3];
  x.store(a);
  y.store(b);
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    edge[i] = static_cast<float>(static_cast<double>(a[k]) * b[j] - static_cast<double>(b[k]) * a[j]);
  }
  return {edge[0], edge[1], edge[2], 0};
}

/// Where the ray meets the triangle's plane, in double: for vertices so far away that in single precision their
/// weighted mean says little about a distance.
COPSE_RARE HD inline float planeDistance(vec3 origin, vec3 direction, const TraversalTriangle& t) {
  const double ax = t.x[0], ay = t.y[0], az = t.z[0];
  const double ux = t.x[1] - ax, uy = t.y[1] - ay, uz = t.z[1] - az;
  const double vx = t.x[2] - ax, vy = t.y[2] - ay, vz = t.z[2] - az;
  const double nx = uy * vz - uz * vy, ny = uz * vx - ux * vz, nz = ux * vy - uy * vx;
  const double towards = nx * direction.x + ny * direction.y + nz * direction.z;
  return static_cast<float>((nx * (ax - origin.x) + ny * (ay - origin.y) + nz * (az - origin.z)) / towards);
}

/// The leaf filter that accepts every hit. Another, such as an alpha mask, is called for each triangle that would be
/// the hit: `HD bool operator()(uint32_t triangle, float u, float v) const` is false where the ray passes through it.
/// The answer must be the same each time, as a triangle may be met again.
struct AcceptAll {
  HD bool operator()(uint32_t, float, float) const { return true; }
};

/// If the ray hits `triangle` nearer than `best`, or as near with a lower id, and `accepts` says so, writes it to
/// `best` and returns true. The distance is never less than where the ray enters the triangle's box, and only what hits
/// that box counts: so a tree can lose no hit, and the hit found does not depend on the tree.
template <class Filter = AcceptAll>
HD inline bool intersect(const TriangleRay& ray, const BoxRay& boxes, float tMin, const TraversalTriangle& triangle,
                         Hit& best, const Filter& accepts = {}) {
  const float* const rows = reinterpret_cast<const float*>(&triangle);
  const F32x4 atZ = F32x4::loadAligned(rows + ray.rowZ) - ray.originZ;
  const F32x4 x = (F32x4::loadAligned(rows + ray.rowX) - ray.originX) - ray.shearX * atZ;
  const F32x4 y = (F32x4::loadAligned(rows + ray.rowY) - ray.originY) - ray.shearY * atZ;
  F32x4 edge = x.shuffle<2, 0, 1, 3>() * y.shuffle<1, 2, 0, 3>() - y.shuffle<2, 0, 1, 3>() * x.shuffle<1, 2, 0, 3>();
  const F32x4 zero(0);
  uint32_t below = (edge < zero).bits() & 7, above = (zero < edge).bits() & 7;
  if (below && above) return false;
  if ((below | above) != 7) {
    edge = edgesInDouble(x, y);
    below = (edge < zero).bits() & 7, above = (zero < edge).bits() & 7;
    if (below && above) return false;
  }
  float u[4], h[4];
  edge.store(u);
  (edge * (atZ * ray.scaleZ)).store(h);
  const float sum = u[0] + u[1] + u[2];
  const float height = h[0] + h[1] + h[2];
  float t = height / sum;
  if (absOf(h[0]) + absOf(h[1]) + absOf(h[2]) > 16 * absOf(height))
    t = planeDistance(ray.origin, ray.direction, triangle);
  if (!(t > tMin && t <= best.t)) return false;  // Also where the sum is 0.
  float near;
  if (!enterOwnBox(boxes, triangle, BoxRay::limits(tMin, best.t), near)) return false;
  const float distance = maxOf(t, near);
  const bool lower = best.triangle != Hit::none && triangle.id < best.triangle;
  if (!(distance < best.t || (distance == best.t && lower))) return false;
  const float second = u[1] / sum, third = u[2] / sum;
  if (!accepts(triangle.id, second, third)) return false;
  best = {distance, second, third, triangle.id};
  return true;
}

}  // namespace copse::inline COPSE_ISA
