// Names → build functions. Adding a builder is one file under methods/ and one row in registry.cpp;
// tests, benchmarks and the command line find it there.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "builder/bvh.h"
#include "builder/parameters.h"

namespace copse {

/// What every builder gets, in the device's memory: the triangles' boxes and the box around all of them.
struct BuildInput {
  const Box* boxes = nullptr;
  uint32_t count = 0;
  const Box* bounds = nullptr;
};

using BuildFunction = Bvh (*)(const Device&, const BuildInput&, const Parameters&);

struct BuilderEntry {
  const char* name;
  const char* source;   ///< "Karras 2012"
  const char* meaning;  ///< One line.
  BuildFunction build;
  bool onCpuOnly;  ///< The method runs on the CPU; boxes and tree are copied.
  std::vector<std::pair<const char*, ParameterValue>> preset;  ///< Parameters that this name stands for.
};

std::span<const BuilderEntry> builders();
/// Throws InputError that lists the names.
const BuilderEntry& findBuilder(std::string_view name);

}  // namespace copse
