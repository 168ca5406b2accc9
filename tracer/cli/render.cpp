// copse render: a scene in; an EXR, a preview, a record and the time to image out.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>

#include "builder/parallel/error.h"
#include "tracer/bench/run.h"
#include "tracer/cli/commands.h"
#include "tracer/cli/options.h"
#include "tracer/cli/print.h"
#include "tracer/cli/progress.h"
#include "tracer/cli/summary.h"
#include "tracer/image/image_io.h"
#include "tracer/scene/whole_file.h"

namespace copse::cli {

namespace {

struct Options {
  std::string scene, output, view, preview, stats, integrator = "path";
  float exposure = 0;
  bool quiet = false;
  RenderOptions render;
  BuilderOptions builder;
  DeviceOptions device;
};

/// The files of one view; what is not to be written is empty.
struct Outputs {
  std::string exr, png, json;
};

Outputs outputsOf(const Options& options, const std::string& sceneName, const View& view) {
  Outputs files{options.output, options.preview, options.stats};
  if (files.exr.empty()) {
    // A view that was asked for by name stays apart from the default one.
    std::string name = asFileName(sceneName);
    if (!options.view.empty() && options.view != "all") name += "-" + asFileName(view.name);
    files.exr = "out/" + name + ".exr";
    if (files.png.empty() && hasOpenImageIO()) files.png = "out/" + name + ".png";
  }
  if (options.view == "all")
    for (std::string* file : {&files.exr, &files.png, &files.json})
      if (!file->empty()) *file = withSuffix(*file, view.name);
  return files;
}

std::vector<NamedFile> namedOutputs(const Outputs& files) {
  return {{"-o", files.exr}, {"--preview", files.png}, {"--stats", files.json}};
}

void check(const Outputs& files) {
  checkOutput("-o", files.exr, ".exr");
  if (!files.png.empty()) checkOutput("--preview", files.png, ".png");
  checkWritable(files.json);
}

/// Everything that can be known to be wrong before a scene is read.
void checkEarly(const Options& options) {
  if (options.integrator != "path" && options.integrator != "reference")
    throw InputError(fmt::format("--integrator {}: path or reference", options.integrator));
  if (options.integrator == "reference" && options.device.device == "cuda")
    throw InputError("--integrator reference runs on the CPU alone: --device cpu");
  if (!(options.exposure >= -100 && options.exposure <= 100))
    throw InputError(fmt::format("--exposure {}: from -100 to 100 stops", options.exposure));
  checkPng("--preview", options.preview);
  if (options.output.empty()) {
    std::error_code error;
    std::filesystem::create_directories("out", error);
    if (error) throw InputError("out: " + error.message());
  } else if (options.view != "all") {
    checkApart(namedOutputs({options.output, options.preview, options.stats}), {{"SCENE", options.scene}});
    check({options.output, options.preview, options.stats});
  }
}

void tell(const Options& options, const Scene& scene) {
  if (!options.quiet)
    for (const std::string& note : scene.notes) say("note: {}\n", note);
  if (!options.quiet && options.output.empty() && !hasOpenImageIO())
    say("note: no preview is written, for PNG cannot be: {}\n", whyNoOpenImageIO());
  if (scene.emitterCount() == 0)
    say("warning: {}: there is no light, so the image will be black\n", options.scene);
}

std::vector<View> chosenViews(const Scene& scene, const std::string& name) {
  if (name == "all" && !scene.views.empty()) return scene.views;
  return {findView(scene, name)};
}

void write(const Options& options, const Outputs& files, Rendered& rendered) {
  rendered.record.image->file = files.exr;
  const std::string json = toJson(rendered.record);
  writeExr(files.exr, rendered.image, {{"copse", json}});
  if (!files.png.empty()) writePng(files.png, rendered.image, options.exposure);
  if (!files.json.empty()) writeWholeFile(files.json, json);
}

int run(const Options& options) {
  const RenderSettings settings = options.render.settings();
  const BuilderEntry& builder = options.builder.builder();
  const Parameters parameters = options.builder.parameters();
  checkEarly(options);
  const bool byReference = options.integrator == "reference";
  const Device chosen = options.builder.deviceFor(options.device, options.quiet);
  const Device device = byReference ? openDevice("cpu", chosen.threads) : chosen;
  const std::atomic<bool>& stop = stopOnSignal();

  const LoadedScene loaded = [&] {
    Progress progress("loading " + options.scene, options.quiet);
    return byReference ? loadForReference(options.scene) : loadForPaths(device, options.scene);
  }();
  tell(options, loaded.scene);
  const std::vector<View> views = chosenViews(loaded.scene, options.view);
  std::vector<NamedFile> outputs;
  for (const View& view : views)
    for (const NamedFile& file : namedOutputs(outputsOf(options, loaded.scene.name, view))) outputs.push_back(file);
  checkApart(outputs, {{"SCENE", options.scene}});
  for (const View& view : views) check(outputsOf(options, loaded.scene.name, view));

  BuiltTree tree;
  if (!byReference && !stop) {
    Progress progress(fmt::format("building {}", options.builder.name), options.quiet);
    tree = buildTree(device, loaded.triangles(), builder, parameters);
  }
  for (const View& view : views) {
    Rendered rendered;
    if (!stop) {
      Progress progress("rendering " + view.name, options.quiet);
      const Watch watch{[&](double done) { progress.report(done); }, &stop};
      rendered = byReference ? renderByReference(device, loaded, view, settings, watch)
                             : renderTree(device, loaded, tree, view, settings, watch);
    }
    const double samples = rendered.record.image ? rendered.record.image->samplesDone : 0;
    if (stop && samples <= 0) {
      say("interrupted before the first sample of view {}: no image of it was written\n", view.name);
      return interrupted;
    }
    const Outputs files = outputsOf(options, loaded.scene.name, view);
    write(options, files, rendered);
    if (!options.quiet) printSummary(rendered.record, files.png.empty() ? "" : ", " + files.png);
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
  options->builder.name = defaultBuilder();
  command->add_option("SCENE", options->scene, "Scene TOML, or a bare mesh (.obj, .ply)")->required();
  command->add_option("-o,--output", options->output, "FILE.exr; out/NAME.exr and a preview beside it by default")
      ->check(notEmpty);
  command->add_option("--view", options->view, "View's name, or all; the first by default")->check(notEmpty);
  options->render.add(*command);
  options->builder.add(*command);
  options->device.add(*command);
  command->add_option("--integrator", options->integrator, "path or reference")->capture_default_str();
  command->add_option("--preview", options->preview, "FILE.png: an sRGB preview")->check(notEmpty);
  command->add_option("--exposure", options->exposure, "Of the preview, in stops")->capture_default_str();
  command->add_option("--stats", options->stats, "FILE.json: the record of the run")->check(notEmpty);
  command->add_flag("--quiet", options->quiet, "Errors and warnings alone");
  return [options] { return run(*options); };
}

}  // namespace copse::cli
