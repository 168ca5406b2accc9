// Other people's ray tracers under the names of builders, so that they stand in the same tables: they build a tree of
// their own and trace it themselves, inside this path tracer. Which there are depends on what was installed when this
// was built.
#pragma once

#include <memory>
#include <span>
#include <string>

#include "builder/registry.h"
#include "tracer/accel/ray_tracer.h"

namespace copse {

/// One row a peer, on the CPU all of them; `method` is null, as what they build is no Bvh, and parameters mean nothing
/// to them.
std::span<const BuilderEntry> peerBuilders();

inline bool isPeer(const BuilderEntry& entry) { return entry.method == nullptr; }

/// The row of a builder or a peer. Throws InputError: what names there are, or that this build lacks that peer.
const BuilderEntry& findBuilderOrPeer(std::string_view name);

/// Rays can be traced once it is built.
class PeerTracer : public RayTracer {
 public:
  /// A phase of its own in the device's timeline, and all of the time that counts as build.
  virtual void build(const Device& device) = 0;
  /// Of what it built.
  virtual std::size_t bytes() const = 0;
  /// Most that it held at a time while it built.
  virtual std::size_t peakBytes() const = 0;
};

/// `peer` with a copy of the triangles, which lie in the CPU's memory, not built yet: on as many threads as `device`
/// has. Throws InputError where `device` is CUDA, DeviceError with the peer's own message.
std::unique_ptr<PeerTracer> makePeer(const Device& device, const BuilderEntry& peer, const TrianglesView& triangles);

}  // namespace copse
