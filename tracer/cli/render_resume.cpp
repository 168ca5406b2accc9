// The files that are there, read and compared with what is asked for.
#include "tracer/cli/render_resume.h"

#include <fmt/format.h>

#include <filesystem>

#include "builder/base/error.h"
#include "builder/base/version.h"
#include "tracer/cli/print.h"

namespace copse::cli {

namespace {

bool isThere(const std::string& file) {
  std::error_code error;
  return std::filesystem::exists(file, error);
}

void checkSamples(const EarlierRender& earlier, const RenderSettings& settings) {
  if (earlier.image.samplesDone > settings.spp)
    throw InputError(fmt::format("{}: has {:.6g} samples per pixel, more than --spp {} (expected more to go on to)",
                                 earlier.file, earlier.image.samplesDone, settings.spp));
}

/// What rays go through on `device`; "" for an integrator with a tree of its own.
std::string tracerOf(const RenderCommand& options, const Device& device) {
  if (options.integrator().tree == TreeUse::none) return "";
  return options.builder.tracer().resolve(device, options.builder.source()).name;
}

void noteOtherProgram(const EarlierRender& earlier) {
  if (earlier.version == version() && earlier.commit == commit()) return;
  say("note: {} was made by Copse {} of commit {}, this is {} of {}: if their images differ, this one is a mixture\n",
      earlier.file, earlier.version, earlier.commit, version(), commit());
}

}  // namespace

void checkResumeBeforeLoading(const RenderCommand& options) {
  const RenderFiles& files = options.files;
  if (!options.resume || files.output.empty() || files.allViews() || !isThere(files.output)) return;
  const EarlierRender earlier = readEarlierRender(files.output);
  checkSameRender(earlier, files.integrator, options.render.settings());
  checkSamples(earlier, options.render.settings());
}

std::vector<ResumedView> resumedViews(const RenderCommand& options, const Device& device, const LoadedScene& loaded,
                                      const std::vector<Camera>& cameras) {
  std::vector<ResumedView> views;
  if (!options.resume) return views;
  const RenderSettings settings = options.render.settings();
  for (const Camera& camera : cameras) {
    ResumedView& view = views.emplace_back();
    const std::string file = outputsOf(options.files, loaded.scene.name, camera).exr;
    if (!isThere(file)) {
      if (!options.quiet) say("note: {} is not there: view {} starts with its first sample\n", file, camera.name);
      continue;
    }
    view.earlier = readEarlierRender(file);
    const Camera here = inFiles(loaded.scene, camera);
    checkSameRender(*view.earlier, options.files.integrator, settings, &here, &loaded.hash);
    checkSameTracer(*view.earlier, tracerOf(options, device));
    checkSamples(*view.earlier, settings);
    view.isDone = view.earlier->image.samplesDone == settings.spp;
    if (view.isDone) {
      if (!options.quiet) say("note: {} has its {} samples per pixel already\n", file, settings.spp);
      continue;
    }
    if (!options.quiet) noteOtherProgram(*view.earlier);
    view.film = readFilm(*view.earlier);
  }
  return views;
}

}  // namespace copse::cli
