// The runner that measures: trees and renders by way of tracer/session, and a small picture of every view.
#pragma once

#include <map>
#include <set>

#include "tracer/bench/run_loop.h"
#include "tracer/session/render.h"

namespace copse {

class MeasuringRunner final : public Runner {
 public:
  /// Pictures go to the folder `images`; none are made where it is "" or PNG cannot be written.
  MeasuringRunner(const Experiment& experiment, const Device& device, std::string images)
      : experiment_(experiment), device_(device), images_(std::move(images)) {}

  void load(std::size_t scene) override;
  /// Throws ValidationError where a tree that the experiment has checked is not sound.
  Outcome run(const PlannedRun& run, const Watch& watch) override;
  void keep(const PlannedRun& run) override;

 private:
  /// What is known of a row's first tree, which is checked where the experiment asks for it.
  TreeRecord firstRecord(const BuiltTree& tree) const;
  std::optional<TraversalRecord> counted(const PlannedRun& run, const BuiltTree& tree, const Camera& camera,
                                         const Watch& watch);

  const Experiment& experiment_;
  Device device_;
  std::string images_;
  LoadedScene loaded_;
  // Of the loaded scene, by row, and by view and row: the same tree each time, and nearly the same rays.
  std::map<std::size_t, TreeRecord> trees_;
  std::map<std::pair<std::size_t, std::size_t>, TraversalRecord> traversals_;
  Image image_;  // Of the last run.
};

/// DIR/images/SCENE-VIEW.png.
std::string pictureName(const std::string& folder, const std::string& scene, const std::string& view);

/// The mean of the pixels that each pixel of a smaller image covers; as it is where it is no wider than `width`.
Image boxFiltered(const Image& image, int width);

}  // namespace copse
