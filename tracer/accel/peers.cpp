// The table of peers: one row a name.
#include "tracer/accel/peers.h"

#include <fmt/format.h>

#include <string_view>
#include <vector>

#include "builder/base/error.h"
#include "tracer/accel/embree.h"

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

using peers::Quality;

struct EmbreeRow {
  BuilderEntry entry;
  Quality quality;
};

const EmbreeRow embreeRows[] = {
    {{"embree-low", "Wald 2014", COPSE_EMBREE_NAME " at low build quality: Morton codes", nullptr}, Quality::low},
    {{"embree-medium", "Wald 2014", COPSE_EMBREE_NAME " at medium build quality: binned surface areas", nullptr},
     Quality::medium},
    {{"embree-high", "Wald 2014", COPSE_EMBREE_NAME " at high build quality: spatial splits as well", nullptr},
     Quality::high},
};

}  // namespace

std::span<const BuilderEntry> peerBuilders() {
  static const std::vector<BuilderEntry> table = [] {
    std::vector<BuilderEntry> rows;
    if (COPSE_EMBREE)
      for (const EmbreeRow& row : embreeRows) rows.push_back(row.entry);
    return rows;
  }();
  return table;
}

const BuilderEntry& findBuilderOrPeer(std::string_view name) {
  std::vector<const char*> names;
  for (const auto rows : {builders(), peerBuilders()})
    for (const BuilderEntry& entry : rows) {
      if (name == entry.name) return entry;
      names.push_back(entry.name);
    }
  for (const EmbreeRow& row : embreeRows)
    if (name == row.entry.name)
      throw InputError(
          fmt::format("{}: this build has no Embree; with Debian's libembree-dev installed, build it again", name));
  throw InputError(fmt::format("unknown builder '{}': one of {}", name, fmt::join(names, ", ")));
}

std::unique_ptr<PeerTracer> makePeer(const Device& device, const BuilderEntry& peer,
                                     [[maybe_unused]] const TrianglesView& triangles) {
  if (device.isCuda()) throw InputError(fmt::format("{} runs on the CPU alone: --device cpu", peer.name));
#if COPSE_EMBREE
  for (const EmbreeRow& row : embreeRows)
    if (std::string_view(peer.name) == row.entry.name)
      return std::make_unique<peers::EmbreeTracer>(triangles, row.quality, device.threads);
#endif
  throw InputError(fmt::format("{} is no peer of this build", peer.name));
}

}  // namespace copse
