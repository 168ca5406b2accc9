// Boxes as wireframes over an image: their edges projected once on the host and sorted into tiles, so that a camera ray
// tests only the few edges near its own point. O(edges + tiles that they cross).
#pragma once

#include <span>

#include "builder/math/box.h"
#include "builder/parallel/buffer.h"
#include "tracer/integrators/pinhole.h"

namespace copse {

/// A visible part of an edge, in pixels. 1 / depth is linear along it, as perspective has it; depth is along the view.
struct ScreenEdge {
  vec2 from, to;
  float inverseDepthFrom, inverseDepthTo;
  uint32_t box;
};

struct EdgesView {
  static constexpr uint32_t tileSide = 16;

  const ScreenEdge* edges;
  const uint32_t* firstOf;  ///< Per tile, row by row, and one more: where its edges begin in `inTile`.
  const uint32_t* inTile;
  uint32_t tilesAcross, tilesDown;
  float halfWidth;  ///< Half the width of a line with its rim, in pixels.
};

class EdgesOnScreen {
 public:
  /// `halfWidth` > 0. Boxes that are empty or not finite have no edges.
  EdgesOnScreen(const Device& device, std::span<const Box> boxes, const Pinhole& pinhole, int width, int height,
                float halfWidth);
  EdgesView view() const {
    return {edges_.data(), firstOf_.data(), inTile_.data(), tilesAcross_, tilesDown_, halfWidth_};
  }

 private:
  Buffer<ScreenEdge> edges_;
  Buffer<uint32_t> firstOf_, inTile_;
  uint32_t tilesAcross_, tilesDown_;
  float halfWidth_;
};

/// The line at a point of the image: the nearest to the eye, but any line before any rim, so that small boxes stay
/// boxes.
struct EdgeHit {
  static constexpr uint32_t none = 0xffffffffu;

  uint32_t box = none;
  float depth = FLT_MAX;  ///< Along the view.
  bool isRim = true;      ///< The outer half of the line's width.
};

/// (x, y) in pixels, within the image or on its border: a sample of the last pixel may be rounded up to that.
HD inline EdgeHit nearestEdge(const EdgesView& view, float x, float y) {
  EdgeHit best;
  const auto tileAt = [](float at, uint32_t count) {
    const uint32_t tile = static_cast<uint32_t>(at) / EdgesView::tileSide;
    return tile < count ? tile : count - 1;
  };
  const uint32_t tile = tileAt(y, view.tilesDown) * view.tilesAcross + tileAt(x, view.tilesAcross);
  for (uint32_t i = view.firstOf[tile]; i < view.firstOf[tile + 1]; ++i) {
    const ScreenEdge& edge = view.edges[view.inTile[i]];
    const vec2 along = edge.to - edge.from, to = vec2(x, y) - edge.from;
    const float square = glm::dot(along, along);
    float part = square > 0 ? glm::dot(to, along) / square : 0;
    part = part < 0 ? 0 : part > 1 ? 1 : part;
    const vec2 off = to - along * part;
    const float away = glm::dot(off, off), limit = view.halfWidth * view.halfWidth;
    if (away > limit) continue;
    const bool isRim = 4 * away > limit;
    const float depth = 1 / (edge.inverseDepthFrom + (edge.inverseDepthTo - edge.inverseDepthFrom) * part);
    if (isRim == best.isRim ? depth < best.depth : best.isRim) best = {edge.box, depth, isRim};
  }
  return best;
}

}  // namespace copse
