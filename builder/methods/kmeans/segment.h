// The steps of k-means on one segment of triangles, or a part of it, by one team: drawing representatives, assigning,
// summing. The passes over large segments and the refinement of small ones are made of these. A team's lanes take a
// group of triangles at a time, one each; where the team is a single CPU thread, the group lies in vector registers.
#pragma once

#include "builder/methods/kmeans/clusters.h"
#include "builder/parallel/atomics.h"
#include "builder/parallel/one_lane.h"

namespace copse::kmeans {

/// What a team keeps in shared memory for one segment or a part of it, of up to `capacity` clusters.
template <uint32_t capacity>
struct WorkspaceFor {
  Sums sums[capacity];
  UnitBox reps[capacity];
  uint32_t cursors[capacity];
  uint32_t candidate[maxDraws];
  float candidateDistance[maxDraws];
};
using Workspace = WorkspaceFor<maxK>;

inline namespace COPSE_ISA {

/// The first three floats of sixteen rows of four: row i is at from + at[i], an address divisible by 16.
HD inline void loadColumns(const float* from, const std::size_t* at, F32x16* columns) {
  F32x16 rows[4];  // The fourth L of rows[i] is row 4 L + i.
  for (int i = 0; i < 4; ++i)
    rows[i] = {F32x8(F32x4::loadAligned(from + at[i]), F32x4::loadAligned(from + at[4 + i])),
               F32x8(F32x4::loadAligned(from + at[8 + i]), F32x4::loadAligned(from + at[12 + i]))};
  const F32x16 xy01 = rows[0].shuffle<0, 4, 1, 5>(rows[1]), xy23 = rows[2].shuffle<0, 4, 1, 5>(rows[3]);
  const F32x16 z01 = rows[0].shuffle<2, 6, 3, 7>(rows[1]), z23 = rows[2].shuffle<2, 6, 3, 7>(rows[3]);
  columns[0] = xy01.shuffle<0, 1, 4, 5>(xy23);
  columns[1] = xy01.shuffle<2, 3, 6, 7>(xy23);
  columns[2] = z01.shuffle<0, 1, 4, 5>(z23);
}

}  // namespace COPSE_ISA

/// How a team holds a group of triangles.
template <class Lanes>
struct Group {
  static constexpr bool isOneThread = Lanes::size == 1;
  static constexpr uint32_t size = isOneThread ? 16 : Lanes::size;
  using Float = std::conditional_t<isOneThread, F32x16, float>;
  using Boxes = BoxesOf<Float>;
  static constexpr uint32_t perLane = size / Lanes::size;

  /// The first n > 0 of boxes[index(0)], boxes[index(1)], …; the last one again in what is left of the group.
  template <class Index>
  HD static Boxes load([[maybe_unused]] const Lanes& lanes, const UnitBox* boxes, uint32_t n, Index index) {
    Boxes group;
    if constexpr (isOneThread) {
      std::size_t at[size];  // In floats, of which a segment may have more than 2^32.
      for (uint32_t j = 0; j < size; ++j) at[j] = std::size_t{index(n == size || j < n ? j : n - 1)} * UnitBox::floats;
      loadColumns(boxes->lo, at, group.lo);
      loadColumns(boxes->hi, at, group.hi);
    } else {
      const UnitBox box = boxes[index(lanes.lane() < n ? lanes.lane() : n - 1)];
      for (uint32_t d = 0; d < 3; ++d) {
        group.lo[d] = box.lo[d];
        group.hi[d] = box.hi[d];
      }
    }
    return group;
  }
  /// f(j, value of triangle j) for j < n, by the lane that has it.
  template <class F>
  HD static void forEach([[maybe_unused]] const Lanes& lanes, const Float& values, uint32_t n, F f) {
    if constexpr (isOneThread) {
      float at[size];
      values.store(at);
      for (uint32_t j = 0; j < n; ++j) f(j, at[j]);
    } else {
      if (lanes.lane() < n) f(lanes.lane(), values);
    }
  }
  /// The values of the lane's own triangles, whole numbers below 128.
  HD static void toBytes(const Float& values, uint8_t* own) {
    if constexpr (isOneThread) {
      float at[size];
      values.store(at);
      for (uint32_t j = 0; j < size; ++j) own[j] = static_cast<uint8_t>(static_cast<int32_t>(at[j]));
    } else {
      *own = static_cast<uint8_t>(static_cast<int32_t>(values));
    }
  }
};

/// f(i) for every i < n, shared out among the lanes; no sync.
template <class Lanes, class F>
HD inline void share(const Lanes& lanes, uint32_t n, F f) {
  for (uint32_t i = lanes.lane(); i < n; i += Lanes::size) f(i);
}

/// Draws k representatives of the segment at `boxes` into `w`: the first of all triangles, each next one the farthest
/// from its nearest representative so far among `draws` candidates. Of these, one is drawn from each of as many equal
/// runs of the segment, which has neighbours side by side: so candidates are not drawn twice, and lie apart. O(k²
/// draws).
template <class Lanes, class Work>
HD inline void drawRepresentatives(Lanes& lanes, const Settings& s, uint32_t k, const UnitBox* boxes, uint32_t first,
                                   uint32_t count, Work& w) {
  using Part = Group<Lanes>;
  Draws draws(s.seed, first, count);
  for (uint32_t c = 0; c < k; ++c) {
    const uint32_t candidates = c == 0 ? 1 : s.draws;
    const uint32_t run = count / candidates, rest = count % candidates;  // Run j is from j count / candidates on.
    for (uint32_t j = 0, begin = 0, over = 0; j < candidates; ++j) {     // All lanes draw the same; each notes its own.
      over += rest;
      const uint32_t carry = over >= candidates;
      over -= carry ? candidates : 0;
      const uint32_t at = begin + draws.below(run + carry);
      if (j % Lanes::size == lanes.lane()) w.candidate[j] = at;
      begin += run + carry;
    }
    lanes.sync();
    uint32_t chosen = 0;
    if (c > 0) {
      for (uint32_t base = 0; base < candidates; base += Part::size) {
        const uint32_t n = candidates - base < Part::size ? candidates - base : Part::size;
        const auto group = Part::load(lanes, boxes, n, [&](uint32_t j) { return w.candidate[base + j]; });
        Part::forEach(lanes, nearest(s.metric, group, w.reps, c).distance, n,
                      [&](uint32_t j, float d) { w.candidateDistance[base + j] = d; });
      }
      lanes.sync();
      for (uint32_t j = 1; j < candidates; ++j)
        if (w.candidateDistance[j] > w.candidateDistance[chosen]) chosen = j;
    }
    if (lanes.lane() == 0) w.reps[c] = boxes[w.candidate[chosen]];
    lanes.sync();
  }
}

/// Whether all k representatives are the same.
template <class Lanes, class Work>
HD inline bool allSame(Lanes& lanes, uint32_t k, const Work& w) {
  bool differs = false;
  share(lanes, k, [&](uint32_t c) {
    for (uint32_t d = 0; d < 6; ++d) differs |= w.reps[c][d] != w.reps[0][d];
  });
  return !lanes.any(differs);
}

template <class Lanes, class Work>
HD inline void clearSums(Lanes& lanes, uint32_t k, Work& w) {
  share(lanes, k, [&](uint32_t c) { w.sums[c] = Sums{}; });
  lanes.sync();
}

/// Adds a team's boxes to the clusters' sums. Lanes add up those of one cluster in a row in registers, and then all at
/// once in a tree: doubles have no atomic addition in a GPU's shared memory, and neighbours mostly fall into one
/// cluster.
template <class Lanes>
class SumUp {
 public:
  HD SumUp(Sums* sums, double scale) : sums_(sums), scale_(scale) {}
  /// sign × the box of each lane that `takes` part. All lanes call it.
  HD void add(Lanes& lanes, uint32_t c, const UnitBox* box, bool takes, double sign) {
    if constexpr (Lanes::size == 1) {
      addBox(sums_[c].at, *box, scale_, sign);
    } else {
      if (lanes.any(takes && cluster_ != c && cluster_ != none)) flush(lanes);
      if (!takes) return;
      cluster_ = c;
      addBox(own_.at, *box, scale_, sign);
    }
  }
  HD void flush(Lanes& lanes) {
    if constexpr (Lanes::size > 1) {
      for (uint32_t left; (left = lanes.ballot(cluster_ != none)) != 0;) {
        const uint32_t c = lanes.shfl(cluster_, lowestBit(left));
        const bool mine = cluster_ == c;
        for (uint32_t d = 0; d < 7; ++d) {
          const double sum = lanes.reduceAdd(mine ? own_.at[d] : 0.0);
          if (lanes.lane() == 0) sums_[c].at[d] += sum;
        }
        if (!mine) continue;
        own_ = Sums{};
        cluster_ = none;
      }
    }
  }

 private:
  static constexpr uint32_t none = maxK;

  Sums* sums_;
  double scale_;
  Sums own_{};
  uint32_t cluster_ = none;
};

/// Which triangles of a segment a team assigns.
struct Part {
  const UnitBox* boxes;  ///< Those of the part.
  uint8_t* cluster;      ///< Likewise: the clusters that they had, and get.
  uint32_t count;
  uint32_t first, segmentCount;  ///< The part's place in the segment.
};

/// Assigns the part's triangles to the nearest representatives, and adds to the sums who came and who left: all come
/// where it is the `first` time. Where all representatives are the same, runs of the segment go to at least half of
/// them in turn, so at least two clusters are not empty; a division for the length of a run would make ptxas spill.
/// True where any triangle changed its cluster.
template <class Lanes, class Work>
HD inline bool assign(Lanes& lanes, Metric metric, uint32_t k, const Part& part, bool first, bool sum, double scale,
                      Work& w) {
  using Boxes = Group<Lanes>;
  const bool same = allSame(lanes, k, w);
  const uint32_t bits = bitsBelow(part.segmentCount);
  SumUp<Lanes> sums(w.sums, scale);
  bool moved = false;
  for (uint32_t base = 0; base < part.count; base += Boxes::size) {
    const uint32_t n = part.count - base < Boxes::size ? part.count - base : Boxes::size;
    const auto group = Boxes::load(lanes, part.boxes + base, n, [](uint32_t j) { return j; });
    uint8_t own[Boxes::perLane];
    Boxes::toBytes(nearest(metric, group, w.reps, k).index, own);
    if (!first && !same && n == Boxes::size) {
      uint32_t differing = 0;
      for (uint32_t j = 0; j < Boxes::perLane; ++j) differing |= own[j] ^ part.cluster[base + lanes.lane() + j];
      if (!lanes.any(differing != 0)) continue;
    }
    for (uint32_t j = 0; j < Boxes::perLane; ++j) {  // All lanes take part, as they add together.
      const uint32_t i = base + j + lanes.lane();
      const bool valid = i < part.count;
      if (Boxes::isOneThread && !valid) break;
      const uint32_t c = same ? static_cast<uint32_t>(uint64_t{part.first + i} * k >> bits) : own[j];
      const uint32_t before = valid ? part.cluster[i] : c;
      const bool comes = valid && (first || c != before);
      if (Boxes::isOneThread && !comes) continue;
      if (comes) part.cluster[i] = static_cast<uint8_t>(c);
      moved |= comes;
      if (!sum) continue;
      sums.add(lanes, c, part.boxes + i, comes, 1);
      if (!first) sums.add(lanes, before, part.boxes + i, comes, -1);
    }
  }
  sums.flush(lanes);
  moved = lanes.any(moved);
  lanes.sync();
  return moved;
}

/// Hands out places: the lanes with a triangle (`valid`) get cursors[c], each its own, in the order of the lanes, and
/// the cursors are moved on. c is below `capacity`. All lanes call it, and sync() before the cursors are read by
/// others.
template <uint32_t capacity = maxK, class Lanes>
HD inline uint32_t takePlace(Lanes& lanes, uint32_t* cursors, uint32_t c, bool valid) {
  if constexpr (Lanes::size == 1) {
    return valid ? cursors[c]++ : 0;
  } else {
    uint32_t peers = lanes.ballot(valid);
    for (uint32_t bit = 1; bit < capacity; bit *= 2) {
      const uint32_t set = lanes.ballot(c & bit);
      peers &= c & bit ? set : ~set;
    }
    const uint32_t rank = lanes.rank(peers);
    const uint32_t place = valid ? cursors[c] + rank : 0;
    lanes.sync();
    if (valid && rank == 0) cursors[c] += popCount(peers);
    lanes.sync();
    return place;
  }
}

}  // namespace copse::kmeans
