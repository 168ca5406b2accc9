// copse render: a scene in; an EXR, a preview, a record and the time to image out.
#include <fmt/format.h>

#include <memory>
#include <optional>

#include "tracer/cli/commands.h"
#include "tracer/cli/print.h"
#include "tracer/cli/progress.h"
#include "tracer/cli/render_files.h"
#include "tracer/cli/render_options.h"
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

int run(const RenderCommand& options) {
  const RenderSettings settings = options.render.settings();
  const TreeSource source = options.builder.source();
  const Parameters parameters = options.builder.parameters();
  const OptimiserNames optimisers = options.builder.optimisers();
  const LoadOptions sceneOptions = options.scene.load();
  options.check(source);
  checkBeforeLoading(options.files);
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

  if (!stop) prepare(options, device, source, parameters, optimisers, ready);
  for (const Camera& camera : cameras) {
    Rendered rendered;
    if (!stop) {
      Progress progress("rendering " + camera.name, options.quiet);
      rendered = render(ready.integrator, device, ready.loaded, ready.tree, camera, settings,
                        {[&](double done) { progress.report(done); }, &stop});
    }
    if (!stop) measureMore(options, device, ready, camera, settings, stop, rendered.record);
    const double samples = rendered.record.image ? rendered.record.image->samplesDone : 0;
    if (stop && samples <= 0) {
      say("interrupted before the first sample of view {}: its image was not written\n", camera.name);
      return interrupted;
    }
    const Outputs files = outputsOf(options.files, scene.name, camera);
    writeOutputs(files, rendered, options.exposure);
    if (!options.quiet) {
      printSummary(rendered.record, files.png.empty() ? "" : ", " + files.png);
      print("{}", rendered.picture.remarks);
    }
    if (stop && samples < settings.spp) {
      say("interrupted: {} holds {:.4g} of {} samples per pixel\n", files.exr, samples, settings.spp);
      return interrupted;
    }
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
