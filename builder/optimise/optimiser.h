// What an optimiser is to everybody else: one descriptor, at the end of its file. CMakeLists.txt here has the list of
// all.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "builder/open_tree.h"
#include "builder/parallel/timeline.h"
#include "builder/parameters.h"
#include "builder/primitives/primitives.h"

namespace copse {

/// Changes the topology of a tree that any method made, before its leaves are chosen.
struct Optimiser {
  const char* name;
  const char* source;   ///< "Karras and Aila 2013"
  const char* meaning;  ///< One line.
  /// Gets a tree of any numbering with its parents linked, whose leaves' boxes alone can be relied on, and leaves one
  /// like that: with the root as node 0, no leaf before firstLeaf, and references in any order. What it was built over
  /// is for optimisers that split references.
  void (*run)(const Device&, OpenTree&, const Primitives&, const Parameters&) = nullptr;
  bool binaryOnly = false;  ///< It does not know joints, and is not run on a tree that may have some.
  std::vector<ParameterSpec> parameters = {};  ///< That it alone reads.
  std::vector<PhaseName> phases = {};          ///< That it alone launches.
};

namespace optimisers {

/// In the order of builder/optimise/CMakeLists.txt.
std::span<const Optimiser> all();

}  // namespace optimisers

/// Throws InputError that lists the names.
const Optimiser& findOptimiser(std::string_view name);

/// Optimisers by name, in the order in which they run.
using OptimiserNames = std::vector<std::string>;

/// "treelets-exact,treelets-agglomerative"; none for "". Throws InputError as findOptimiser() does.
OptimiserNames optimiserNames(std::string_view list);

/// Runs them one after the other. Throws InputError where one needs a binary tree and this is none.
void optimise(const Device& device, OpenTree& tree, const Primitives& primitives, const OptimiserNames& names,
              const Parameters& parameters);

}  // namespace copse
