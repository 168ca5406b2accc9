// What rays can go through, by the names of `--tracer`: a format that the tree of any builder is brought into, or a ray
// tracer that builds a tree of its own out of the triangles and is measured against ours (Embree, where it was
// installed when this was built). Adding one is a row in tracers.cpp.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "builder/registry.h"
#include "tracer/accel/ray_tracer.h"

namespace copse {

/// A tree that a tracer builds for itself. `--builder` knows it by its name.
struct OwnTree {
  const char* name;
  const char* source;
  const char* meaning;
};

struct TracerEntry {
  const char* name;
  const char* source;   ///< "Aila 2009"; "" for auto.
  const char* meaning;  ///< One line.
  bool onCpuOnly;
  std::vector<OwnTree> ownTrees;  ///< Empty where it needs the tree of a builder, whichever that is.
  /// Not built yet. `tree` is the name of one of its own trees, otherwise of no account; parameters are those of rays
  /// (trace.*). Embree copies the triangles here, which lie in the CPU's memory, and throws DeviceError with its own
  /// message.
  std::unique_ptr<TreeTracer> (*make)(const Device& device, const TrianglesView& triangles,
                                      const Parameters& parameters, std::string_view tree);
};

/// The first row is auto: what rays go through where nothing is said. It is `wide8` on a CPU for trees whose nodes have
/// more than two children, and `binary` for others and on CUDA.
std::span<const TracerEntry> tracers();
/// Throws InputError that lists the names, or says that this build lacks Embree.
const TracerEntry& findTracer(std::string_view name);

/// What `--builder` names: a builder, or a tree that a tracer builds for itself.
class TreeSource {
 public:
  TreeSource() = default;  ///< None.
  TreeSource(const BuilderEntry& builder) : builder_(&builder) {}
  TreeSource(const TracerEntry& tracer, const OwnTree& tree) : tracer_(&tracer), tree_(&tree) {}

  const char* name() const { return tree_ ? tree_->name : builder_->name; }
  /// Whether a tracer builds it for itself. Nothing looks into such a tree, parameters mean nothing to it, and it is
  /// traced by its tracer alone.
  bool isOwnTree() const { return tree_ != nullptr; }
  const BuilderEntry& builder() const { return *builder_; }  ///< Where it is no tracer's own tree.
  const TracerEntry& tracer() const { return *tracer_; }     ///< Where it is one.
  const OwnTree& tree() const { return *tree_; }

 private:
  const BuilderEntry* builder_ = nullptr;
  const TracerEntry* tracer_ = nullptr;
  const OwnTree* tree_ = nullptr;
};

/// Throws InputError: what names there are, or that this build lacks Embree.
TreeSource findTreeSource(std::string_view name);

/// What `--tracer` names, with what it is to be used for.
class TracerChoice {
 public:
  TracerChoice();  ///< auto
  /// Throws InputError as findTracer() does.
  explicit TracerChoice(std::string_view name);

  const char* name() const { return entry_->name; }
  bool isAuto() const { return entry_ == &tracers().front(); }
  /// Throws InputError where it does not go with what is built.
  void check(const TreeSource& source) const;
  /// Whether what it comes to runs on the CPU alone.
  bool isOnCpuOnly(const TreeSource& source) const;
  /// The row that traces `source`: for a tracer's own tree that tracer. Throws InputError as check() does, and where
  /// the row does not run on `device`.
  const TracerEntry& resolve(const Device& device, const TreeSource& source) const;

 private:
  const TracerEntry* entry_;
};

/// A tracer of `name`, a row that needs a builder's tree, built over `bvh`. It keeps what it needs of both.
std::unique_ptr<TreeTracer> makeTracer(const Device& device, const Bvh& bvh, const TrianglesView& triangles,
                                       std::string_view name = "auto", const Parameters& parameters = {});

}  // namespace copse
