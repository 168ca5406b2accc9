// The interface of an integrator: one descriptor, in its own folder here. registry.cpp lists them all. The command
// line's options, checks and errors, file names, records and reports follow from it.
#pragma once

#include <map>
#include <memory>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "builder/parallel/timeline.h"
#include "tracer/accel/tracers.h"
#include "tracer/image/image_io.h"
#include "tracer/integrators/film_state.h"
#include "tracer/integrators/path/scene_on_device.h"
#include "tracer/integrators/settings.h"

namespace copse {

/// An integrator's own option. It is identified by its address.
struct IntegratorOption {
  const char* name;  ///< "heat-max", on the command line --heat-max.
  const char* meaning;
  const char* range;  ///< "from 1 to 100"
  bool isInteger;
  double min, max;  ///< Inclusive for integers, exclusive for real numbers.

  bool accepts(double value) const { return isInteger ? value >= min && value <= max : value > min && value < max; }
};

/// What was requested. Absent options have their defaults, which the integrator knows.
struct IntegratorOptions {
  bool aov = false;  ///< Normals, albedo and depth as further channels.
  std::map<const IntegratorOption*, double> own = {};

  std::optional<double> value(const IntegratorOption& option) const {
    const auto found = own.find(&option);
    return found == own.end() ? std::nullopt : std::optional(found->second);
  }
};

/// Which of the common options an integrator takes.
struct TakenOptions {
  bool aov = false, countTraversal = false, endPointOverlap = false, exposure = false, resume = false;
};

/// What it needs of a tree.
enum class TreeUse {
  none,      ///< No tree, and no scene on the device either: the integrator reads the Scene.
  traced,    ///< Rays go through it; any tree will do.
  counted,   ///< What rays visit is counted: a builder's tree, not one that a tracer builds for itself.
  clusters,  ///< A builder's tree whose method has clusters to show (see hasClusters()).
};

/// What an integrator renders from. All of it must outlive the integrator. With TreeUse::none only the scene is given;
/// with TreeUse::traced `builder` and `parameters` are null for a tracer's own tree.
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
      channels;   ///< Further channels for the EXR: those that the descriptor declares, and more with --aov.
  Image preview;  ///< For a screen, where the image itself is not meant for one; empty otherwise.

  double samplesDone = 0;  ///< Per pixel; less than settings.spp where it was stopped.
  RayCounts rays;
  double renderMs = 0;
  std::vector<PhaseTime> renderPhases;
  double buildMs = 0;  ///< For what the integrator itself built when it was made: part of the build's time.
  std::vector<PhaseTime> buildPhases;

  std::vector<std::pair<std::string, double>> figures;  ///< Further figures of the picture, by name.
  std::optional<TraversalRecord> traversal;             ///< Where the picture shows the counts.
  std::string remarks;                                  ///< Shown after the summary: whole lines, or "".
  std::optional<FilmState> film;  ///< To go on from: of resume(), and of a render that was stopped.
};

/// An integrator made ready for a scene and a tree.
class Integrator {
 public:
  virtual ~Integrator() = default;
  /// On `device`, the one that it was made for; an integrator with `onCpuOnly` takes as many threads as it has. Gives
  /// the image so far where it was stopped. Throws InputError for invalid settings or an invalid view.
  virtual Picture render(const Device& device, const Camera& camera, const RenderSettings& settings,
                         const Watch& watch) const = 0;
  /// Goes on from `from`, to the image that render() gives in one go, bit for bit. Counts and times are those of the
  /// samples since. Only of an integrator whose descriptor takes `resume`.
  virtual Picture resume(const Device&, const Camera&, const RenderSettings&, const Watch&, const FilmState&) const {
    throw std::logic_error("an integrator that cannot resume");
  }
};

struct IntegratorEntry {
  const char* name;
  const char* meaning;  ///< One line.
  TreeUse tree = TreeUse::traced;
  bool rendersLight = false;  ///< Its images show light: they are black where the scene has none.
  bool onCpuOnly = false;
  TakenOptions takes = {};
  std::span<const IntegratorOption* const> options = {};  ///< Its own.
  std::span<const char* const> channels = {};             ///< Further channels that its files always have.
  std::span<const PhaseName> phases = {};  ///< Those that a render may have, in the order of their first use.
  /// The device is the one that renders. Throws DeviceError.
  std::unique_ptr<const Integrator> (*make)(const Device& device, const IntegratorInput& input,
                                            const IntegratorOptions& options) = nullptr;
};

}  // namespace copse
