// Names → methods: each method's own name and those of its presets. What a method is stands in builder/method.h; the
// list of all in builder/methods/CMakeLists.txt. Tests, benchmarks and the command line find builders here.
#pragma once

#include <span>
#include <string_view>

#include "builder/method.h"

namespace copse {

/// A name that can be chosen: a method with some settings.
struct BuilderEntry {
  const char* name;
  const char* source;   ///< "Karras 2012"
  const char* meaning;  ///< One line.
  const Method* method;
  ParameterValues preset = {};  ///< Parameters that this name stands for.
};

namespace methods {

/// In the order of builder/methods/CMakeLists.txt.
std::span<const Method> all();

}  // namespace methods

/// Each method's name, then its presets.
std::span<const BuilderEntry> builders();
/// Throws InputError that lists the names.
const BuilderEntry& findBuilder(std::string_view name);

}  // namespace copse
