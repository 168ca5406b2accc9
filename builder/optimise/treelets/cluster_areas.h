// Areas of the unions of every two clusters of a treelet, the closest pair, and what changes when two are joined: once
// for 32 lanes that take a pair each, once for one lane of the CPU that takes rows by eights. Of pairs that are equally
// close both choose the one whose higher place, then whose lower place, is lowest.
#pragma once

#include "builder/optimise/treelets/treelet.h"
#include "builder/parallel/bits.h"

namespace copse::treelets {

struct ClusterPair {
  uint32_t high, low;  ///< low < high.
};

HD inline float areaOfUnion(const Box& a, const Box& b) { return minOf(unite(a, b).area(), FLT_MAX); }

/// Row after row of the triangle below the diagonal.
template <uint32_t maxLeaves>
struct PackedAreas {
  using Clusters = Treelet<(maxLeaves + 7) / 8 * 8>;
  float area[maxLeaves * (maxLeaves - 1) / 2];  ///< Numbers, at most FLT_MAX.

  HD static uint32_t pairs(uint32_t count) { return count * (count - 1) / 2; }
  HD static ClusterPair pairOf(uint32_t k) {
    const auto high = static_cast<uint32_t>((1 + sqrtf(static_cast<float>(8 * k + 1))) / 2);
    return {high, k - pairs(high)};
  }
  HD float& of(uint32_t a, uint32_t b) { return area[a > b ? pairs(a) + b : pairs(b) + a]; }

  template <class Lanes>
  HD void fill(Lanes& lanes, const Clusters& clusters, uint32_t count) {
    for (uint32_t k = lanes.lane(); k < pairs(count); k += Lanes::size) {
      const ClusterPair pair = pairOf(k);
      area[k] = areaOfUnion(clusters.box(pair.high), clusters.box(pair.low));
    }
    lanes.sync();
  }
  template <class Lanes>
  HD ClusterPair closest(Lanes& lanes, uint32_t count) const {
    return pairOf(lowest(lanes, pairs(count), [&](uint32_t k) { return area[k]; }).index);
  }
  /// `box`, the union of a pair of `count` clusters, goes to pair.low and the last cluster to pair.high. Called before
  /// the clusters change; synchronises before it returns.
  template <class Lanes>
  HD void join(Lanes& lanes, const Clusters& clusters, const ClusterPair& pair, const Box& box, uint32_t count) {
    const uint32_t last = count - 1;
    float joined = 0;
    const uint32_t k = lanes.lane();  // There are fewer clusters than lanes.
    static_assert(maxLeaves <= Lanes::size);
    if (k < last) joined = areaOfUnion(box, clusters.box(k == pair.high ? last : k));
    lanes.sync();
    if (k < last && k != pair.low) {
      if (k != pair.high) of(pair.high, k) = of(last, k);
      of(pair.low, k) = joined;
    }
    lanes.sync();
  }
};

inline namespace COPSE_ISA {

/// Row i has the areas with the clusters below i, and infinity up to a whole number of eights.
template <uint32_t maxLeaves>
struct RowAreas {
  using Clusters = Treelet<(maxLeaves + 7) / 8 * 8>;
  static constexpr uint32_t width = (maxLeaves + 6) / 8 * 8;
  float area[maxLeaves][width];

  HD void storeBelow(uint32_t row, uint32_t first, const F32x8& values) {
    const F32x8 place = eightFrom(first);
    select(F32x8(static_cast<float>(row)) <= place, F32x8(INFINITY), values).store(area[row] + first);
  }
  HD static F32x8 ofUnions(const Clusters& clusters, uint32_t first, const EightBoxes& with) {
    EightBoxes boxes = EightBoxes::load(clusters, first);
    boxes.grow(with);
    return minOf(boxes.area(), F32x8(FLT_MAX));
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
    F32x8 eight(INFINITY);
    for (uint32_t row = 1; row < count; ++row)
      for (uint32_t first = 0; first < row; first += 8) eight = minOf(F32x8::load(area[row] + first), eight);
    const F32x8 smallest(minLane(eight));
    for (uint32_t row = 1;; ++row)
      for (uint32_t first = 0; first < row; first += 8)
        if (const uint32_t found = (F32x8::load(area[row] + first) == smallest).bits())
          return {row, first + lowestBit(found)};
  }
  template <class Lanes>
  HD void join(Lanes&, const Clusters& clusters, const ClusterPair& pair, const Box& box, uint32_t count) {
    const auto [high, low] = pair;
    const uint32_t last = count - 1;
    const EightBoxes with = EightBoxes::all(box);
    float joined[width];
    for (uint32_t first = 0; first < last; first += 8) ofUnions(clusters, first, with).store(joined + first);
    if (high < last) {
      joined[high] = areaOfUnion(box, clusters.box(last));
      for (uint32_t first = 0; first < high; first += 8) storeBelow(high, first, F32x8::load(area[last] + first));
      for (uint32_t k = high + 1; k < last; ++k) area[k][high] = area[last][k];
    }
    for (uint32_t first = 0; first < low; first += 8) storeBelow(low, first, F32x8::load(joined + first));
    for (uint32_t k = low + 1; k < last; ++k) area[k][low] = joined[k];
  }
};

}  // namespace COPSE_ISA

}  // namespace copse::treelets
