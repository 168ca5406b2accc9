// Boxes of triangles and the box around all of them. Minimum and maximum do not depend on the order, so the reduction
// gives the same bits whatever the number of threads. O(n).
#include "builder/build.h"
#include "builder/parallel/reduce.h"

namespace copse {

namespace {

/// Triangles that one index of a launch takes.
constexpr uint32_t perIndex = 16;

struct BoxTriangles {
  TrianglesView triangles;
  Box* boxes;
  Box* partial;

  static constexpr uint32_t ahead = 64;  ///< Triangles between a request for memory and its use.

  HD void operator()(uint32_t i) const {
    const uint32_t begin = i * perIndex;
    const uint32_t end = triangles.count - begin < perIndex ? triangles.count : begin + perIndex;
    Box all;
    for (uint32_t t = begin; t < end; ++t) {
      prefetch(triangles.indices + t + ahead);
      prefetchForStore(boxes + t + ahead);
      const uvec3 index = triangles.indices[t];
      Box box;  // Of the corners that are numbers.
      box.grow(triangles.positions[index.x]);
      box.grow(triangles.positions[index.y]);
      box.grow(triangles.positions[index.z]);
      boxes[t] = box;
      all.grow(box);
    }
    partial[i] = all;
  }
};

struct LoadBox {
  const Box* boxes;
  HD Box operator()(uint32_t i) const { return boxes[i]; }
};

struct UniteBoxes {
  HD Box operator()(const Box& a, const Box& b) const { return unite(a, b); }
};

}  // namespace

Buffer<Box> triangleBoxes(const Device& device, const TrianglesView& triangles) {
  if (triangles.count == 0) return {};
  Phase phase(device, "boxes");
  Buffer<Box> boxes(device, std::size_t{triangles.count} + 1);
  const uint32_t count = (triangles.count - 1) / perIndex + 1;
  Buffer<Box> partial(device, count);
  launch(device, "box triangles", count, BoxTriangles{triangles, boxes.data(), partial.data()}, 64);
  reduceInto(device, "unite boxes", count, Box{}, LoadBox{partial.data()}, UniteBoxes{},
             boxes.data() + triangles.count);
  return boxes;
}

BuildInput inputOf(const Buffer<Box>& boxes) {
  if (boxes.empty()) return {};
  const std::size_t count = boxes.size() - 1;
  return {boxes.data(), static_cast<uint32_t>(count), boxes.data() + count};
}

}  // namespace copse
