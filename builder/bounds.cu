// Boxes of triangles and the box around all of them. Minimum and maximum do not depend on the order, so the reduction
// gives the same bits whatever the number of threads. O(n).
#include "builder/build.h"
#include "builder/parallel/launch.h"

namespace copse {

namespace {

/// Items that one index of a launch takes: enough that the reduction's tail is short.
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

struct UniteBoxes {
  const Box* in;
  Box* out;
  uint32_t count;

  HD void operator()(uint32_t i) const {
    const uint32_t begin = i * perIndex;
    const uint32_t end = count - begin < perIndex ? count : begin + perIndex;
    Box all;
    for (uint32_t k = begin; k < end; ++k) all.grow(in[k]);
    out[i] = all;
  }
};

uint32_t indicesFor(uint32_t count) { return (count - 1) / perIndex + 1; }

}  // namespace

Buffer<Box> triangleBoxes(const Device& device, const TrianglesView& triangles, Box& bounds) {
  bounds = Box{};
  Buffer<Box> boxes(device, triangles.count);
  if (triangles.count == 0) return boxes;
  Phase phase(device, "boxes");
  uint32_t count = indicesFor(triangles.count);
  Buffer<Box> partial(device, count), united(device, indicesFor(count));
  launch(device, "box triangles", count, BoxTriangles{triangles, boxes.data(), partial.data()}, 64);
  while (count > 1) {
    const uint32_t fewer = indicesFor(count);
    launch(device, "unite boxes", fewer, UniteBoxes{partial.data(), united.data(), count}, 64);
    partial.swap(united);
    count = fewer;
  }
  bounds = partial.read(0);
  return boxes;
}

}  // namespace copse
