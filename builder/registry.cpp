// The table of builders: one row a name.
#include "builder/registry.h"

#include <fmt/format.h>

#include <optional>

#include "builder/base/error.h"
#include "builder/methods/methods.h"

namespace copse {

namespace {

/// One of the paper's parameter sets.
BuilderEntry kmeansPreset(const char* name, const char* meaning, int64_t k, int64_t p, std::optional<int64_t> i) {
  BuilderEntry entry{name, "Meister and Bittner 2016", meaning, buildKmeans, false, {}};
  entry.preset = {{"kmeans.k", k}, {"kmeans.p", p}};
  if (i) entry.preset.emplace_back("kmeans.i", *i);
  return entry;
}

}  // namespace

std::span<const BuilderEntry> builders() {
  static const std::vector<BuilderEntry> table{
      {"lbvh", "Karras 2012", "linear BVH: radix tree over sorted Morton codes", buildLbvh, false, {}},
      {"lbvh-apetrei", "Apetrei 2014", "the tree of lbvh in one bottom-up pass", buildLbvhApetrei, false, {}},
      {"hlbvh",
       "Garanzha 2011",
       "radix trees under a binned surface area tree over their Morton cells",
       buildHlbvh,
       false,
       {}},
      {"trbvh",
       "Karras and Aila 2013",
       "lbvh with treelets of seven leaves rebuilt at their best",
       buildTrbvh,
       false,
       {}},
      {"atrbvh",
       "Domingues and Pedrini 2015",
       "lbvh with treelets of nine leaves rebuilt by joining what is closest",
       buildAtrbvh,
       false,
       {}},
      {"aac-fast",
       "Gu 2013",
       "approximate agglomerative clustering in Morton order, few candidates",
       buildAac,
       true,
       {{"aac.delta", int64_t{4}}, {"aac.epsilon", 0.2}}},
      {"aac-hq",
       "Gu 2013",
       "approximate agglomerative clustering in Morton order, many candidates",
       buildAac,
       true,
       {{"aac.delta", int64_t{20}}, {"aac.epsilon", 0.1}}},
      {"sah",
       "MacDonald and Booth 1990",
       "full sweep: the split of lowest surface area cost at each node",
       buildSah,
       true,
       {}},
      {"kmeans",
       "Meister and Bittner 2016",
       "k-means clustering from the top, agglomeration of each node's k clusters",
       buildKmeans,
       false,
       {}},
      kmeansPreset("kmeans-q1", "k-means with k = 8, p = 5, i = 0", 8, 5, 0),
      kmeansPreset("kmeans-q2", "k-means with k = 8, p = 5, i = 2", 8, 5, 2),
      kmeansPreset("kmeans-q3", "k-means with k = 16, p = 5, i = 5", 16, 5, 5),
      kmeansPreset("kmeans-q4", "k-means with k = 32, p = 20, i = 10", 32, 20, 10),
      kmeansPreset("kmeans-q5", "k-means with k = 64, p = 30, i = 15", 64, 30, 15),
      kmeansPreset("kmeans-r1", "k-means with k = 8, p = 5; the paper's plots vary i", 8, 5, {}),
      kmeansPreset("kmeans-r2", "k-means with k = 16, p = 5; the paper's plots vary i", 16, 5, {}),
      kmeansPreset("kmeans-r3", "k-means with k = 32, p = 20; the paper's plots vary i", 32, 20, {}),
      kmeansPreset("kmeans-r4", "k-means with k = 64, p = 30; the paper's plots vary i", 64, 30, {}),
  };
  return table;
}

const BuilderEntry& findBuilder(std::string_view name) {
  std::vector<const char*> names;
  for (const BuilderEntry& entry : builders()) {
    if (name == entry.name) return entry;
    names.push_back(entry.name);
  }
  throw InputError(fmt::format("unknown builder '{}': one of {}", name, fmt::join(names, ", ")));
}

}  // namespace copse
