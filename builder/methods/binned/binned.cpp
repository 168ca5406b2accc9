// Binned surface area splits from the top: at every node the centres of its boxes are counted into bins along all three
// axes, and of the splits between bins the one of minimum surface area cost is taken.
// Wald: On fast Construction of SAH-based Bounding Volume Hierarchies (RT 2007). O(n log n); runs on the CPU's threads.
#include <omp.h>

#include <algorithm>
#include <array>
#include <vector>

#include "builder/method.h"
#include "builder/methods/on_host.h"
#include "builder/methods/sah/sah_sweep.h"
#include "builder/parallel/timeline.h"
#include "builder/phases.h"

namespace copse {

namespace {

constexpr PhaseGroup binningGroup{"binning"};
constexpr PhaseName binningPhase{"binning", &binningGroup};

using sweep::SignedBox;

constexpr uint32_t maxBins = 32;
/// Below this depth nodes are halved, which bounds the depth of any tree by this and log2 n.
constexpr uint32_t deepest = 64;
/// Fewer boxes than this are one task.
constexpr uint32_t taskSize = 4096;
/// From here on the chunks of one node, of this many boxes each, are binned and moved at the same time.
constexpr uint32_t wideSize = 32768, chunkSize = 8192;

/// The box around a point, twice a box's centre.
SignedBox centreOf(const SignedBox& box) {
  const F32x4 centre = box.lanes.lower() - box.lanes.upper();
  SignedBox at;
  at.lanes = F32x8(centre, -centre);
  return at;
}

/// Along each axis, which bin a centre is in.
struct Grid {
  float least[3], scale[3];
  uint32_t bins;

  /// None along axes on which all centres are one, or too near for floats.
  Grid(const SignedBox& centres, uint32_t count) : bins(count) {
    for (int axis = 0; axis < 3; ++axis) {
      least[axis] = centres.lanes[axis];
      const float extent = -centres.lanes[4 + axis] - centres.lanes[axis];
      scale[axis] = static_cast<float>(bins) * 0.9999f / extent;
      if (!(extent > 0 && scale[axis] > 0 && scale[axis] < FLT_MAX)) scale[axis] = 0;
    }
  }
  bool any() const { return scale[0] > 0 || scale[1] > 0 || scale[2] > 0; }
  uint32_t binOf(const SignedBox& box, int axis) const {
    const float at = (box.centre2(axis) - least[axis]) * scale[axis];
    return at > 0 ? std::min(static_cast<uint32_t>(std::min(at, 64.0f)), bins - 1) : 0;
  }
};

struct Bins {
  SignedBox boxes[3][maxBins];
  uint32_t counts[3][maxBins];

  explicit Bins(uint32_t bins) {
    for (auto& axis : boxes) std::fill_n(axis, bins, SignedBox());
    for (auto& axis : counts) std::fill_n(axis, bins, 0u);
  }
  void add(const Grid& grid, const SignedBox& box) {
    for (int axis = 0; axis < 3; ++axis) {
      const uint32_t bin = grid.binOf(box, axis);
      boxes[axis][bin].grow(box);
      ++counts[axis][bin];
    }
  }
  void add(const Bins& other, uint32_t bins) {
    for (int axis = 0; axis < 3; ++axis)
      for (uint32_t bin = 0; bin < bins; ++bin) {
        boxes[axis][bin].grow(other.boxes[axis][bin]);
        counts[axis][bin] += other.counts[axis][bin];
      }
  }
};

/// Between bins: those below `bin` along `axis` go left.
struct BinSplit {
  float cost = std::numeric_limits<float>::infinity();
  int axis = 3;
  uint32_t bin = 0, left = 0;

  bool found() const { return axis < 3; }
};

/// The split of minimum cost; among equal ones the one of the lower axis and bin.
BinSplit bestOf(const Bins& bins, const Grid& grid) {
  BinSplit best;
  for (int axis = 0; axis < 3; ++axis) {
    if (!(grid.scale[axis] > 0)) continue;
    float rightCost[maxBins];
    SignedBox side;
    uint32_t count = 0;
    for (uint32_t bin = grid.bins - 1; bin > 0; --bin) {
      side.grow(bins.boxes[axis][bin]);
      count += bins.counts[axis][bin];
      rightCost[bin] = count ? side.halfArea() * static_cast<float>(count) : -1;
    }
    side = SignedBox();
    count = 0;
    for (uint32_t bin = 1; bin < grid.bins; ++bin) {
      side.grow(bins.boxes[axis][bin - 1]);
      count += bins.counts[axis][bin - 1];
      if (count == 0 || rightCost[bin] < 0) continue;
      const float cost = side.halfArea() * static_cast<float>(count) + rightCost[bin];
      if (cost < best.cost) best = {cost, axis, bin, count};
    }
  }
  return best;
}

/// A node's boxes: a range, and the box around their centres.
struct Range {
  uint32_t begin, end;
  SignedBox centres;

  uint32_t size() const { return end - begin; }
};

struct Binning {
  uint32_t count, bins;
  int threads;
  std::vector<SignedBox> boxes, movedBoxes;  ///< Moved from node to node with their indices, so they are read in order.
  Buffer<uint32_t> order, movedOrder;
  BvhNode* nodes;

  Binning(const Device& host, const Box* from, uint32_t n, uint32_t binCount, BvhNode* to)
      : count(n),
        bins(binCount),
        threads(host.threads),
        boxes(n),
        movedBoxes(n),
        order(host, n),
        movedOrder(host, n),
        nodes(to) {
#pragma omp parallel for num_threads(threads) if (n > taskSize)
    for (uint32_t i = 0; i < n; ++i) {
      boxes[i] = SignedBox(from[i]);
      order.data()[i] = i;
    }
  }

  bool isWide(const Range& range) const { return threads > 1 && range.size() >= wideSize; }

  /// Calls work(chunk, begin, end) for the chunks of a wide range, or once for all of another.
  template <class Work>
  void inChunks(const Range& range, const Work& work) {
    if (!isWide(range)) return work(0u, range.begin, range.end);
    const uint32_t chunks = chunksOf(range);
#pragma omp taskgroup
    for (uint32_t chunk = 0; chunk < chunks; ++chunk) {
#pragma omp task default(shared) firstprivate(chunk)
      {
        const uint32_t begin = range.begin + chunk * chunkSize;
        work(chunk, begin, std::min(range.end, begin + chunkSize));
      }
    }
  }
  uint32_t chunksOf(const Range& range) const { return isWide(range) ? (range.size() - 1) / chunkSize + 1 : 1; }

  /// Minima and sums of integers: the same however a range is cut.
  Bins binned(const Range& range, const Grid& grid) {
    if (!isWide(range)) {
      Bins bins(grid.bins);
      for (uint32_t i = range.begin; i < range.end; ++i) bins.add(grid, boxes[i]);
      return bins;
    }
    std::vector<Bins> parts(chunksOf(range), Bins(grid.bins));
    inChunks(range, [&](uint32_t chunk, uint32_t begin, uint32_t end) {
      Bins& part = parts[chunk];
      for (uint32_t i = begin; i < end; ++i) part.add(grid, boxes[i]);
    });
    for (std::size_t chunk = 1; chunk < parts.size(); ++chunk) parts[0].add(parts[chunk], grid.bins);
    return parts[0];
  }

  Range all() {
    Range range{0, count, {}};
    std::vector<SignedBox> parts(chunksOf(range));
    inChunks(range, [&](uint32_t chunk, uint32_t begin, uint32_t end) {
      for (uint32_t i = begin; i < end; ++i) parts[chunk].grow(centreOf(boxes[i]));
    });
    for (const SignedBox& part : parts) range.centres.grow(part);
    return range;
  }

  /// Moves begin … end-1 of a range to places `at` of the two sides, in order; the box around each side's centres.
  std::array<SignedBox, 2> move(uint32_t begin, uint32_t end, const Grid& grid, const BinSplit& split,
                                std::array<uint32_t, 2> at) {
    std::array<SignedBox, 2> centres;
    for (uint32_t i = begin; i < end; ++i) {
      const int side = grid.binOf(boxes[i], split.axis) < split.bin ? 0 : 1;
      movedBoxes[at[side]] = boxes[i];
      movedOrder.data()[at[side]] = order.data()[i];
      ++at[side];
      centres[side].grow(centreOf(boxes[i]));
    }
    return centres;
  }
  void moveBack(uint32_t begin, uint32_t end) {
    std::copy(movedBoxes.begin() + begin, movedBoxes.begin() + end, boxes.begin() + begin);
    std::copy(movedOrder.data() + begin, movedOrder.data() + end, order.data() + begin);
  }

  /// Both sides keep their order, so that it does not depend on how a range is cut either.
  std::array<Range, 2> partition(const Range& range, const Grid& grid, const BinSplit& split) {
    const uint32_t middle = range.begin + split.left;
    std::array<Range, 2> sides{Range{range.begin, middle, {}}, Range{middle, range.end, {}}};
    if (!isWide(range)) {
      const auto centres = move(range.begin, range.end, grid, split, {range.begin, middle});
      for (int side = 0; side < 2; ++side) sides[side].centres = centres[side];
      moveBack(range.begin, range.end);
      return sides;
    }
    const uint32_t chunks = chunksOf(range);
    std::vector<uint32_t> leftOf(chunks), leftAt(chunks, range.begin);
    inChunks(range, [&](uint32_t chunk, uint32_t begin, uint32_t end) {
      uint32_t left = 0;
      for (uint32_t i = begin; i < end; ++i) left += grid.binOf(boxes[i], split.axis) < split.bin;
      leftOf[chunk] = left;
    });
    for (uint32_t chunk = 1; chunk < chunks; ++chunk) leftAt[chunk] = leftAt[chunk - 1] + leftOf[chunk - 1];
    std::vector<std::array<SignedBox, 2>> centres(chunks);
    inChunks(range, [&](uint32_t chunk, uint32_t begin, uint32_t end) {
      centres[chunk] = move(begin, end, grid, split, {leftAt[chunk], middle + (begin - leftAt[chunk])});
    });
    inChunks(range, [&](uint32_t, uint32_t begin, uint32_t end) { moveBack(begin, end); });
    for (const auto& part : centres)
      for (int side = 0; side < 2; ++side) sides[side].centres.grow(part[side]);
    return sides;
  }

  std::array<Range, 2> halves(const Range& range) {
    const uint32_t middle = range.begin + range.size() / 2;
    std::array<Range, 2> sides{Range{range.begin, middle, {}}, Range{middle, range.end, {}}};
    for (Range& side : sides)
      for (uint32_t i = side.begin; i < side.end; ++i) side.centres.grow(centreOf(boxes[i]));
    return sides;
  }

  std::array<Range, 2> split(const Range& range, uint32_t depth) {
    if (range.size() > 2 && depth < deepest) {
      const Grid grid(range.centres, std::min(bins, std::max(4u, range.size())));
      if (grid.any())
        if (const BinSplit best = bestOf(binned(range, grid), grid); best.found()) return partition(range, grid, best);
    }
    return halves(range);
  }

  /// The tree of a range in nodes at, at+1, … in depth-first order.
  void build(uint32_t at, const Range& range, uint32_t depth) {
    if (range.size() == 1) {
      nodes[at] = BvhNode::leaf(boxes[range.begin].box(), range.begin, 1);
      return;
    }
    const std::array<Range, 2> sides = split(range, depth);
    const uint32_t left = at + 1, right = at + 2 * sides[0].size();
    if (range.size() > taskSize && threads > 1) {
#pragma omp taskgroup
      {
#pragma omp task default(shared)
        build(left, sides[0], depth + 1);
        build(right, sides[1], depth + 1);
      }
    } else {
      build(left, sides[0], depth + 1);
      build(right, sides[1], depth + 1);
    }
    nodes[at] = BvhNode::inner(unite(nodes[left].box(), nodes[right].box()), left, right);
  }
};

OpenTree buildBinned(const Device& device, const Primitives& input, const Parameters& parameters) {
  const uint32_t n = input.count;
  OpenTree bvh;
  if (n == 0) return bvh;
  const HostInput from(device, input);
  Buffer<BvhNode> nodes(from.host, 2 * n - 1);
  Buffer<uint32_t> order;
  {
    Phase phase(device, binningPhase);
    Binning binning(from.host, from.input.boxes, n, static_cast<uint32_t>(parameters.integer("binned.bins")),
                    nodes.data());
#pragma omp parallel num_threads(binning.threads) if (n > taskSize)
#pragma omp single
    binning.build(0, binning.all(), 0);
    order = std::move(binning.order);
  }
  bvh.referenceCount = n;
  bvh.nodeCount = 2 * n - 1;
  bvh.nodes = onDevice(device, std::move(nodes));
  bvh.order = onDevice(device, std::move(order));
  return bvh;
}

}  // namespace

namespace methods {

Method binned() {
  return {.name = "binned",
          .source = "Wald 2007",
          .meaning = "splits between bins of lowest surface area cost at each node",
          .page = "docs/builders/binned.md",
          .build = buildBinned,
          .onCpuOnly = true,
          .parameters = {{.name = "binned.bins",
                          .standard = 16,
                          .min = 4,
                          .max = maxBins,
                          .meaning = "bins along each axis; nodes of fewer triangles have as many as these"}},
          .phases = {binningPhase}};
}

}  // namespace methods

}  // namespace copse
