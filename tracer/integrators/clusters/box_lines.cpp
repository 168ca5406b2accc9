// Projection, clipping and tiles, in double precision: an edge that passes close to the eye ends very far outside the
// image.
#include "tracer/integrators/clusters/box_lines.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace copse {

namespace {

using dvec2 = glm::dvec2;
using dvec3 = glm::dvec3;

/// A point on the image plane, in pixels, with 1 / depth.
struct OnScreen {
  dvec2 at;
  double inverseDepth;
};

class Projection {
 public:
  explicit Projection(const Pinhole& pinhole)
      : eye_(pinhole.eye),
        forward_(pinhole.forward()),
        right_(pinhole.right),
        down_(pinhole.down),
        corner_(glm::dot(dvec3(pinhole.toCorner), right_) / glm::dot(right_, right_),
                glm::dot(dvec3(pinhole.toCorner), down_) / glm::dot(down_, down_)) {
    if (!(pinhole.start > 0)) return;
    // In a view from far away the eye is where the plane that rays start from is as far away as it is.
    right_ = dvec3(pinhole.startRight) / double{pinhole.start};
    down_ = dvec3(pinhole.startDown) / double{pinhole.start};
    forward_ = glm::normalize(glm::cross(right_, down_));
    corner_ = {glm::dot(dvec3(pinhole.toCorner), right_) / glm::dot(right_, right_),
               glm::dot(dvec3(pinhole.toCorner), down_) / glm::dot(down_, down_)};
    eye_ = dvec3(pinhole.startCorner) - (forward_ + corner_.x * right_ + corner_.y * down_) * double{pinhole.start};
  }

  double depth(const dvec3& point) const { return glm::dot(point - eye_, forward_); }
  OnScreen project(const dvec3& point) const {
    const double z = depth(point);
    const dvec3 onPlane = (point - eye_) / z;
    const dvec2 at(glm::dot(onPlane, right_) / glm::dot(right_, right_),
                   glm::dot(onPlane, down_) / glm::dot(down_, down_));
    return {at - corner_, 1 / z};
  }

 private:
  dvec3 eye_, forward_, right_, down_;
  dvec2 corner_;
};

/// Cuts the segment where f, linear along it, falls below 0. False where nothing is left.
bool cut(double fFrom, double fTo, double& from, double& to) {
  if (fFrom < 0 && fTo < 0) return false;
  const double crossing = fFrom / (fFrom - fTo);
  if (fFrom < 0) from = std::max(from, crossing);
  if (fTo < 0) to = std::min(to, crossing);
  return from < to;
}

dvec3 mix(const dvec3& a, const dvec3& b, double part) { return a + (b - a) * part; }

/// False where the edge has no length, or no part of it is in front of the eye and within `margin` pixels of the image.
bool edgeOnScreen(const Projection& projection, const dvec3& a, const dvec3& b, dvec2 size, double margin,
                  ScreenEdge& edge) {
  const double near = 1e-4 * glm::length(b - a);
  if (!(near > 0)) return false;
  double from = 0, to = 1;
  if (!cut(projection.depth(a) - near, projection.depth(b) - near, from, to)) return false;
  const OnScreen p = projection.project(mix(a, b, from)), q = projection.project(mix(a, b, to));
  from = 0, to = 1;
  for (int axis = 0; axis < 2; ++axis) {
    if (!cut(p.at[axis] + margin, q.at[axis] + margin, from, to)) return false;
    if (!cut(size[axis] + margin - p.at[axis], size[axis] + margin - q.at[axis], from, to)) return false;
  }
  edge.from = vec2(p.at + (q.at - p.at) * from);
  edge.to = vec2(p.at + (q.at - p.at) * to);
  edge.inverseDepthFrom = static_cast<float>(p.inverseDepth + (q.inverseDepth - p.inverseDepth) * from);
  edge.inverseDepthTo = static_cast<float>(p.inverseDepth + (q.inverseDepth - p.inverseDepth) * to);
  return edge.inverseDepthFrom > 0 && edge.inverseDepthTo > 0;
}

bool drawable(const Box& box) {
  const vec3 sum = box.lo + box.hi;
  return !box.empty() && std::isfinite(sum.x + sum.y + sum.z);
}

std::vector<ScreenEdge> project(std::span<const Box> boxes, const Pinhole& pinhole, dvec2 size, double margin) {
  const Projection projection(pinhole);
  std::vector<ScreenEdge> edges;
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    if (!drawable(boxes[i])) continue;
    const auto corner = [&](int bits) {
      const vec3 &lo = boxes[i].lo, &hi = boxes[i].hi;
      return dvec3(bits & 1 ? hi.x : lo.x, bits & 2 ? hi.y : lo.y, bits & 4 ? hi.z : lo.z);
    };
    for (int bits = 0; bits < 8; ++bits)
      for (int axis = 1; axis < 8; axis *= 2) {
        ScreenEdge edge{};
        edge.box = static_cast<uint32_t>(i);
        if (!(bits & axis) && edgeOnScreen(projection, corner(bits), corner(bits | axis), size, margin, edge))
          edges.push_back(edge);
      }
  }
  return edges;
}

double distanceTo(const ScreenEdge& edge, dvec2 point) {
  const dvec2 from(edge.from), along = dvec2(edge.to) - from;
  const double square = glm::dot(along, along);
  const double part = square > 0 ? std::clamp(glm::dot(point - from, along) / square, 0.0, 1.0) : 0;
  return glm::length(point - from - along * part);
}

}  // namespace

EdgesOnScreen::EdgesOnScreen(const Device& device, std::span<const Box> boxes, const Pinhole& pinhole, int width,
                             int height, float halfWidth)
    : halfWidth_(halfWidth) {
  constexpr double side = EdgesView::tileSide;
  const int across = (width + EdgesView::tileSide - 1) / static_cast<int>(EdgesView::tileSide);
  const int downwards = (height + EdgesView::tileSide - 1) / static_cast<int>(EdgesView::tileSide);
  tilesAcross_ = static_cast<uint32_t>(across);
  tilesDown_ = static_cast<uint32_t>(downwards);
  const std::vector<ScreenEdge> edges = project(boxes, pinhole, dvec2(width, height), halfWidth + 1.0);

  std::vector<std::vector<uint32_t>> tiles(static_cast<std::size_t>(across) * downwards);
  const double reach = side * std::sqrt(0.5) + halfWidth + 0.01;  // From a tile's middle to a line that touches it.
  for (std::size_t i = 0; i < edges.size(); ++i) {
    const vec2 lo = glm::min(edges[i].from, edges[i].to) - vec2(halfWidth);
    const vec2 hi = glm::max(edges[i].from, edges[i].to) + vec2(halfWidth);
    const auto tile = [&](float at, int count) {
      return std::clamp(static_cast<int>(std::floor(at / side)), 0, count - 1);
    };
    for (int y = tile(lo.y, downwards); y <= tile(hi.y, downwards); ++y)
      for (int x = tile(lo.x, across); x <= tile(hi.x, across); ++x)
        if (distanceTo(edges[i], {(x + 0.5) * side, (y + 0.5) * side}) <= reach)
          tiles[static_cast<std::size_t>(y) * across + x].push_back(static_cast<uint32_t>(i));
  }
  std::vector<uint32_t> firstOf{0}, inTile;
  for (const std::vector<uint32_t>& tile : tiles) {
    inTile.insert(inTile.end(), tile.begin(), tile.end());
    firstOf.push_back(static_cast<uint32_t>(inTile.size()));
  }
  edges_ = Buffer<ScreenEdge>(device, std::span<const ScreenEdge>(edges));
  firstOf_ = Buffer<uint32_t>(device, std::span<const uint32_t>(firstOf));
  inTile_ = Buffer<uint32_t>(device, std::span<const uint32_t>(inTile));
}

}  // namespace copse
