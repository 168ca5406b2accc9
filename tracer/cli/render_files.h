// The files that `copse render` writes: their names, the checks on them, and their contents.
#pragma once

#include <string>
#include <vector>

#include "tracer/cli/options.h"
#include "tracer/session/render.h"

namespace copse::cli {

/// As requested; "" is the default, and for `preview` and `stats` none.
struct RenderFiles {
  std::string scene, output, view, preview, stats, integrator;

  bool allViews() const { return view == "all"; }
};

/// The files of one view; empty where none is to be written.
struct Outputs {
  std::string exr, png, json;
};

/// out/SCENE-INTEGRATOR-VIEW.exr by default, without the integrator where it renders light, and without the view where
/// none was requested.
Outputs outputsOf(const RenderFiles& files, const std::string& sceneName, const Camera& camera);

/// The checks that need no scene; makes the folder of the default names. Throws InputError.
void checkBeforeLoading(const RenderFiles& files);
/// Throws InputError where an output cannot be written, or would replace another or the scene.
void checkOutputs(const RenderFiles& files, const Scene& scene, const std::vector<Camera>& cameras);

/// `exposure` in stops, for the preview.
void writeOutputs(const Outputs& outputs, Rendered& rendered, float exposure);

}  // namespace copse::cli
