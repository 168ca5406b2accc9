// The clusters of a pass of the builder as colours.
#include <fmt/format.h>

#include "builder/base/text.h"
#include "builder/build.h"
#include "builder/parallel/timed.h"
#include "tracer/integrators/clusters/clusters.h"
#include "tracer/integrators/integrator.h"

namespace copse {

namespace {

constexpr IntegratorOption clusterLevel{
    "cluster-level", "after which pass of k-means, the first by default", "from 1 to 100", true, 1, 100};

class ClustersIntegrator final : public Integrator {
 public:
  ClustersIntegrator(const Device& device, const IntegratorInput& input, const IntegratorOptions& options)
      : scene_(*input.onDevice),
        tracer_(*input.tracer),
        level_(static_cast<uint32_t>(options.value(clusterLevel).value_or(1))) {
    const TrianglesView triangles = scene_.triangles();
    if (triangles.count == 0) return;
    std::vector<PhaseTime> parts;
    buildMs_ = timed(device, parts, [&](const Device& recording) {
      const OwnedPrimitives primitives = primitivesOf(recording, triangles);
      clusters_ = input.builder->method->passClusters(recording, primitives.view(), *input.parameters, level_);
    });
  }

  Picture render(const Device& device, const Camera& camera, const RenderSettings& settings,
                 const Watch& watch) const override {
    Picture picture;
    picture.buildMs = buildMs_;
    picture.buildPhases = {{phases::passClusters.text, buildMs_, 0, phases::passClusters.group}};
    ClusterPicture shown;
    picture.renderMs = timed(device, picture.renderPhases, [&](const Device& recording) {
      shown = renderClusters(recording, scene_.view(), tracer_, clusters_, camera, settings, true, watch);
    });
    picture.samplesDone = static_cast<double>(shown.samples) / settings.width / settings.height;
    picture.rays.primary = shown.samples;
    const std::size_t count = clusters_.representatives.size();
    picture.figures = {{"cluster_level", clusters_.level}, {"clusters", static_cast<double>(count)}};
    picture.remarks = fmt::format("\nclusters {} after pass {}{}\n", grouped(count), clusters_.level,
                                  clusters_.level < level_ ? ", the last" : "");
    if (count > maxBoxesDrawn)
      picture.remarks += fmt::format("         without boxes: at most {} are drawn\n", grouped(maxBoxesDrawn));
    picture.image = std::move(shown.image);
    picture.channels.push_back({channelNames[0], std::move(shown.cluster)});
    return picture;
  }

  static constexpr const char* channelNames[] = {"cluster"};

 private:
  const SceneOnDevice& scene_;
  const TreeTracer& tracer_;
  uint32_t level_;  ///< As requested.
  PassClusters clusters_;
  double buildMs_ = 0;
};

constexpr PhaseName phaseNames[] = {phases::generate, phases::tracePrimary, phases::clusters};
constexpr const IntegratorOption* ownOptions[] = {&clusterLevel};

}  // namespace

extern const IntegratorEntry clustersIntegrator;
constinit const IntegratorEntry clustersIntegrator{
    .name = "clusters",
    .meaning = "the clusters of a k-means pass",
    .tree = TreeUse::clusters,
    .options = ownOptions,
    .channels = ClustersIntegrator::channelNames,
    .phases = phaseNames,
    .make = [](const Device& device, const IntegratorInput& input, const IntegratorOptions& options)
        -> std::unique_ptr<const Integrator> { return std::make_unique<ClustersIntegrator>(device, input, options); }};

}  // namespace copse
