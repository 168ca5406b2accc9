// copse render: a scene in; an EXR, a preview, a record and the time to image out.
#include <fmt/format.h>

#include <memory>

#include "tracer/cli/commands.h"
#include "tracer/cli/print.h"
#include "tracer/cli/progress.h"
#include "tracer/cli/render_files.h"
#include "tracer/cli/render_options.h"
#include "tracer/cli/summary.h"
#include "tracer/image/image_io.h"
#include "tracer/integrators/clusters.h"
#include "tracer/session/pictures.h"

namespace copse::cli {

namespace {

void tell(const RenderCommand& options, const Scene& scene) {
  if (!options.quiet)
    for (const std::string& note : scene.notes) say("note: {}\n", note);
  if (!options.quiet && options.files.output.empty() && !hasOpenImageIO())
    say("note: no preview is written, for PNG cannot be: {}\n", whyNoOpenImageIO());
  if (rendersLight(options.integrator()) && scene.emitterCount() == 0)
    say("warning: {}: there is no light, so the image will be black\n", options.files.scene);
}

std::vector<View> chosenViews(const Scene& scene, const std::string& name) {
  if (name == "all" && !scene.views.empty()) return scene.views;
  return {findView(scene, name)};
}

/// What the views are rendered from.
struct Ready {
  LoadedScene loaded;
  BuiltTree tree;          ///< None for the reference integrator.
  BuiltClusters clusters;  ///< For the integrator of that name.
};

Ready prepare(const RenderCommand& options, const Device& device, LoadedScene loaded, const TreeSource& source,
              const Parameters& parameters, const OptimiserNames& optimisers) {
  Ready ready{std::move(loaded), {}, {}};
  if (options.integrator() == "reference") return ready;
  Progress progress(fmt::format("building {}", options.builder.name), options.quiet);
  ready.tree = buildTree(device, ready.loaded.triangles(), source, parameters, optimisers, options.builder.tracer());
  if (options.integrator() != "clusters") return ready;
  ready.clusters = buildClusters(device, ready.loaded.triangles(), ready.tree, options.clusterLevel.value_or(1));
  return ready;
}

Rendered render(const RenderCommand& options, const Device& device, const Ready& ready, const View& view,
                const RenderSettings& settings, const Watch& watch) {
  const std::string& integrator = options.integrator();
  if (integrator == "reference") return renderByReference(device, ready.loaded, view, settings, watch);
  if (integrator == "clusters")
    return renderClusterPicture(device, ready.loaded, ready.tree, ready.clusters, view, settings, watch);
  if (integrator == "heatmap")
    return renderHeatmap(device, ready.loaded, ready.tree, view, settings, options.heatMax.value_or(0), watch);
  if (const auto picture = surfacePicture(integrator))
    return renderSurfacePicture(device, ready.loaded, ready.tree, view, settings, *picture, options.aov, watch);
  return renderTree(device, ready.loaded, ready.tree, view, settings, watch, options.aov);
}

/// What there is to say of a picture that is no image of light.
void printPicture(const RenderCommand& options, const Ready& ready, const RunRecord& record) {
  if (options.integrator() == "heatmap") printHeatScale(record);
  if (options.integrator() != "clusters") return;
  const PassClusters& clusters = ready.clusters.clusters;
  const std::size_t count = clusters.representatives.size();
  print("\nclusters {} after pass {}{}\n", grouped(count), clusters.level,
        static_cast<int>(clusters.level) < options.clusterLevel.value_or(1) ? ", the last" : "");
  if (count > mostBoxesDrawn)
    print("         without their boxes, which are drawn up to {}\n", grouped(mostBoxesDrawn));
}

/// What is measured on demand, after what is timed.
void measureMore(const RenderCommand& options, const Device& device, const Ready& ready, const View& view,
                 const RenderSettings& settings, const std::atomic<bool>& stop, RunRecord& record) {
  if (options.endPointOverlap) {
    Progress progress("end-point overlap", options.quiet);
    record.tree->endPointOverlap = endPointOverlapOf(device, ready.loaded, ready.tree);
  }
  if (options.countTraversal) {
    Progress progress("counting " + view.name, options.quiet);
    const Watch watch{[&](double done) { progress.report(done); }, &stop};
    record.traversal = countTraversal(device, ready.loaded, ready.tree, view, settings, watch);
  }
}

int run(const RenderCommand& options) {
  const RenderSettings settings = options.render.settings();
  const TreeSource source = options.builder.source();
  const Parameters parameters = options.builder.parameters();
  const OptimiserNames optimisers = options.builder.optimisers();
  options.check(source);
  checkBeforeLoading(options.files);
  const bool byReference = options.integrator() == "reference";
  const Device chosen = options.builder.deviceFor(options.device, options.quiet);
  const Device device = byReference ? openDevice("cpu", chosen.threads) : chosen;
  const std::atomic<bool>& stop = stopOnSignal();

  LoadedScene loaded = [&] {
    Progress progress("loading " + options.files.scene, options.quiet);
    return byReference ? loadForReference(options.files.scene) : loadForPaths(device, options.files.scene);
  }();
  tell(options, loaded.scene);
  const std::vector<View> views = chosenViews(loaded.scene, options.files.view);
  checkOutputs(options.files, loaded.scene, views);

  Ready ready;
  if (!stop) ready = prepare(options, device, std::move(loaded), source, parameters, optimisers);
  for (const View& view : views) {
    Rendered rendered;
    if (!stop) {
      Progress progress("rendering " + view.name, options.quiet);
      rendered = render(options, device, ready, view, settings, {[&](double done) { progress.report(done); }, &stop});
    }
    if (!stop) measureMore(options, device, ready, view, settings, stop, rendered.record);
    const double samples = rendered.record.image ? rendered.record.image->samplesDone : 0;
    if (stop && samples <= 0) {
      say("interrupted before the first sample of view {}: no image of it was written\n", view.name);
      return interrupted;
    }
    const Outputs files = outputsOf(options.files, ready.loaded.scene.name, view);
    writeOutputs(files, rendered, options.exposure);
    if (!options.quiet) {
      printSummary(rendered.record, files.png.empty() ? "" : ", " + files.png);
      printPicture(options, ready, rendered.record);
    }
    if (stop && samples < settings.spp) {
      say("interrupted: {} holds {:.4g} of {} samples a pixel\n", files.exr, samples, settings.spp);
      return interrupted;
    }
  }
  return done;
}

}  // namespace

Command addRender(CommandLine& program) {
  CommandLine command = program.addCommand("render", "Scene in, EXR and the time to image out");
  auto options = std::make_shared<RenderCommand>();
  options->add(command);
  return [options] { return run(*options); };
}

}  // namespace copse::cli
