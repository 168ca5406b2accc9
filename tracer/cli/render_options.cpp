// Declared, and checked before anything is read.
#include "tracer/cli/render_options.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "builder/base/error.h"

namespace copse::cli {

namespace {

constexpr const char* integrators[] = {"path", "reference", "normals", "albedo", "depth", "heatmap", "clusters"};

std::vector<const char*> methodsWithClusters() {
  std::vector<const char*> names;
  for (const Method& method : methods::all())
    if (method.passClusters) names.push_back(method.name);
  return names;
}

}  // namespace

std::optional<SurfacePicture> surfacePicture(const std::string& integrator) {
  if (integrator == "normals") return SurfacePicture::normals;
  if (integrator == "albedo") return SurfacePicture::albedo;
  if (integrator == "depth") return SurfacePicture::depth;
  return {};
}

bool rendersLight(const std::string& integrator) { return integrator == "path" || integrator == "reference"; }

void RenderCommand::add(CommandLine& command) {
  builder.name = defaultBuilder();
  command.option("SCENE", files.scene, "Scene TOML, or a bare mesh (.obj, .ply)").required();
  command.option("-o,--output", files.output, "FILE.exr; out/NAME.exr and a preview beside it by default").notEmpty();
  command.option("--view", files.view, "View's name, or all; the first by default").notEmpty();
  render.add(command);
  builder.add(command);
  device.add(command);
  command.option("--integrator", files.integrator, fmt::format("{}", fmt::join(integrators, ", "))).showDefault();
  command.flag("--aov", aov, "Normals, albedo and depth as further channels of the EXR");
  command.option("--cluster-level", clusterLevel,
                 "Of --integrator clusters: after which pass of k-means, the first by default");
  command.option("--heat-max", heatMax, "Of --integrator heatmap: the cost of the last colour, the largest by default");
  command.option("--preview", files.preview, "FILE.png: an sRGB preview").notEmpty();
  command.option("--exposure", exposure, "Of the preview, in stops").showDefault();
  command.option("--stats", files.stats, "FILE.json: the record of the run").notEmpty();
  command.flag("--count-traversal", countTraversal,
               "Nodes and triangles visited a ray, by a second render that is not timed");
  command.flag("--end-point-overlap", endPointOverlap, "Of the tree, after Aila, Karras and Laine 2013; not timed");
  command.flag("--quiet", quiet, "Errors and warnings alone");
}

void RenderCommand::check(const TreeSource& chosen) const {
  if (std::ranges::find(integrators, integrator()) == std::end(integrators))
    throw InputError(fmt::format("--integrator {}: {}", integrator(), fmt::join(integrators, ", ")));
  if (integrator() == "reference" && device.device == "cuda")
    throw InputError("--integrator reference runs on the CPU alone: --device cpu");
  const auto notWith = [&](const char* option) {
    throw InputError(fmt::format("{} does not go with --integrator {}", option, integrator()));
  };
  if (aov && integrator() != "path" && !surfacePicture(integrator())) notWith("--aov");
  if (clusterLevel && integrator() != "clusters") notWith("--cluster-level");
  if (heatMax && integrator() != "heatmap") notWith("--heat-max");
  if (countTraversal && integrator() != "path") notWith("--count-traversal");
  if (endPointOverlap && integrator() != "path") notWith("--end-point-overlap");
  if (exposure != 0 && !std::isnan(exposure) && !rendersLight(integrator())) notWith("--exposure");
  if (integrator() == "clusters" && (chosen.isOwnTree() || !chosen.builder().method->passClusters))
    throw InputError(fmt::format("--integrator clusters: --builder {} makes no clusters; {} and its presets do",
                                 chosen.name(), fmt::join(methodsWithClusters(), ", ")));
  for (const auto& [asked, option] :
       {std::pair{countTraversal, "--count-traversal"}, std::pair{endPointOverlap, "--end-point-overlap"},
        std::pair{integrator() == "heatmap", "--integrator heatmap"}})
    if (asked && chosen.isOwnTree())
      throw InputError(fmt::format("{}: the tree of {} is not looked into", option, chosen.name()));
  if (clusterLevel && (*clusterLevel < 1 || *clusterLevel > 100))
    throw InputError(fmt::format("--cluster-level {}: from 1 to 100", *clusterLevel));
  if (heatMax && !(*heatMax > 0 && *heatMax < 1e9))
    throw InputError(fmt::format("--heat-max {}: above 0 and below 1e9", *heatMax));
  if (!(exposure >= -100 && exposure <= 100))
    throw InputError(fmt::format("--exposure {}: from -100 to 100 stops", exposure));
}

}  // namespace copse::cli
