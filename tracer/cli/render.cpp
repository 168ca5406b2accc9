// copse render: a scene in; an EXR, a preview, a record and the time to image out.
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <optional>

#include "tracer/cli/commands.h"
#include "tracer/cli/print.h"
#include "tracer/cli/progress.h"
#include "tracer/cli/render_files.h"
#include "tracer/cli/render_options.h"
#include "tracer/cli/render_resume.h"
#include "tracer/cli/summary.h"
#include "tracer/image/image_io.h"
#include "tracer/session/render.h"

namespace copse::cli {

namespace {

void tell(const RenderCommand& options, const Scene& scene) {
  if (!options.quiet)
    for (const std::string& note : scene.notes) say("note: {}\n", note);
  if (!options.quiet && options.files.output.empty() && !hasOpenImageIO())
    say("note: no preview is written: {}\n", whyNoOpenImageIO());
  const std::string unused = options.builder.given();
  if (options.integrator().tree == TreeUse::none && !unused.empty() && !options.quiet)
    say("note: ignored {}: --integrator {} has a tree of its own\n", unused, options.files.integrator);
  if (options.integrator().rendersLight && scene.emitterCount() == 0)
    say("warning: {}: there is no light, so the image will be black\n", options.files.scene);
}

std::vector<Camera> chosenCameras(const Scene& scene, const std::string& name) {
  if (name == "all" && !scene.cameras.empty()) return scene.cameras;
  return {findCamera(scene, name)};
}

/// What the views are rendered from. It must not move: the integrator refers to the rest.
struct Ready {
  LoadedScene loaded;
  BuiltTree tree;  ///< None where the integrator needs none.
  ReadyIntegrator integrator;
};

void prepare(const RenderCommand& options, const Device& device, const TreeSource& source, const Parameters& parameters,
             const OptimiserNames& optimisers, Ready& ready) {
  const IntegratorEntry& entry = options.integrator();
  std::optional<Progress> progress;
  if (entry.tree != TreeUse::none) {
    progress.emplace(fmt::format("building {}", options.builder.name), options.quiet);
    ready.tree = buildTree(device, ready.loaded.triangles(), source, parameters, optimisers, options.builder.tracer());
  }
  ready.integrator = makeReady(entry, device, ready.loaded, ready.tree, options.integratorOptions());
}

/// Measures what was requested on top, after all that is timed.
void measureMore(const RenderCommand& options, const Device& device, const Ready& ready, const Camera& camera,
                 const RenderSettings& settings, const std::atomic<bool>& stop, RunRecord& record) {
  if (options.endPointOverlap) {
    Progress progress("end-point overlap", options.quiet);
    record.tree->endPointOverlap = endPointOverlapOf(device, ready.loaded.triangles(), ready.tree);
  }
  if (options.countTraversal) {
    Progress progress("counting " + camera.name, options.quiet);
    const Watch watch{[&](double done) { progress.report(done); }, &stop};
    record.traversal = countTraversal(device, ready.loaded, ready.tree, camera, settings, watch);
  }
}

/// Renders a view and writes its files; the exit status.
int renderView(const RenderCommand& options, const Device& device, const Ready& ready, const Camera& camera,
               const ResumedView* from, const std::atomic<bool>& stop) {
  const RenderSettings settings = options.render.settings();
  Rendered rendered;
  if (!stop) {
    Progress progress("rendering " + camera.name, options.quiet);
    rendered = render(ready.integrator, device, ready.loaded, ready.tree, camera, settings,
                      {[&](double done) { progress.report(done); }, &stop}, from ? &from->film : nullptr);
  }
  if (!stop) measureMore(options, device, ready, camera, settings, stop, rendered.record);
  const bool goesOn = from && from->earlier;
  const double samples = rendered.record.image ? rendered.record.image->samplesDone : 0;
  if (stop && samples <= (goesOn ? from->earlier->image.samplesDone : 0)) {
    say("interrupted before the first {}sample of view {}: its image was not written\n", goesOn ? "further " : "",
        camera.name);
    return interrupted;
  }
  if (goesOn) rendered.record.earlier = from->earlier->runs;
  const Outputs files = outputsOf(options.files, ready.loaded.scene.name, camera);
  writeOutputs(files, rendered, options.exposure);
  if (!options.quiet) {
    printSummary(rendered.record, files.png.empty() ? "" : ", " + files.png);
    print("{}", rendered.picture.remarks);
  }
  if (stop && samples < settings.spp) {
    say("interrupted: {} holds {:.4g} of {} samples per pixel{}\n", files.exr, samples, settings.spp,
        options.integrator().takes.resume ? "; continue with --resume" : "");
    return interrupted;
  }
  return done;
}

int run(const RenderCommand& options) {
  options.render.settings();  // Checked before the work.
  const TreeSource source = options.builder.source();
  const Parameters parameters = options.builder.parameters();
  const OptimiserNames optimisers = options.builder.optimisers();
  const LoadOptions sceneOptions = options.scene.load();
  options.check(source);
  checkBeforeLoading(options.files);
  checkResumeBeforeLoading(options);
  const IntegratorEntry& integrator = options.integrator();
  const Device chosen = options.builder.deviceFor(options.device, options.quiet);
  const Device device = integrator.onCpuOnly ? openDevice("cpu", chosen.threads) : chosen;
  const std::atomic<bool>& stop = stopOnSignal();

  Ready ready;
  ready.loaded = [&] {
    Progress progress("loading " + options.files.scene, options.quiet);
    return load(device, options.files.scene, loadFor(integrator), sceneOptions);
  }();
  const Scene& scene = ready.loaded.scene;
  tell(options, scene);
  const std::vector<Camera> cameras = chosenCameras(scene, options.files.view);
  checkOutputs(options.files, scene, cameras);

  const std::vector<ResumedView> resumed = resumedViews(options, device, ready.loaded, cameras);
  const auto isDone = [](const ResumedView& view) { return view.isDone; };
  if (options.resume && std::ranges::all_of(resumed, isDone)) return done;

  if (!stop) prepare(options, device, source, parameters, optimisers, ready);
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    const ResumedView* const from = options.resume ? &resumed[i] : nullptr;
    if (from && from->isDone) continue;
    if (const int status = renderView(options, device, ready, cameras[i], from, stop); status != done) return status;
  }
  return done;
}

}  // namespace

Command addRender(CommandLine& program) {
  CommandLine command = program.addCommand("render", "Render a scene to an EXR, and report the time to image");
  auto options = std::make_shared<RenderCommand>();
  options->add(command);
  return [options] { return run(*options); };
}

}  // namespace copse::cli
