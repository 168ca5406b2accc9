// Areas of the unions of every two clusters of a treelet, the closest pair, and what changes when two are joined: once
// for 32 lanes that take a pair each, once for one lane of the CPU that takes rows by eights. Of pairs that are equally
// close both choose the one whose higher place, then whose lower place, is lowest.
#pragma once

#include "builder/methods/treelets/treelet.h"
#include "builder/parallel/bits.h"

namespace copse::treelets {

constexpr uint32_t mostClusters = 20;
using Clusters = Treelet<24>;

struct ClusterPair {
  uint32_t high, low;  ///< low < high.
};

/// Row after row of the triangle below the diagonal.
struct PackedAreas {
  float area[mostClusters * (mostClusters - 1) / 2];  ///< Numbers, at most FLT_MAX.

  HD static uint32_t pairs(uint32_t count) { return count * (count - 1) / 2; }
  HD static ClusterPair pairOf(uint32_t k) {
    const auto high = static_cast<uint32_t>((1 + sqrtf(static_cast<float>(8 * k + 1))) / 2);
    return {high, k - pairs(high)};
  }
  HD float& of(uint32_t a, uint32_t b) { return area[a > b ? pairs(a) + b : pairs(b) + a]; }
  HD static float ofUnion(const Box& a, const Box& b) { return minOf(unite(a, b).area(), FLT_MAX); }

  template <class Lanes>
  HD void fill(Lanes& lanes, const Clusters& clusters, uint32_t count) {
    for (uint32_t k = lanes.lane(); k < pairs(count); k += Lanes::size) {
      const ClusterPair pair = pairOf(k);
      area[k] = ofUnion(clusters.box(pair.high), clusters.box(pair.low));
    }
    lanes.sync();
  }
  template <class Lanes>
  HD ClusterPair closest(Lanes& lanes, uint32_t count) const {
    return pairOf(lowest(lanes, pairs(count), [&](uint32_t k) { return area[k]; }).index);
  }
  /// The union `box` is at pair.low and what was at `last` at pair.high. Synchronises before it reads boxes, and after.
  template <class Lanes>
  HD void update(Lanes& lanes, const Clusters& clusters, const ClusterPair& pair, const Box& box, uint32_t last) {
    for (uint32_t k = lanes.lane(); k < last; k += Lanes::size)
      if (k != pair.high && k != pair.low) of(pair.high, k) = of(last, k);
    lanes.sync();
    for (uint32_t k = lanes.lane(); k < last; k += Lanes::size)
      if (k != pair.low) of(pair.low, k) = ofUnion(box, clusters.box(k));
    lanes.sync();
  }
};

/// Row i has the areas with the clusters below i, and infinity up to a whole number of eights.
struct RowAreas {
  static constexpr uint32_t stride = 24;
  float area[mostClusters][stride];

  HD static Float8 places(uint32_t first) {
    alignas(16) const float from0[8] = {0, 1, 2, 3, 4, 5, 6, 7};
    return load8(from0) + allOf(static_cast<float>(first));
  }
  /// `values` in the places below `row`, from `first` on.
  HD void storeBelow(uint32_t row, uint32_t first, Float8 values) {
    whereLessEqual(allOf(static_cast<float>(row)), places(first), allOf(INFINITY), values).store(area[row] + first);
  }
  HD static Float8 ofUnions(const Clusters& clusters, uint32_t first, const EightBoxes& with) {
    EightBoxes boxes = EightBoxes::load(clusters, first);
    boxes.grow(with);
    return minOf(boxes.area(), allOf(FLT_MAX));
  }

  template <class Lanes>
  HD void fill(Lanes&, const Clusters& clusters, uint32_t count) {
    for (uint32_t row = 1; row < count; ++row) {
      const EightBoxes box = EightBoxes::all(clusters.box(row));
      for (uint32_t first = 0; first < row; first += 8) storeBelow(row, first, ofUnions(clusters, first, box));
    }
  }
  template <class Lanes>
  HD ClusterPair closest(Lanes&, uint32_t count) const {
    Float8 eight = allOf(INFINITY);
    for (uint32_t row = 1; row < count; ++row)
      for (uint32_t first = 0; first < row; first += 8) eight = minOf(load8(area[row] + first), eight);
    const Float8 least = allOf(lowestOf(eight));
    for (uint32_t row = 1;; ++row)
      for (uint32_t first = 0; first < row; first += 8)
        if (const uint32_t found = equal(load8(area[row] + first), least)) return {row, first + lowestBit(found)};
  }
  template <class Lanes>
  HD void update(Lanes&, const Clusters& clusters, const ClusterPair& pair, const Box& box, uint32_t last) {
    const auto [high, low] = pair;
    for (uint32_t first = 0; first < high; first += 8) storeBelow(high, first, load8(area[last] + first));
    for (uint32_t k = high + 1; k < last; ++k) area[k][high] = area[last][k];
    const EightBoxes with = EightBoxes::all(box);
    alignas(16) float joined[stride];
    for (uint32_t first = 0; first < last; first += 8) ofUnions(clusters, first, with).store(joined + first);
    for (uint32_t first = 0; first < low; first += 8) storeBelow(low, first, load8(joined + first));
    for (uint32_t k = low + 1; k < last; ++k) area[k][low] = joined[k];
  }
};

}  // namespace copse::treelets
