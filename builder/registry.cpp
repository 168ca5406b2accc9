// The table of builders: one row a name.
#include "builder/registry.h"

#include <fmt/format.h>

#include "builder/methods/methods.h"
#include "builder/parallel/error.h"

namespace copse {

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
      {"sah",
       "MacDonald and Booth 1990",
       "full sweep: the split of lowest surface area cost at each node",
       buildSah,
       true,
       {}},
  };
  return table;
}

const BuilderEntry& findBuilder(const std::string& name) {
  std::vector<const char*> names;
  for (const BuilderEntry& entry : builders()) {
    if (name == entry.name) return entry;
    names.push_back(entry.name);
  }
  throw InputError(fmt::format("unknown builder '{}': one of {}", name, fmt::join(names, ", ")));
}

}  // namespace copse
