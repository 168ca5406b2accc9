// The runner that measures: trees and renders by tracer/session, and a thumbnail of every view.
#pragma once

#include <map>
#include <set>

#include "tracer/bench/run_loop.h"
#include "tracer/session/render.h"

namespace copse {

class MeasuringRunner final : public Runner {
 public:
  /// Thumbnails go to the folder `images`; none are made where it is "" or PNG is not supported.
  MeasuringRunner(const Experiment& experiment, const Device& device, std::string images)
      : experiment_(experiment), device_(device), images_(std::move(images)) {}

  void load(std::size_t scene) override;
  /// Throws ValidationError where a tree that the experiment checks is invalid.
  Outcome run(const PlannedRun& run, const Watch& watch) override;
  void keep(const PlannedRun& run) override;

 private:
  /// Statistics of a row's first tree, which is validated if the experiment says so.
  TreeRecord firstRecord(const BuiltTree& tree) const;
  std::optional<TraversalRecord> counted(const PlannedRun& run, const BuiltTree& tree, const Camera& camera,
                                         const Watch& watch);

  const Experiment& experiment_;
  Device device_;
  std::string images_;
  LoadedScene loaded_;
  // For the loaded scene, per row, and per view and row: the same tree each time, and nearly the same rays.
  std::map<std::size_t, TreeRecord> trees_;
  std::map<std::pair<std::size_t, std::size_t>, TraversalRecord> traversals_;
  Image image_;  // The last run's.
};

/// DIR/images/SCENE-VIEW.png.
std::string pictureName(const std::string& folder, const std::string& scene, const std::string& view);

/// Box-filters `image` down to `width`; an image that is no wider is unchanged.
Image boxFiltered(const Image& image, int width);

}  // namespace copse
