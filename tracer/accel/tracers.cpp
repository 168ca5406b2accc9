// The table of ray tracers: one row per name.
#include "tracer/accel/tracers.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

#include "builder/base/error.h"
#include "tracer/accel/binary.h"
#include "tracer/accel/counting.h"
#include "tracer/accel/embree.h"
#include "tracer/accel/persistent.h"
#include "tracer/accel/trace_on_host.h"
#include "tracer/accel/wide8.h"

#ifndef COPSE_EMBREE
#define COPSE_EMBREE 0
#endif
#if COPSE_EMBREE == 4
#define COPSE_EMBREE_NAME "Embree 4"
#else
#define COPSE_EMBREE_NAME "Embree 3"
#endif

namespace copse {

namespace {

/// Traces rays through a tree in a format: on the CPU in runs on its threads, on CUDA by persistent warps.
template <class Format>
class FormatTracer final : public TreeTracer, public StepTracer {
 public:
  FormatTracer(const char* name, const Device& device, const Parameters& parameters)
      : name_(name), settings_(parameters), onHost_(parameters) {
    if (device.isCuda()) persistent_.emplace(device, PersistentSettings(parameters));
  }

  void build(const Device& device, const Bvh& bvh, const TrianglesView& triangles) override {
    tree_ = Format::build(device, bvh, triangles, settings_);
  }
  const char* name() const override { return name_; }
  std::size_t bytes() const override { return tree_.bytes(); }
  std::optional<double> wideCost(const Device& device) const override {
    if constexpr (requires { Format::cost(device, tree_.view(), settings_); })
      return Format::cost(device, tree_.view(), settings_);
    else
      return std::nullopt;
  }
  const StepTracer* stepTracer() const override { return this; }

  void closest(const Device& device, const char* name, uint32_t count, const Ray* rays, Hit* hits) const override {
    if (persistent_)
      persistent_->closest(device, name, tree_.view(), count, rays, hits);
    else
      onHost_.closest(device, name, tree_.view(), count, rays, hits);
  }
  void any(const Device& device, const char* name, uint32_t count, const Ray* rays, uint32_t* occluded) const override {
    if (persistent_)
      persistent_->any(device, name, tree_.view(), count, rays, occluded);
    else
      onHost_.any(device, name, tree_.view(), count, rays, occluded);
  }

  void closest(const Device& device, const char* name, uint32_t count, const Ray* rays, Hit* hits,
               RaySteps* steps) const override {
    countClosest<Format>(device, name, tree_.view(), count, rays, hits, steps);
  }
  void any(const Device& device, const char* name, uint32_t count, const Ray* rays, uint32_t* occluded,
           RaySteps* steps) const override {
    countAny<Format>(device, name, tree_.view(), count, rays, occluded, steps);
  }

 private:
  const char* name_;
  typename Format::Settings settings_;
  HostTracer<Format> onHost_;
  typename Format::Tree tree_;
  std::optional<PersistentTracer<Format>> persistent_;
};

std::unique_ptr<TreeTracer> makeBinary(const Device& device, const TrianglesView&, const Parameters& parameters,
                                       const OwnTree*) {
  return std::make_unique<FormatTracer<Binary>>("binary", device, parameters);
}

std::unique_ptr<TreeTracer> makeWide8(const Device& device, const TrianglesView&, const Parameters& parameters,
                                      const OwnTree*) {
  return std::make_unique<FormatTracer<Wide8>>("wide8", device, parameters);
}

/// A GPU reads binary nodes, whose loads are shorter.
std::unique_ptr<TreeTracer> makeAuto(const Device& device, const TrianglesView& triangles, const Parameters& parameters,
                                     const OwnTree* tree) {
  return (device.isCuda() ? makeBinary : makeWide8)(device, triangles, parameters, tree);
}

std::unique_ptr<TreeTracer> makeEmbree([[maybe_unused]] const Device& device,
                                       [[maybe_unused]] const TrianglesView& triangles, const Parameters&,
                                       [[maybe_unused]] const OwnTree* tree) {
#if COPSE_EMBREE
  const auto quality = tree ? static_cast<EmbreeQuality>(tree->variant) : EmbreeQuality::medium;
  return std::make_unique<EmbreeTracer>(triangles, quality, device.threads);
#else
  return nullptr;
#endif
}

const TracerEntry embree{
    "embree",
    "Wald 2014",
    COPSE_EMBREE_NAME " with a tree of its own: --builder embree-low, embree-medium or embree-high",
    true,
    {{"embree-low", "Wald 2014", COPSE_EMBREE_NAME " at low build quality: Morton codes",
      static_cast<int>(EmbreeQuality::low)},
     {"embree-medium", "Wald 2014", COPSE_EMBREE_NAME " at medium build quality: binned surface areas",
      static_cast<int>(EmbreeQuality::medium)},
     {"embree-high", "Wald 2014", COPSE_EMBREE_NAME " at high build quality: spatial splits as well",
      static_cast<int>(EmbreeQuality::high)}},
    makeEmbree,
};

std::string namesOf(const std::vector<OwnTree>& trees) {
  std::string names;
  for (const OwnTree& tree : trees)
    names += fmt::format("{}{}", names.empty() ? "" : &tree == &trees.back() ? " or " : ", ", tree.name);
  return names;
}

[[noreturn]] void failWithoutEmbree(std::string_view name) {
  throw InputError(fmt::format("{}: this build has no Embree; install Debian's libembree-dev and rebuild", name));
}

}  // namespace

std::span<const TracerEntry> tracers() {
  static const std::vector<TracerEntry> table = [] {
    std::vector<TracerEntry> rows{
        {"auto", "", "wide8 on the CPU, binary on CUDA", false, {}, makeAuto},
        {"binary", "Aila 2009", "nodes that hold the boxes of two children", false, {}, makeBinary},
        {"wide8", "Wald 2008", "nodes that hold the boxes of up to eight children", false, {}, makeWide8},
    };
    if (COPSE_EMBREE) rows.push_back(embree);
    return rows;
  }();
  return table;
}

const TracerEntry& findTracer(std::string_view name) {
  std::vector<const char*> names;
  for (const TracerEntry& entry : tracers()) {
    if (name == entry.name) return entry;
    names.push_back(entry.name);
  }
  if (name == embree.name) failWithoutEmbree(name);
  throw InputError(fmt::format("unknown tracer '{}' (available: {})", name, fmt::join(names, ", ")));
}

TreeSource findTreeSource(std::string_view name) {
  std::vector<const char*> names;
  for (const BuilderEntry& entry : builders()) {
    if (name == entry.name) return entry;
    names.push_back(entry.name);
  }
  for (const TracerEntry& entry : tracers())
    for (const OwnTree& tree : entry.ownTrees) {
      if (name == tree.name) return {entry, tree};
      names.push_back(tree.name);
    }
  for (const OwnTree& tree : embree.ownTrees)
    if (name == tree.name) failWithoutEmbree(name);
  throw InputError(fmt::format("unknown builder '{}' (available: {})", name, fmt::join(names, ", ")));
}

TracerChoice::TracerChoice() : entry_(&tracers().front()) {}

TracerChoice::TracerChoice(std::string_view name) : entry_(&findTracer(name)) {}

void TracerChoice::check(const TreeSource& source) const {
  if (isAuto()) return;
  if (source.isOwnTree() && entry_ != &source.tracer())
    throw InputError(fmt::format("tracer {} cannot trace {}, which is a tree of {}'s own (expected auto or {})", name(),
                                 source.name(), source.tracer().name, source.tracer().name));
  if (!source.isOwnTree() && !entry_->ownTrees.empty())
    throw InputError(fmt::format("tracer {} builds its own tree and cannot trace that of {} (expected builder {})",
                                 name(), source.name(), namesOf(entry_->ownTrees)));
}

bool TracerChoice::isOnCpuOnly(const TreeSource& source) const {
  return source.isOwnTree() ? source.tracer().onCpuOnly : entry_->onCpuOnly;
}

const TracerEntry& TracerChoice::resolve(const Device& device, const TreeSource& source) const {
  check(source);
  if (device.isCuda() && isOnCpuOnly(source))
    throw InputError(fmt::format("{} runs on the CPU only; use --device cpu", source.name()));
  return source.isOwnTree() ? source.tracer() : *entry_;
}

std::unique_ptr<TreeTracer> makeTracer(const Device& device, const Bvh& bvh, const TrianglesView& triangles,
                                       std::string_view name, const Parameters& parameters) {
  std::unique_ptr<TreeTracer> tracer = findTracer(name).make(device, triangles, parameters, nullptr);
  tracer->build(device, bvh, triangles);
  return tracer;
}

}  // namespace copse
