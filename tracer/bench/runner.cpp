// One scene in memory at a time, one tree at a time.
#include "tracer/bench/runner.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "builder/base/error.h"
#include "builder/build.h"
#include "tracer/image/image_io.h"
#include "tracer/session/machine.h"

namespace copse {

namespace {

constexpr int pictureWidth = 320;

/// The mean over [from, from + step) of the values of a row, the first and the last weighted by the part covered.
struct Span {
  int first, last;
  double firstWeight, lastWeight;
};
Span spanOf(int i, double step, int size) {
  const double from = i * step, to = std::min((i + 1) * step, static_cast<double>(size));
  const int first = static_cast<int>(from), last = std::min(static_cast<int>(std::ceil(to)) - 1, size - 1);
  if (first == last) return {first, last, to - from, 0};
  return {first, last, first + 1 - from, to - last};
}

template <class Add>
void over(const Span& span, Add add) {
  add(span.first, span.firstWeight);
  for (int i = span.first + 1; i < span.last; ++i) add(i, 1.0);
  if (span.last > span.first) add(span.last, span.lastWeight);
}

}  // namespace

Image boxFiltered(const Image& image, int width) {
  if (image.width <= width) return image;
  const double step = static_cast<double>(image.width) / width;
  Image small;
  small.width = width;
  small.height = std::max(1, static_cast<int>(std::lround(image.height / step)));
  small.pixels.resize(static_cast<std::size_t>(small.width) * small.height);
  const double rowStep = static_cast<double>(image.height) / small.height;
  for (int y = 0; y < small.height; ++y)
    for (int x = 0; x < small.width; ++x) {
      glm::dvec3 sum(0);
      double weight = 0;
      over(spanOf(y, rowStep, image.height), [&](int row, double rowWeight) {
        over(spanOf(x, step, image.width), [&](int column, double columnWeight) {
          sum += rowWeight * columnWeight * glm::dvec3(image.at(column, row));
          weight += rowWeight * columnWeight;
        });
      });
      small.at(x, y) = vec3(sum / weight);
    }
  return small;
}

std::string pictureName(const std::string& folder, const std::string& scene, const std::string& view) {
  std::string name = scene + "-" + view;
  for (char& c : name)
    if (c == '/' || c == '\\' || static_cast<unsigned char>(c) < ' ') c = '_';
  return folder + "/" + name + ".png";
}

void MeasuringRunner::load(std::size_t scene) {
  loaded_ = LoadedScene{};
  trees_.clear();
  traversals_.clear();
  const ExperimentScene& source = experiment_.scenes[scene];
  const LoadFor purpose = experiment_.renders() ? loadFor(measuredIntegrator()) : LoadFor::builds;
  loaded_ = copse::load(
      device_, [&] { return source.read(); }, purpose);
}

Runner::Outcome MeasuringRunner::run(const PlannedRun& run, const Watch& watch) {
  const ExperimentScene& scene = experiment_.scenes[run.scene];
  const ExperimentBuilder& row = experiment_.builders[run.builder];
  const auto stopped = [&] { return watch.stop && *watch.stop; };
  startProcessPeak();
  BuiltTree tree = buildTree(device_, loaded_.triangles(), row.source, row.parameters, row.optimisers, row.tracer);
  if (!trees_.contains(run.builder)) trees_[run.builder] = firstRecord(tree);
  tree.known = trees_[run.builder];
  if (run.spp == 0) {
    Outcome outcome{recordOf(device_, loaded_), true};
    describe(device_, tree, outcome.record);
    outcome.complete = !stopped();
    return outcome;
  }
  if (stopped()) return {{}, false};
  RenderSettings settings = experiment_.settings;
  settings.spp = run.spp;
  const Camera& camera = findCamera(loaded_.scene, scene.views[run.view]);
  const ReadyIntegrator integrator = makeReady(measuredIntegrator(), device_, loaded_, tree);
  Rendered rendered = render(integrator, device_, loaded_, tree, camera, settings, watch);
  image_ = std::move(rendered.picture.image);
  const bool measured = run.repetition > 0 && rendered.record.image->samplesDone >= run.spp;
  if (measured && experiment_.countTraversal) rendered.record.traversal = counted(run, tree, camera, watch);
  return {std::move(rendered.record), rendered.record.image->samplesDone >= run.spp && !stopped()};
}

TreeRecord MeasuringRunner::firstRecord(const BuiltTree& tree) const {
  const bool asked =
      experiment_.validated == Checked::rows || (experiment_.validated == Checked::scenes && trees_.empty());
  if (asked && !tree.source.isOwnTree())
    validate(device_, tree.bvh, loaded_.triangles(), static_cast<uint32_t>(tree.parameters->integer("leaf.max")));
  TreeRecord record = treeRecord(device_, tree);
  if (experiment_.endPointOverlap) record.endPointOverlap = endPointOverlapOf(device_, loaded_.triangles(), tree);
  return record;
}

std::optional<TraversalRecord> MeasuringRunner::counted(const PlannedRun& run, const BuiltTree& tree,
                                                        const Camera& camera, const Watch& watch) {
  const auto key = std::pair(run.view, run.builder);
  if (const auto known = traversals_.find(key); known != traversals_.end()) return known->second;
  RenderSettings settings = experiment_.settings;
  settings.spp = experiment_.spp.front();
  std::optional<TraversalRecord> record = countTraversal(device_, loaded_, tree, camera, settings, {{}, watch.stop});
  if (!record) return std::nullopt;
  record->countedBy += fmt::format("; {} samples per pixel", settings.spp);
  traversals_[key] = *record;
  return record;
}

void MeasuringRunner::keep(const PlannedRun& run) {
  if (images_.empty() || run.spp == 0 || run.spp != experiment_.spp.back() || !hasOpenImageIO()) return;
  const ExperimentScene& scene = experiment_.scenes[run.scene];
  const std::string file = pictureName(images_, scene.name, scene.views[run.view]);
  std::error_code error;
  if (std::filesystem::exists(file, error)) return;
  std::filesystem::create_directories(images_, error);
  writePng(file, boxFiltered(image_, pictureWidth));
}

}  // namespace copse
