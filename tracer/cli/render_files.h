// The files that `copse render` writes: their names, what could be wrong with them, and their contents.
#pragma once

#include <string>
#include <vector>

#include "tracer/cli/options.h"
#include "tracer/session/render.h"

namespace copse::cli {

/// What was asked for; "" is the default, and for `preview` and `stats` none.
struct RenderFiles {
  std::string scene, output, view, preview, stats, integrator;

  bool allViews() const { return view == "all"; }
};

/// The files of one view; what is not to be written is empty.
struct Outputs {
  std::string exr, png, json;
};

/// out/SCENE-INTEGRATOR-VIEW.exr by default, without the integrator where it makes images of light, and without the
/// view where it was not asked for.
Outputs outputsOf(const RenderFiles& files, const std::string& sceneName, const Camera& camera);

/// What can be known to be wrong before the scene is read; makes the folder of the default names. Throws InputError.
void checkBeforeLoading(const RenderFiles& files);
/// Throws InputError where an output cannot be written, or would replace another or the scene.
void checkOutputs(const RenderFiles& files, const Scene& scene, const std::vector<Camera>& cameras);

/// `exposure` in stops, for the preview.
void writeOutputs(const Outputs& outputs, Rendered& rendered, float exposure);

}  // namespace copse::cli
