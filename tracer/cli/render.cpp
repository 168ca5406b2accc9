// copse render: a scene in; an EXR, a preview, a record and the time to image out.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <memory>
#include <optional>

#include "builder/parallel/error.h"
#include "tracer/bench/pictures.h"
#include "tracer/cli/commands.h"
#include "tracer/cli/options.h"
#include "tracer/cli/print.h"
#include "tracer/cli/progress.h"
#include "tracer/cli/render_files.h"
#include "tracer/cli/summary.h"
#include "tracer/image/image_io.h"
#include "tracer/inspect/clusters.h"

namespace copse::cli {

namespace {

struct Options {
  RenderFiles files;
  float exposure = 0;
  bool aov = false, quiet = false, countTraversal = false, endPointOverlap = false;
  int clusterLevel = 1;
  RenderOptions render;
  BuilderOptions builder;
  DeviceOptions device;

  const std::string& integrator() const { return files.integrator; }
};

constexpr const char* integrators[] = {"path", "reference", "normals", "albedo", "depth", "clusters"};

/// The picture of a surface buffer that the integrator's name asks for.
std::optional<SurfacePicture> surfacePicture(const std::string& integrator) {
  if (integrator == "normals") return SurfacePicture::normals;
  if (integrator == "albedo") return SurfacePicture::albedo;
  if (integrator == "depth") return SurfacePicture::depth;
  return {};
}

bool rendersLight(const std::string& integrator) { return integrator == "path" || integrator == "reference"; }

/// What is wrong with an option by itself, or with two that do not go together.
void checkOptions(const Options& options, const BuilderEntry& builder, bool levelGiven) {
  const std::string& integrator = options.integrator();
  if (std::ranges::find(integrators, integrator) == std::end(integrators))
    throw InputError(fmt::format("--integrator {}: {}", integrator, fmt::join(integrators, ", ")));
  if (integrator == "reference" && options.device.device == "cuda")
    throw InputError("--integrator reference runs on the CPU alone: --device cpu");
  if (options.aov && integrator != "path" && !surfacePicture(integrator))
    throw InputError(fmt::format("--aov does not go with --integrator {}", integrator));
  if (integrator == "clusters" && !isKmeans(builder))
    throw InputError(fmt::format("--integrator clusters shows clusters of k-means: --builder {} makes none", builder.name));
  if (levelGiven && integrator != "clusters") throw InputError("--cluster-level goes with --integrator clusters");
  if (options.clusterLevel < 1)
    throw InputError(fmt::format("--cluster-level {}: 1 or more", options.clusterLevel));
  for (const auto& [asked, name] : {std::pair{options.countTraversal, "--count-traversal"},
                                    std::pair{options.endPointOverlap, "--end-point-overlap"}}) {
    if (!asked) continue;
    if (integrator != "path") throw InputError(fmt::format("{}: only with --integrator path", name));
    if (isPeer(builder))
      throw InputError(fmt::format("{}: the tree of {} is not looked into", name, builder.name));
  }
  if (!(options.exposure >= -100 && options.exposure <= 100))
    throw InputError(fmt::format("--exposure {}: from -100 to 100 stops", options.exposure));
  if (options.exposure != 0 && !rendersLight(integrator))
    throw InputError(fmt::format("--exposure does not go with --integrator {}", integrator));
}

void tell(const Options& options, const Scene& scene) {
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

Ready prepare(const Options& options, const Device& device, LoadedScene loaded, const BuilderEntry& builder,
              const Parameters& parameters) {
  Ready ready{std::move(loaded), {}, {}};
  if (options.integrator() == "reference") return ready;
  Progress progress(fmt::format("building {}", options.builder.name), options.quiet);
  ready.tree = buildTree(device, ready.loaded.triangles(), builder, parameters);
  if (options.integrator() != "clusters") return ready;
  ready.clusters = buildClusters(device, ready.loaded.triangles(), ready.tree, options.clusterLevel);
  return ready;
}

Rendered render(const Options& options, const Device& device, const Ready& ready, const View& view,
                const RenderSettings& settings, const Watch& watch) {
  const std::string& integrator = options.integrator();
  if (integrator == "reference") return renderByReference(device, ready.loaded, view, settings, watch);
  if (integrator == "clusters")
    return renderClusterPicture(device, ready.loaded, ready.tree, ready.clusters, view, settings, watch);
  if (const auto picture = surfacePicture(integrator))
    return renderSurfacePicture(device, ready.loaded, ready.tree, view, settings, *picture, options.aov, watch);
  return renderTree(device, ready.loaded, ready.tree, view, settings, watch, options.aov);
}

/// What there is to say of a picture that is no image of light.
void printPicture(const Options& options, const Ready& ready) {
  if (options.integrator() != "clusters") return;
  const KmeansClusters& clusters = ready.clusters.clusters;
  const std::size_t count = clusters.representatives.size();
  print("clusters      {} after pass {}{}\n", grouped(count), clusters.level,
        static_cast<int>(clusters.level) < options.clusterLevel ? ", the last" : "");
  if (count > mostBoxesDrawn) print("              the boxes of more than {} are not drawn\n", mostBoxesDrawn);
}

/// What is measured on demand, after what is timed.
void measureMore(const Options& options, const Device& device, const Ready& ready, const View& view,
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

int run(const Options& options, bool levelGiven) {
  const RenderSettings settings = options.render.settings();
  const BuilderEntry& builder = options.builder.builder();
  const Parameters parameters = options.builder.parameters();
  checkOptions(options, builder, levelGiven);
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
  if (!stop) ready = prepare(options, device, std::move(loaded), builder, parameters);
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
      printPicture(options, ready);
    }
    if (stop && samples < settings.spp) {
      say("interrupted: {} holds {:.4g} of {} samples a pixel\n", files.exr, samples, settings.spp);
      return interrupted;
    }
  }
  return done;
}

}  // namespace

Command addRender(CLI::App& program) {
  CLI::App* command = program.add_subcommand("render", "Scene in, EXR and the time to image out");
  auto options = std::make_shared<Options>();
  RenderFiles& files = options->files;
  options->builder.name = defaultBuilder();
  command->add_option("SCENE", files.scene, "Scene TOML, or a bare mesh (.obj, .ply)")->required();
  command->add_option("-o,--output", files.output, "FILE.exr; out/NAME.exr and a preview beside it by default")
      ->check(notEmpty);
  command->add_option("--view", files.view, "View's name, or all; the first by default")->check(notEmpty);
  options->render.add(*command);
  options->builder.add(*command);
  options->device.add(*command);
  command->add_option("--integrator", files.integrator, fmt::format("{}", fmt::join(integrators, ", ")))
      ->capture_default_str();
  command->add_flag("--aov", options->aov, "Normals, albedo and depth as further channels of the EXR");
  const CLI::Option* level =
      command->add_option("--cluster-level", options->clusterLevel, "Of --integrator clusters: after which pass")
          ->capture_default_str();
  command->add_option("--preview", files.preview, "FILE.png: an sRGB preview")->check(notEmpty);
  command->add_option("--exposure", options->exposure, "Of the preview, in stops")->capture_default_str();
  command->add_option("--stats", files.stats, "FILE.json: the record of the run")->check(notEmpty);
  command->add_flag("--count-traversal", options->countTraversal,
                    "Nodes and triangles visited a ray, by a second render that is not timed");
  command->add_flag("--end-point-overlap", options->endPointOverlap,
                    "Of the tree, after Aila, Karras and Laine 2013; not timed");
  command->add_flag("--quiet", options->quiet, "Errors and warnings alone");
  return [options, level] { return run(*options, level->count() > 0); };
}

}  // namespace copse::cli
