// Boxes of triangles and the box around all of them. Minimum and maximum do not depend on the order, so the reduction
// gives the same bits whatever the number of threads. O(n).
#include "builder/primitives/primitives.h"

#include "builder/parallel/launch.h"
#include "builder/parallel/one_lane.h"
#include "builder/parallel/reduce.h"
#include "builder/phases.h"

namespace copse {

namespace {

/// Triangles that a team takes: on CUDA the lanes of a warp side by side, so that what they read and write is too.
constexpr uint32_t perTeam = 128;

struct BoxTriangles {
  TrianglesView triangles;
  Box* boxes;
  Box* partial;

  static constexpr uint32_t prefetchDistance = 64;  ///< In triangles.

  template <class Lanes>
  HD void operator()(Lanes& lanes, uint32_t team) const {
    const uint32_t begin = team * perTeam;
    const uint32_t end = triangles.count - begin < perTeam ? triangles.count : begin + perTeam;
    Box all;
    for (uint32_t t = begin + lanes.lane(); t < end; t += Lanes::size) {
      prefetch(triangles.indices + t + prefetchDistance);
      prefetchForStore(boxes + t + prefetchDistance);
      const uvec3 index = triangles.indices[t];
      Box box;  // Around the corners that are numbers.
      box.grow(triangles.positions[index.x]);
      box.grow(triangles.positions[index.y]);
      box.grow(triangles.positions[index.z]);
      boxes[t] = box;
      all.grow(box);
    }
    all = lanes.reduce(all, UniteBoxes{});
    if (lanes.lane() == 0) partial[team] = all;
  }
};

struct LoadBox {
  const Box* boxes;
  HD Box operator()(uint32_t i) const { return boxes[i]; }
};

struct ReferToTriangles {
  const uint32_t* triangleOf;
  uint32_t* order;
  HD void operator()(uint32_t i) const { order[i] = triangleOf[order[i]]; }
};

}  // namespace

OwnedPrimitives primitivesOf(const Device& device, const TrianglesView& triangles) {
  if (triangles.count == 0) return {};
  Phase phase(device, phases::boxes);
  OwnedPrimitives primitives(device, triangles.count, triangles);
  const uint32_t teams = (triangles.count - 1) / perTeam + 1;
  Buffer<Box> partial(device, teams);
  launchTeams(device, "box triangles", teams, BoxTriangles{triangles, primitives.boxes(), partial.data()}, 0,
              evenGrain(device, teams, 16));
  reduceInto(device, "unite boxes", teams, Box{}, LoadBox{partial.data()}, UniteBoxes{}, primitives.bounds());
  return primitives;
}

void referToTriangles(const Device& device, const uint32_t* triangleOf, OpenTree& tree) {
  launch(device, "refer to triangles", tree.referenceCount, ReferToTriangles{triangleOf, tree.order.data()});
}

}  // namespace copse
