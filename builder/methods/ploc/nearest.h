// A list of clusters in Morton order, and for each the nearest one at most `radius` places away: the one whose union
// with it has the minimum surface area. Meister and Bittner: Parallel Locally-Ordered Clustering for Bounding Volume
// Hierarchy Construction (TVCG 2018).
// Pairs have a total order: by area, then by distance in the list, then those that begin at an even place first, then
// by place. So the first of all pairs is always mutual, and a run of equal boxes joins 2k with 2k+1 rather than one
// pair per round. O(count × radius). Only .cu files include this.
#pragma once

#include "builder/bvh.h"
#include "builder/math/simd.h"
#include "builder/parallel/bits.h"

namespace copse::ploc::inline COPSE_ISA {

/// The arrays that the CPU's search of one distance reads and writes: `end` places, a multiple of eight, and for the
/// boxes `distance` more. Behind the clusters there are boxes that are infinitely large with any other.
struct SearchedDistance {
  const float *lo[3], *hi[3];
  float* row;  ///< Areas of places with those `distance` to their right; before it as many are infinite.
  float* best;
  uint32_t* nearest;
  uint32_t end, distance;
};

/// Eight places at a time, each pair's area once.
HD inline void improveByEights(const SearchedDistance& s) {
  for (uint32_t i = 0; i < s.end; i += 8) {
    F32x8 side[3];
    for (int axis = 0; axis < 3; ++axis)
      side[axis] = maxOf(F32x8::load(s.hi[axis] + i), F32x8::load(s.hi[axis] + i + s.distance)) -
                   minOf(F32x8::load(s.lo[axis] + i), F32x8::load(s.lo[axis] + i + s.distance));
    (side[0] * side[1] + side[1] * side[2] + side[2] * side[0]).store(s.row + i);
  }
  const uint32_t counted[8] = {0, 1, 2, 3, 4, 5, 6, 7};
  const float odd[8] = {0, 1, 0, 1, 0, 1, 0, 1};
  const U32x8 lane = U32x8::load(counted), distance(s.distance);
  const F32x8::Mask rightFirst = F32x8::load(odd) < F32x8(s.distance % 2 ? 0.5f : -1);
  for (uint32_t i = 0; i < s.end; i += 8) {
    const F32x8 right = F32x8::load(s.row + i), left = F32x8::load(s.row + i - s.distance);
    const U32x8 place = U32x8(i) + lane, rightAt = place + distance, leftAt = place - distance;
    F32x8 best = F32x8::load(s.best + i);
    U32x8 at = U32x8::load(s.nearest + i);
    const auto look = [&](const F32x8& area, const U32x8& other) {
      const F32x8::Mask nearer = area < best;
      best = select(nearer, area, best);
      at = select(nearer, other, at);
    };
    look(select(rightFirst, right, left), select(rightFirst, rightAt, leftAt));
    look(select(rightFirst, left, right), select(rightFirst, leftAt, rightAt));
    best.store(s.best + i);
    at.store(s.nearest + i);
  }
}

/// The root of a subtree, with a number that no node below it has.
struct Cluster {
  static constexpr uint32_t nobody = ~0u;
  uint32_t node, spare;
};

/// Inner nodes that joins write. Each leaf brings a number, its own; a join of two clusters uses up the larger of their
/// spare ones as node spare - 1 and keeps the smaller, so that every inner node of a tree over n leaves is one of
/// 0 … n-2, whatever the order of joins, and no counter is needed.
struct Joins {
  BvhNode* nodes;
  uint32_t* parents;

  HD Cluster join(const Box& box, const Cluster& left, const Cluster& right) const {
    const bool leftIsLess = left.spare < right.spare;
    const uint32_t at = (leftIsLess ? right.spare : left.spare) - 1;
    nodes[at] = BvhNode::inner(box, left.node, right.node);
    parents[left.node] = at;
    parents[right.node] = at;
    return {at, leftIsLess ? left.spare : right.spare};
  }
};

/// Room for `capacity` clusters in memory that a warp shares, searched up to `reach` places away.
template <uint32_t capacity, uint32_t reach>
struct Clusters {
  static constexpr uint32_t places = (capacity + 7) / 8 * 8 + (reach + 7) / 8 * 8;
  static constexpr uint32_t nobody = ~0u;

  float lo[3][places], hi[3][places];
  Cluster cluster[capacity];
  uint32_t nearest[places];  ///< A place; see findNearest().

  HD void put(uint32_t place, const Box& box, const Cluster& subtree) {
    put(place, box);
    cluster[place] = subtree;
  }
  HD void put(uint32_t place, const Box& box) {
    for (int axis = 0; axis < 3; ++axis) {
      lo[axis][place] = box.lo[axis];
      hi[axis][place] = box.hi[axis];
    }
  }
  HD Box box(uint32_t place) const {
    Box b;
    b.lo = {lo[0][place], lo[1][place], lo[2][place]};
    b.hi = {hi[0][place], hi[1][place], hi[2][place]};
    return b;
  }

  /// For each of the first `count` places, by all lanes. One that has no finite area with any other is held to be
  /// nearest to the other of the places 2k and 2k+1, or nobody if there is no such place; so some two are always each
  /// other's nearest, whatever the boxes.
  template <class Lanes>
  HD void findNearest(Lanes& lanes, uint32_t count, uint32_t radius) {
    if constexpr (Lanes::size == 1)
      findByEights(count, radius);
    else
      for (uint32_t place = lanes.lane(); place < count; place += Lanes::size)
        nearest[place] = nearestOf(place, count, radius);
    lanes.sync();
  }

  /// Joins those of begin … end-1 that are each other's nearest, into the first of the two, by all lanes. What stays is
  /// handed to put(k, box, cluster) in order, k from 0 on; after all of a lane's reads, so that it may go to place k of
  /// this list where begin is 0. Returns how many stay.
  template <class Lanes, class Put>
  HD uint32_t joinNearest(Lanes& lanes, uint32_t begin, uint32_t end, const Joins& joins, Put putStaying) {
    uint32_t staying = 0;
    for (uint32_t base = begin; base < end; base += Lanes::size) {
      const uint32_t i = base + lanes.lane();
      const uint32_t other = i < end ? nearest[i] : nobody;
      const bool mutual = other != nobody && nearest[other] == i;
      const bool stays = i < end && !(mutual && other < i);
      Cluster own{};
      Box around;
      if (stays) {
        own = cluster[i];
        around = box(i);
      }
      if (stays && mutual) {
        const Cluster joined = cluster[other];
        around = unite(around, box(other));
        own = joins.join(around, own, joined);
      }
      const uint32_t mask = lanes.ballot(stays);
      lanes.sync();
      if (stays) putStaying(staying + popCount(mask & ((1u << lanes.lane()) - 1)), around, own);
      staying += popCount(mask);
    }
    lanes.sync();
    return staying;
  }

  /// One round over the first `count`, which close up; their new number.
  template <class Lanes>
  HD uint32_t round(Lanes& lanes, uint32_t count, uint32_t radius, const Joins& joins) {
    findNearest(lanes, count, radius);
    return joinNearest(lanes, 0, count, joins,
                       [&](uint32_t to, const Box& b, const Cluster& subtree) { put(to, b, subtree); });
  }

 private:
  /// Half the surface area of a union. The order of operations is that of improveByEights().
  HD float joinedArea(uint32_t a, uint32_t b) const {
    float side[3];
    for (int axis = 0; axis < 3; ++axis) side[axis] = maxOf(hi[axis][a], hi[axis][b]) - minOf(lo[axis][a], lo[axis][b]);
    return side[0] * side[1] + side[1] * side[2] + side[2] * side[0];
  }

  /// As a lane of a GPU does it, for one place.
  HD uint32_t nearestOf(uint32_t place, uint32_t count, uint32_t radius) const {
    float best = INFINITY;
    uint32_t at = (place ^ 1) < count ? place ^ 1 : nobody;
    const auto look = [&](bool right, uint32_t distance) {
      if (right ? place + distance >= count : place < distance) return;
      const uint32_t other = right ? place + distance : place - distance;
      const float area = joinedArea(place, other);
      if (!(area < best)) return;
      best = area;
      at = other;
    };
    for (uint32_t distance = 1; distance <= radius; ++distance) {
      // At equal distances, the pair that begins at an even place, or the one to the left.
      const bool right = distance % 2 && place % 2 == 0;
      look(right, distance);
      look(!right, distance);
    }
    return at;
  }

  /// As the CPU does it, for all places.
  HD void findByEights(uint32_t count, uint32_t radius) {
    const uint32_t padding = (count + 7) / 8 * 8 + (radius + 7) / 8 * 8;
    for (uint32_t i = count; i < padding; ++i) put(i, everything());
    float row[reach + places], best[places];
    for (uint32_t i = 0; i < reach; ++i) row[i] = INFINITY;
    for (uint32_t i = 0; i < count; i += 8) F32x8(INFINITY).store(best + i);
    for (uint32_t i = 0; i < count; ++i) nearest[i] = (i ^ 1) < count ? i ^ 1 : nobody;
    for (uint32_t distance = 1; distance <= radius; ++distance)
      improveByEights(
          {{lo[0], lo[1], lo[2]}, {hi[0], hi[1], hi[2]}, row + reach, best, nearest, (count + 7) / 8 * 8, distance});
  }

  /// Infinitely large with any other box.
  HD static Box everything() {
    Box b;
    b.lo = vec3(-FLT_MAX);
    b.hi = vec3(FLT_MAX);
    return b;
  }
};

}  // namespace copse::ploc::inline COPSE_ISA
