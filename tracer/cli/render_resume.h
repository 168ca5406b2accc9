// `copse render --resume`: which views go on from their files, which are done, and which cannot.
#pragma once

#include <optional>
#include <vector>

#include "tracer/cli/render_options.h"
#include "tracer/session/resume.h"

namespace copse::cli {

/// A view of a render with --resume.
struct ResumedView {
  std::optional<EarlierRender> earlier;  ///< None where the view's file is not there.
  FilmState film;
  bool isDone = false;  ///< The file has the samples that are asked for.
};

/// The checks that need no scene, on the file of -o where there is one. Throws InputError.
void checkResumeBeforeLoading(const RenderCommand& options);

/// One for each camera, in their order; none without --resume. Throws InputError where a file cannot be gone on from,
/// or has more samples than are asked for. Says what a user should know unless the command is quiet.
std::vector<ResumedView> resumedViews(const RenderCommand& options, const Device& device, const LoadedScene& loaded,
                                      const std::vector<Camera>& cameras);

}  // namespace copse::cli
