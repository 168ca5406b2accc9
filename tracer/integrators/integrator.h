// What an integrator is to everybody else: one descriptor, in its own folder here. registry.cpp has the list of all.
// The command line's options, checks and errors, names of files, records and reports follow from it.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "builder/parallel/timeline.h"
#include "tracer/accel/tracers.h"
#include "tracer/image/image_io.h"
#include "tracer/integrators/path/scene_on_device.h"
#include "tracer/integrators/settings.h"

namespace copse {

/// An option that an integrator has for itself. It is known by its address.
struct IntegratorOption {
  const char* name;  ///< "heat-max", on the command line --heat-max.
  const char* meaning;
  const char* range;  ///< "from 1 to 100"
  bool isInteger;
  double min, max;  ///< Integers may be these too; a real number lies between them.

  bool accepts(double value) const { return isInteger ? value >= min && value <= max : value > min && value < max; }
};

/// What was asked for. Options that are not there have their defaults, which the integrator knows.
struct IntegratorOptions {
  bool aov = false;  ///< Normals, albedo and depth as further channels.
  std::map<const IntegratorOption*, double> own = {};

  std::optional<double> value(const IntegratorOption& option) const {
    const auto found = own.find(&option);
    return found == own.end() ? std::nullopt : std::optional(found->second);
  }
};

/// Which options of all renders an integrator takes.
struct TakenOptions {
  bool aov = false, countTraversal = false, endPointOverlap = false, exposure = false;
};

/// What it needs of a tree.
enum class TreeUse {
  none,      ///< No tree, and no scene on the device either: it reads the Scene.
  traced,    ///< Rays go through it, whatever it is.
  counted,   ///< What rays visit is counted: a builder's tree, not one that a tracer builds for itself.
  clusters,  ///< A builder's tree whose method has clusters to show (see hasClusters()).
};

/// What an integrator renders from. All of it must outlive the integrator. With TreeUse::none there is the scene alone;
/// with TreeUse::traced `builder` and `parameters` may be null, which says that the tree is a tracer's own.
struct IntegratorInput {
  const Scene& scene;
  const SceneOnDevice* onDevice = nullptr;
  const TreeTracer* tracer = nullptr;
  const BuilderEntry* builder = nullptr;
  const Parameters* parameters = nullptr;  ///< The builder's preset applied.
};

/// What a render of one view gives. Times in milliseconds; images and channels row by row.
struct Picture {
  Image image;
  std::vector<Channel>
      channels;   ///< Further ones, for the EXR: those that the descriptor declares, and with --aov more.
  Image preview;  ///< For a screen, where the image itself is not; empty otherwise.

  double samplesDone = 0;  ///< Per pixel; less than settings.spp where it was stopped.
  RayCounts rays;
  double renderMs = 0;
  std::vector<PhaseTime> renderPhases;
  double buildMs = 0;  ///< What the integrator built for itself when it was made: part of the build's time.
  std::vector<PhaseTime> buildPhases;

  std::vector<std::pair<std::string, double>> figures;  ///< What else there is to say of the picture, by name.
  std::optional<TraversalRecord> traversal;             ///< Where counting is what the picture is made of.
  std::string remarks;                                  ///< For a person, after the summary: whole lines, or "".
};

/// An integrator made ready for a scene and a tree.
class Integrator {
 public:
  virtual ~Integrator() = default;
  /// On `device`, which is the one that it was made for; an integrator with `onCpuOnly` takes as many threads as it
  /// has. The image so far where it was stopped. Throws InputError for settings or a view that nothing can be rendered
  /// with.
  virtual Picture render(const Device& device, const Camera& camera, const RenderSettings& settings,
                         const Watch& watch) const = 0;
};

struct IntegratorEntry {
  const char* name;
  const char* meaning;  ///< One line.
  TreeUse tree = TreeUse::traced;
  bool rendersLight = false;  ///< Its images are of light: without any in the scene they are black.
  bool onCpuOnly = false;
  TakenOptions takes = {};
  std::span<const IntegratorOption* const> options = {};  ///< Its own.
  std::span<const char* const> channels = {};             ///< Further channels that its files have in any case.
  std::span<const PhaseName> phases = {};                 ///< That a render may have, in the order of their first use.
  /// The device is the one that renders. Throws DeviceError.
  std::unique_ptr<const Integrator> (*make)(const Device& device, const IntegratorInput& input,
                                            const IntegratorOptions& options) = nullptr;
};

}  // namespace copse
