// The cost of camera rays as colours.
#include <fmt/format.h>

#include <algorithm>

#include "builder/metrics/sah_costs.h"
#include "builder/parallel/timed.h"
#include "tracer/accel/counting.h"
#include "tracer/image/compare.h"
#include "tracer/integrators/heatmap/heatmap.h"
#include "tracer/integrators/integrator.h"

namespace copse {

namespace {

constexpr IntegratorOption heatMax{
    "heat-max", "the cost of the last colour; the picture's maximum by default", "above 0 and below 1e9", false, 0,
    1e9};

/// The legend of the colours.
std::string scaleInWords(double mean, double largest, double scale) {
  std::string text = fmt::format("{:<28}{:>12.2f}, maximum per pixel {:.2f}\n", "  cost, mean", mean, largest);
  static constexpr const char* colours[] = {"black", "indigo", "purple", "red", "orange", "pale yellow"};
  text += fmt::format("{:<9}", "\ncolours");
  for (int i = 0; i < 6; ++i) text += fmt::format("{}{} {:.4g}", i ? ", " : " ", colours[i], scale * i / 5);
  return text + "\n";
}

class HeatmapIntegrator final : public Integrator {
 public:
  HeatmapIntegrator(const IntegratorInput& input, const IntegratorOptions& options)
      : tracer_(*input.tracer->stepTracer()),
        costs_(sahCostsOf(*input.parameters)),
        max_(options.value(heatMax).value_or(0)) {}

  Picture render(const Device& device, const Camera& camera, const RenderSettings& settings,
                 const Watch& watch) const override {
    Picture picture;
    StepBuffers steps;
    picture.renderMs = timed(device, picture.renderPhases, [&](const Device& recording) {
      steps = countSteps(recording, tracer_, camera, settings, watch);
    });
    std::vector<double> cost(steps.nodes.size());
    for (std::size_t i = 0; i < cost.size(); ++i)
      cost[i] = costs_.traversal * steps.nodes[i] + costs_.intersection * steps.triangles[i];
    const double largest = *std::ranges::max_element(cost), scale = max_ > 0 ? max_ : largest;
    picture.image = {settings.width, settings.height, {}};
    for (const double c : cost)
      picture.image.pixels.push_back(heatColour(scale > 0 ? static_cast<float>(c / scale) : 0));
    const double mean = costs_.traversal * steps.meanNodes + costs_.intersection * steps.meanTriangles;
    picture.figures = {{"mean_cost", mean}, {"max_cost", largest}, {"scale", scale}};
    picture.remarks = scaleInWords(mean, largest, scale);
    picture.samplesDone = static_cast<double>(steps.samples) / settings.width / settings.height;
    picture.rays.primary = steps.samples;
    picture.traversal = TraversalRecord{TraversalCounts{steps.meanNodes, steps.meanTriangles}, {}, {}, countedBy};
    picture.channels = {{channelNames[0], std::move(steps.nodes)}, {channelNames[1], std::move(steps.triangles)}};
    return picture;
  }

  static constexpr const char* channelNames[] = {"nodes", "triangles"};

 private:
  const StepTracer& tracer_;
  SahCosts costs_;
  double max_;  ///< The cost of the last colour; 0 for the picture's maximum.
};

constexpr PhaseName phaseNames[] = {phases::generate, phases::countSteps, phases::addSteps};
constexpr const IntegratorOption* ownOptions[] = {&heatMax};

}  // namespace

extern const IntegratorEntry heatmapIntegrator;
constinit const IntegratorEntry heatmapIntegrator{
    .name = "heatmap",
    .meaning = "the tree's cost per camera ray",
    .tree = TreeUse::counted,
    .options = ownOptions,
    .channels = HeatmapIntegrator::channelNames,
    .phases = phaseNames,
    .make = [](const Device&, const IntegratorInput& input, const IntegratorOptions& options)
        -> std::unique_ptr<const Integrator> { return std::make_unique<HeatmapIntegrator>(input, options); }};

}  // namespace copse
