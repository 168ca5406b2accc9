// The third step of a run: a view by an integrator, with its record. Whoever measures goes through here, so that a
// render by hand and a benchmark time the same things.
#pragma once

#include <memory>
#include <optional>

#include "tracer/integrators/integrator.h"
#include "tracer/session/build.h"
#include "tracer/session/load.h"

namespace copse {

/// The part of a record that is known before anything is built.
RunRecord recordOf(const Device& device, const LoadedScene& loaded);

/// What `integrator` needs a scene for.
LoadFor loadFor(const IntegratorEntry& integrator);

/// An integrator of a scene and a tree, which must outlive it and stay where they are; one that needs no tree leaves
/// `tree` alone. What it builds for itself is timed. Throws InputError where it cannot use the tree.
struct ReadyIntegrator {
  const IntegratorEntry* entry = nullptr;
  std::unique_ptr<const Integrator> integrator;
};
ReadyIntegrator makeReady(const IntegratorEntry& entry, const Device& device, const LoadedScene& loaded,
                          const BuiltTree& tree, const IntegratorOptions& options = {});

struct Rendered {
  Picture picture;
  RunRecord record;  ///< Without the image's file name, which only the writer knows.
};

/// `loaded` and `tree` are those that the integrator was made for.
Rendered render(const ReadyIntegrator& ready, const Device& device, const LoadedScene& loaded, const BuiltTree& tree,
                const Camera& camera, const RenderSettings& settings, const Watch& watch = {});

/// The nodes and triangles that rays visit in the same path render, which is done once more for it and slower; not
/// timed. None for a tracer that does not say, and where it was stopped before its end.
std::optional<TraversalRecord> countTraversal(const Device& device, const LoadedScene& loaded, const BuiltTree& tree,
                                              const Camera& camera, const RenderSettings& settings,
                                              const Watch& watch = {});

}  // namespace copse
