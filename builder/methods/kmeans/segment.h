// The steps of k-means on one segment by one team: drawing representatives, assigning, summing. The passes over large
// segments and the refinement of small ones are made of these.
#pragma once

#include "builder/methods/kmeans/clusters.h"
#include "builder/parallel/team.h"

namespace copse::kmeans {

struct Settings {
  uint32_t k, draws, iterations, seed;
  uint32_t leafQueueBelow;  ///< m k: segments of fewer triangles are refined with k = 2.
  Metric metric;
};

HD inline uint32_t padded(uint32_t k) { return (k + 7) / 8 * 8; }

/// Triangles order[0] … order[count-1].
struct Segment {
  const UnitBox* boxes;
  const uint32_t* order;
  uint32_t count;
  HD const UnitBox& operator[](uint32_t i) const { return boxes[order[i]]; }
};

/// What a team keeps in shared memory for one segment or a part of it.
struct Workspace {
  Representatives reps;
  Sums sums[maxK];
  uint32_t cursors[maxK];
  float candidateDistance[maxDraws];
  uint32_t candidate[maxDraws];
};
static_assert(sizeof(Workspace) * detail::teamsInBlock <= 48 * 1024);

/// The first representative is drawn; each next one is, of `draws` candidates, the one farthest from its nearest
/// representative so far. O(k² draws).
HD inline void drawRepresentatives(const Team& team, const Settings& s, uint32_t k, const Segment& segment,
                                   uint32_t segmentName, Workspace& w) {
  Draws draws(s.seed, segmentName);
  team.forEach(6 * maxK, [&](uint32_t j) { w.reps.at[j / maxK][j % maxK] = 0; });
  for (uint32_t c = 0; c < k; ++c) {
    const uint32_t candidates = c == 0 ? 1 : s.draws;
    team.single([&] {
      for (uint32_t j = 0; j < candidates; ++j) {  // One of each part of the segment.
        const auto begin = static_cast<uint32_t>(uint64_t{j} * segment.count / candidates);
        const auto end = static_cast<uint32_t>(uint64_t{j + 1} * segment.count / candidates);
        w.candidate[j] = begin + draws.below(end - begin);
      }
    });
    team.forEach(candidates, [&](uint32_t j) {
      bool allEqual;
      nearest(s.metric, segment[w.candidate[j]], w.reps, c, w.candidateDistance[j], allEqual);
    });
    team.single([&] {
      uint32_t best = 0;
      for (uint32_t j = 1; j < candidates; ++j)
        if (w.candidateDistance[j] > w.candidateDistance[best]) best = j;
      const UnitBox& chosen = segment[w.candidate[best]];
      for (uint32_t d = 0; d < 6; ++d) w.reps.at[d][c] = chosen[d];
    });
  }
}

HD inline void clearSums(const Team& team, uint32_t k, Workspace& w) {
  team.forEach(k, [&](uint32_t c) { w.sums[c] = Sums{}; });
}

/// Adds boxes begin … begin+n-1 of the segment to the sums of their nearest representatives.
HD inline void assignAndSum(const Team& team, Metric metric, uint32_t k, const Segment& segment, uint32_t begin,
                            uint32_t n, Workspace& w) {
  const double scale = fixedScale(segment.count);
  team.forEach(n, [&](uint32_t j) {
    const UnitBox& b = segment[begin + j];
    Sums& sums = w.sums[clusterOf(metric, b, w.reps, k, begin + j, segment.count)];
    for (uint32_t d = 0; d < 6; ++d) Team::add(&sums.at[d], toFixed(b[d], scale));
    Team::add(&sums.count, uint64_t{1});
  });
}

/// A cluster's mean; an empty cluster keeps its representative.
HD inline float meanOf(const Sums& sums, uint32_t d, double scale, float old) {
  if (sums.count == 0) return old;
  return static_cast<float>(static_cast<double>(sums.at[d]) / (static_cast<double>(sums.count) * scale));
}

}  // namespace copse::kmeans
