// Scenes for the fuzzers of meshes and what belongs to them.
#pragma once

#include <string>

#include "tests/fuzz/fuzz.h"
#include "tests/support/whole_scene.h"
#include "tracer/scene/scene.h"

namespace copse::fuzz {

/// Loads a scene as every command does, without textures.
inline void load(const std::string& file) {
  attempt([&] {
    if (!test::isWhole(loadScene(file))) finding("a scene that is not whole");
  });
}

}  // namespace copse::fuzz
