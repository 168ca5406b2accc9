// The buffers that were rendered, their channels, and their numbers as colours of a screen.
#include "tracer/session/pictures.h"

#include <algorithm>
#include <cmath>

#include "builder/metrics/sah_costs.h"
#include "tracer/image/colour.h"
#include "tracer/image/compare.h"
#include "tracer/integrators/clusters.h"
#include "tracer/integrators/heatmap.h"
#include "tracer/session/timed.h"

namespace copse {

namespace {

double samplesAPixel(uint64_t samples, const RenderSettings& settings) {
  return static_cast<double>(samples) / settings.width / settings.height;
}

RunRecord startRecord(const Device& device, const LoadedScene& scene, const BuiltTree& tree) {
  RunRecord record = recordOf(device, scene);
  tree.describe(device, record);
  return record;
}

/// -1 … 1 as 0 … 1 of a screen.
Image normalsOnScreen(const Image& normals) {
  Image shown = normals;
  for (vec3& pixel : shown.pixels)
    for (int c = 0; c < 3; ++c) pixel[c] = linearOfScreen((pixel[c] + 1) / 2);
  return shown;
}

/// What is nearest is white, what is farthest dark grey, and nothing is black.
Image depthOnScreen(const std::vector<float>& depth, int width, int height) {
  float nearest = INFINITY, farthest = 0;
  for (const float z : depth) {
    if (!std::isfinite(z)) continue;
    nearest = std::min(nearest, z);
    farthest = std::max(farthest, z);
  }
  const float range = farthest > nearest ? farthest - nearest : 1;
  Image shown{width, height, {}};
  for (const float z : depth)
    shown.pixels.push_back(vec3(std::isfinite(z) ? linearOfScreen(1 - 0.85f * (z - nearest) / range) : 0));
  return shown;
}

Image depthAsImage(const std::vector<float>& depth, int width, int height) {
  Image image{width, height, {}};
  for (const float z : depth) image.pixels.push_back(vec3(std::isfinite(z) ? z : 0));
  return image;
}

}  // namespace

Rendered renderSurfacePicture(const Device& device, const LoadedScene& scene, const BuiltTree& tree, const View& view,
                              const RenderSettings& settings, SurfacePicture which, bool all, const Watch& watch) {
  static constexpr const char* names[] = {"normals", "albedo", "depth"};
  static constexpr const char* layers[] = {"N.", "albedo.", "Z"};
  const int index = static_cast<int>(which);
  Rendered rendered;
  RunRecord& record = rendered.record;
  record = startRecord(device, scene, tree);
  SurfaceResult result;
  record.renderMs = timed(device, record.renderPhases, [&](const Device& recording) {
    result = renderSurfaces(recording, scene.forPaths().view(), *tree.tracer, view, settings, watch);
  });
  record.image = ImageRecord{"", view.name, names[index], settings, samplesAPixel(result.samples, settings)};
  record.rays = RayCounts{result.samples, 0, 0};
  rendered.channels = channelsOf(result.buffers);
  if (!all)
    std::erase_if(rendered.channels, [&](const Channel& channel) { return !channel.name.starts_with(layers[index]); });
  if (which == SurfacePicture::normals) {
    rendered.preview = normalsOnScreen(result.buffers.normals);
    rendered.image = std::move(result.buffers.normals);
  } else if (which == SurfacePicture::albedo) {
    rendered.image = std::move(result.buffers.albedo);
  } else {
    rendered.image = depthAsImage(result.buffers.depth, settings.width, settings.height);
    rendered.preview = depthOnScreen(result.buffers.depth, settings.width, settings.height);
  }
  return rendered;
}

Rendered renderHeatmap(const Device& device, const LoadedScene& scene, const BuiltTree& tree, const View& view,
                       const RenderSettings& settings, double most, const Watch& watch) {
  Rendered rendered;
  RunRecord& record = rendered.record;
  record = startRecord(device, scene, tree);
  StepBuffers steps;
  record.renderMs = timed(device, record.renderPhases, [&](const Device& recording) {
    steps = countSteps(recording, *tree.tracer->stepTracer(), view, settings, watch);
  });
  const auto [node, triangle] = sahCostsOf(*tree.parameters);
  std::vector<double> cost(steps.nodes.size());
  for (std::size_t i = 0; i < cost.size(); ++i) cost[i] = node * steps.nodes[i] + triangle * steps.triangles[i];
  const double largest = *std::ranges::max_element(cost), scale = most > 0 ? most : largest;
  rendered.image = {settings.width, settings.height, {}};
  for (const double c : cost)
    rendered.image.pixels.push_back(heatColour(scale > 0 ? static_cast<float>(c / scale) : 0));
  record.image = ImageRecord{"", view.name, "heatmap", settings, samplesAPixel(steps.samples, settings)};
  record.image->figures = {
      {"mean_cost", node * steps.meanNodes + triangle * steps.meanTriangles}, {"max_cost", largest}, {"scale", scale}};
  record.rays = RayCounts{steps.samples, 0, 0};
  record.traversal = TraversalRecord{};
  record.traversal->primary = TraversalCounts{steps.meanNodes, steps.meanTriangles};
  record.traversal->countedBy = "each ray by itself, a node at a time, the nearer child first";
  rendered.channels = {{"nodes", std::move(steps.nodes)}, {"triangles", std::move(steps.triangles)}};
  return rendered;
}

BuiltClusters buildClusters(const Device& device, const TrianglesView& triangles, const BuiltTree& tree, int level) {
  BuiltClusters built;
  if (triangles.count == 0) return built;
  std::vector<PhaseTime> phases;
  built.ms = timed(device, phases, [&](const Device& recording) {
    const OwnedPrimitives primitives = primitivesOf(recording, triangles);
    built.clusters = tree.source.builder().method->passClusters(recording, primitives.view(), *tree.parameters,
                                                                static_cast<uint32_t>(level));
  });
  return built;
}

Rendered renderClusterPicture(const Device& device, const LoadedScene& scene, const BuiltTree& tree,
                              const BuiltClusters& built, const View& view, const RenderSettings& settings,
                              const Watch& watch) {
  Rendered rendered;
  RunRecord& record = rendered.record;
  record = startRecord(device, scene, tree);
  record.buildMs += built.ms;
  record.buildPhases.push_back({"clusters of a pass", built.ms});
  ClusterPicture picture;
  record.renderMs = timed(device, record.renderPhases, [&](const Device& recording) {
    picture =
        renderClusters(recording, scene.forPaths().view(), *tree.tracer, built.clusters, view, settings, true, watch);
  });
  record.image = ImageRecord{"", view.name, "clusters", settings, samplesAPixel(picture.samples, settings)};
  record.image->figures = {{"cluster_level", built.clusters.level},
                           {"clusters", static_cast<double>(built.clusters.representatives.size())}};
  record.rays = RayCounts{picture.samples, 0, 0};
  rendered.image = std::move(picture.image);
  rendered.channels.push_back({"cluster", std::move(picture.cluster)});
  return rendered;
}

}  // namespace copse
