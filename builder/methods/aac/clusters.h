// A list of clusters, and how it is made shorter: the two whose union has the minimum surface area are joined, again
// and again. Every cluster knows its nearest other; one join changes that of few. O(length) per join and per
// such change.
#pragma once

#include <cstdint>
#include <limits>
#include <vector>

#include "builder/bvh.h"

namespace copse::aac {

struct Cluster {
  static constexpr float nothing = std::numeric_limits<float>::infinity();

  Box box;
  uint32_t node;   ///< The root of its subtree.
  uint32_t spare;  ///< Each box brings a number and each join uses one up, so a cluster has always one left over.
  uint32_t size;   ///< Boxes in it.
  uint32_t nearest = 0;
  float distance = nothing;  ///< Half the surface area of the union with the nearest.
};

/// How many clusters stay of `count` boxes: c·count^(1/2 - epsilon) with c such that delta boxes leave delta / 2,
/// rounded up. 1 at least.
uint32_t keptOf(uint32_t delta, double epsilon, uint32_t count);

/// Inner nodes and parents that a join writes. Number `spare` is node spare - 1; 0 is never used.
struct Joined {
  BvhNode* nodes;
  uint32_t* parents;
};

/// One thread's memory for shortening lists, one array a field so that eight clusters are looked at together. It starts
/// a cache line, as threads' ones stand side by side.
class alignas(64) Shortener {
 public:
  /// Leaves `target` clusters, at least 1, of `list`. The first `half` of them know their nearest among themselves, and
  /// so do the others (places counted from the half's begin); half = 0: none knows any. Of equal distances the one with
  /// fewer boxes counts as nearer, so that equal boxes make an even tree. Afterwards all know their nearest in the
  /// list.
  void shorten(std::vector<Cluster>& list, uint32_t half, uint32_t target, const Joined& joined);

 private:
  struct Nearest {
    float distance = Cluster::nothing;
    uint32_t place = 0;
  };

  void load(const std::vector<Cluster>& list, uint32_t half);
  void put(uint32_t at, const Cluster& cluster);
  Cluster at(uint32_t place) const;
  bool nearer(uint32_t of, const Nearest& a, const Nearest& b) const;
  Nearest findNearest(uint32_t of, uint32_t begin, uint32_t end);
  uint32_t firstOfClosestPair();
  void join(uint32_t first, uint32_t second, const Joined& joined);
  void setNearest(uint32_t of, const Nearest& nearest) {
    distance_[of] = nearest.distance;
    nearest_[of] = nearest.place;
  }

  uint32_t count_ = 0;
  std::vector<float> lo_[3], negatedHi_[3], distance_, seen_;
  std::vector<uint32_t> nearest_, node_, spare_, size_;
};

}  // namespace copse::aac
