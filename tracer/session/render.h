// The third step of a run: a view by an integrator, with its record. All measurements go through here, so that a render
// by hand and a benchmark time the same things.
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

/// Makes an integrator for a scene and a tree, which must outlive it and must not move; one that needs no tree ignores
/// `tree`. What it builds itself is timed. Throws InputError where it cannot use the tree.
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

/// `loaded` and `tree` are those that the integrator was made for. `from`, if not null, is what the render goes on
/// from; its integrator must take `resume`.
Rendered render(const ReadyIntegrator& ready, const Device& device, const LoadedScene& loaded, const BuiltTree& tree,
                const Camera& camera, const RenderSettings& settings, const Watch& watch = {},
                const FilmState* from = nullptr);

/// Nodes and triangles per ray of the same path render, which is repeated for it, more slowly and not timed. None for a
/// tracer that cannot count, and where it was stopped early.
std::optional<TraversalRecord> countTraversal(const Device& device, const LoadedScene& loaded, const BuiltTree& tree,
                                              const Camera& camera, const RenderSettings& settings,
                                              const Watch& watch = {});

}  // namespace copse
