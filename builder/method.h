// What a method is to everybody else: one descriptor, at the end of its file under methods/. CMakeLists.txt there has
// the list of all.
#pragma once

#include <vector>

#include "builder/optimise/optimiser.h"

namespace copse {

using BuildFunction = OpenTree (*)(const Device&, const Primitives&, const Parameters&);

/// A further name, of a method with some of its parameters set.
struct Preset {
  const char* name;
  const char* meaning;
  ParameterValues settings;
};

/// What the passes of a build from the top found, for pictures of it: the nodes at a depth, and above it those that are
/// not split any more.
struct PassClusters {
  Buffer<uint32_t> clusterOf;        ///< Per triangle; clusters are numbered in the order of their place in the tree.
  std::vector<Box> representatives;  ///< Per cluster, in the scene's unit: what its triangles were last held against.
  uint32_t level = 0;                ///< Passes that were run: fewer than asked for where the tree has no more.
};

struct Method {
  const char* name;
  const char* source;              ///< "Karras 2012"
  const char* meaning;             ///< One line.
  const char* family = nullptr;    ///< Methods of one family have shades of one colour in reports; null: `name`.
  const char* page = nullptr;      ///< Its page in the repository, if it has one: "docs/builders/lbvh.md".
  BuildFunction build = nullptr;   ///< One reference per leaf.
  OptimiserNames optimisers = {};  ///< Run over what `build` gives.
  bool onCpuOnly = false;          ///< It runs on the CPU; boxes and tree are copied.
  std::vector<ParameterSpec> parameters = {};  ///< That it alone reads, each named after it: "aac.delta".
  std::vector<PhaseName> phases = {};          ///< What it launches beside the phases of builder/phases.h.
  std::vector<Preset> presets = {};
  bool presetsOnly = false;  ///< `name` is no builder's name, those of the presets are.

  /// What follows from settings that were chosen, once defaults and preset are in `parameters`; may be null.
  void (*derive)(Parameters& parameters, const Parameters& chosen) = nullptr;
  /// The clusters after pass `level` > 0 of a build with `parameters`; null where a build has no such passes.
  PassClusters (*passClusters)(const Device&, const Primitives&, const Parameters&, uint32_t level) = nullptr;
};

}  // namespace copse
