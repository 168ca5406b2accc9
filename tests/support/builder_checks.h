// Helpers for checks of every builder: a device to build on, a tree from a mesh, and a comparison of two trees.
#pragma once

#include "builder/build.h"
#include "tests/support/inputs.h"

namespace copse::test {

/// The tree of `mesh` as `copse build` makes it.
inline Bvh treeOf(const Device& device, const TestMesh& mesh, const std::string& builder, const Parameters& chosen = {},
                  const BuildOptions& options = {}) {
  const BuilderEntry& entry = findBuilder(builder);
  const DeviceMesh onDevice(device, mesh);
  return buildBvh(device, onDevice.view(), entry, withPreset(entry, chosen), options);
}

/// The tree as the method and its optimisers leave it, before leaves are chosen.
inline OpenTree rawTreeOf(const Device& device, const TestMesh& mesh, const std::string& builder,
                          const Parameters& chosen = {}, const OptimiserNames& optimisers = {}) {
  const BuilderEntry& entry = findBuilder(builder);
  const DeviceMesh onDevice(device, mesh);
  const OwnedPrimitives primitives = primitivesOf(device, onDevice.view());
  return buildOpenTree(device, primitives.view(), entry, withPreset(entry, chosen), optimisers);
}

inline void requireValid(const Device& device, const Bvh& bvh, const TestMesh& mesh, uint32_t maxLeaf = maxLeafSize) {
  const DeviceMesh onDevice(device, mesh);
  validate(device, bvh, onDevice.view(), maxLeaf);
}

/// Every node and the order of a Bvh or an OpenTree as words, so that equal trees are bitwise equal.
template <class Tree>
std::vector<uint32_t> bitsOf(const Tree& bvh) {
  std::vector<uint32_t> words = bvh.order.toHost(bvh.referenceCount);
  const std::vector<BvhNode> nodes = bvh.nodes.toHost(bvh.nodeCount);
  const auto* raw = reinterpret_cast<const uint32_t*>(nodes.data());
  words.insert(words.end(), raw, raw + nodes.size() * sizeof(BvhNode) / sizeof(uint32_t));
  return words;
}

/// `device` with another number of threads.
inline Device withThreads(Device device, int threads) {
  device.threads = threads;
  return device;
}

}  // namespace copse::test
