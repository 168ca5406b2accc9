// Morton codes of the boxes' centres over the scene box, and the radix sort by them. O(n).
#include "builder/primitives/morton_order.h"

#include "builder/math/morton.h"
#include "builder/parallel/launch.h"
#include "builder/parallel/primitives.h"
#include "builder/phases.h"

namespace copse {

namespace {

struct EncodeCentres {
  const Box *boxes, *bounds;
  int bits;
  bool cube;
  uint64_t* keys;
  uint32_t* order;
  MortonGrid grid{};

  static constexpr uint32_t prefetchDistance = 64;  ///< In boxes.

  HD void prepare() { grid = MortonGrid::over(*bounds, bits, cube); }
  HD void operator()(uint32_t i) const {
    prefetch(boxes + i + prefetchDistance);
    prefetchForStore(keys + i + prefetchDistance);
    prefetchForStore(order + i + prefetchDistance);
    const Box box = boxes[i];  // A copy, for two loads of 16 bytes.
    keys[i] = grid.code(box.centre2());
    order[i] = i;
  }
};

}  // namespace

MortonOrder mortonOrder(const Device& device, const Primitives& input, int bits, bool cube) {
  const uint32_t n = input.count;
  MortonOrder sorted{Buffer<uint64_t>(device, n), Buffer<uint32_t>(device, n), bits};
  {
    Phase phase(device, phases::morton);
    launch(device, "encode centres", n,
           EncodeCentres{input.boxes, input.bounds, bits, cube, sorted.keys.data(), sorted.order.data()});
  }
  Phase phase(device, phases::sort);
  Buffer<uint64_t> keyScratch(device, n);
  Buffer<uint32_t> orderScratch(device, n);
  radixSort(device, "sort codes", n, 3 * bits, sorted.keys, sorted.order, keyScratch, orderScratch);
  return sorted;
}

MortonOrder mortonOrder(const Device& device, const Primitives& input, const Parameters& parameters) {
  return mortonOrder(device, input, static_cast<int>(parameters.integer("morton.bits")),
                     parameters.text("morton.scale") == "cube");
}

std::vector<ParameterSpec> mortonParameters() {
  return {{.name = "morton.bits",
           .standard = 20,
           .min = 1,
           .max = 21,
           .meaning = "Morton code bits per axis; 20 give the paper's 60-bit codes"},
          {.name = "morton.scale",
           .standard = "axis",
           .words = {"axis", "cube"},
           .meaning = "shape of Morton cells: the scene box divided evenly on each axis, or cubes"}};
}

OpenTree treeOver(const Device& device, MortonOrder& sorted) {
  OpenTree bvh;
  bvh.referenceCount = static_cast<uint32_t>(sorted.order.size());
  bvh.nodeCount = 2 * bvh.referenceCount - 1;
  bvh.firstLeaf = bvh.referenceCount - 1;
  bvh.nodes = Buffer<BvhNode>(device, bvh.nodeCount);
  bvh.parents = Buffer<uint32_t>(device, bvh.nodeCount);
  bvh.order = std::move(sorted.order);
  return bvh;
}

}  // namespace copse
