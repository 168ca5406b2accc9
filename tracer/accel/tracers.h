// The tracers by their names for `--tracer`: a format that any builder's tree is converted to, or a baseline that
// builds a tree of its own over the triangles (Embree, where it was installed when this was built). Adding one is a row
// in tracers.cpp.
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
  int variant = 0;  ///< Which of its own trees, to the tracer: an EmbreeQuality.
};

struct TracerEntry {
  const char* name;
  const char* source;   ///< "Aila 2009"; "" for auto.
  const char* meaning;  ///< One line.
  bool onCpuOnly;
  std::vector<OwnTree> ownTrees;  ///< Empty where it needs the tree of a builder, whichever that is.
  /// Makes the tracer without building it. `tree` is one of its own trees, null where it has none; parameters
  /// are those of rays (trace.*). Embree copies the triangles here, which are in host memory, and throws DeviceError
  /// with its own message.
  std::unique_ptr<TreeTracer> (*make)(const Device& device, const TrianglesView& triangles,
                                      const Parameters& parameters, const OwnTree* tree);
};

/// The first row is auto, the default: `wide8` on a CPU for trees whose nodes have more than two children, `binary` for
/// others and on CUDA.
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
  /// Whether it is a tracer's own tree. Such a tree cannot be inspected, takes no parameters, and only its tracer can
  /// trace it.
  bool isOwnTree() const { return tree_ != nullptr; }
  const BuilderEntry& builder() const { return *builder_; }  ///< Unless isOwnTree().
  const TracerEntry& tracer() const { return *tracer_; }     ///< If isOwnTree().
  const OwnTree* ownTree() const { return tree_; }           ///< Null where it is a builder.

 private:
  const BuilderEntry* builder_ = nullptr;
  const TracerEntry* tracer_ = nullptr;
  const OwnTree* tree_ = nullptr;
};

/// Throws InputError that lists the names, or says that this build lacks Embree.
TreeSource findTreeSource(std::string_view name);

/// What `--tracer` names.
class TracerChoice {
 public:
  TracerChoice();  ///< auto
  /// Throws InputError as findTracer() does.
  explicit TracerChoice(std::string_view name);

  const char* name() const { return entry_->name; }
  bool isAuto() const { return entry_ == &tracers().front(); }
  /// Throws InputError where it cannot trace `source`.
  void check(const TreeSource& source) const;
  /// Whether the tracer that it resolves to runs on the CPU only.
  bool isOnCpuOnly(const TreeSource& source) const;
  /// The row that traces `source`: for a tracer's own tree that tracer. Throws InputError as check() does, and where
  /// the row does not run on `device`.
  const TracerEntry& resolve(const Device& device, const TreeSource& source) const;

 private:
  const TracerEntry* entry_;
};

/// The tracer `name`, a row that needs a builder's tree, built over `bvh`. It copies what it needs of tree and
/// triangles.
std::unique_ptr<TreeTracer> makeTracer(const Device& device, const Bvh& bvh, const TrianglesView& triangles,
                                       std::string_view name = "auto", const Parameters& parameters = {});

}  // namespace copse
