// Scene descriptions in TOML. The keys are in docs/scenes.md.
#pragma once

#include <string>

#include "tracer/scene/scene.h"

namespace copse {

/// Everything that the file says; what it leaves out (views, lights) stays empty. Throws InputError "FILE:LINE: what".
Scene readSceneToml(const std::string& file, const LoadOptions& options);

}  // namespace copse
