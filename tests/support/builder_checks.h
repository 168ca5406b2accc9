// What every builder is checked with: a device to build on, a tree from a mesh, and a way to tell two trees apart.
#pragma once

#include "builder/build.h"
#include "tests/support/inputs.h"

namespace copse::test {

/// The tree of `mesh` as `copse build` makes it.
inline Bvh treeOf(const Device& device, const TestMesh& mesh, const std::string& builder,
                  const Parameters& chosen = {}) {
  const BuilderEntry& entry = findBuilder(builder);
  const DeviceMesh onDevice(device, mesh);
  return buildBvh(device, onDevice.view(), entry, withPreset(entry, chosen));
}

/// The tree as the method leaves it, before leaves are chosen.
inline Bvh rawTreeOf(const Device& device, const TestMesh& mesh, const std::string& builder,
                     const Parameters& chosen = {}) {
  const BuilderEntry& entry = findBuilder(builder);
  const DeviceMesh onDevice(device, mesh);
  const Buffer<Box> boxes = triangleBoxes(device, onDevice.view());
  return entry.method->build(device, inputOf(boxes), withPreset(entry, chosen));
}

inline void requireValid(const Device& device, const Bvh& bvh, const TestMesh& mesh, uint32_t maxLeaf = maxLeafSize) {
  const DeviceMesh onDevice(device, mesh);
  validate(device, bvh, onDevice.view(), maxLeaf);
}

/// Every node and the order as words, so that equal trees are bitwise equal.
inline std::vector<uint32_t> bitsOf(const Bvh& bvh) {
  std::vector<uint32_t> words = bvh.order.toHost(bvh.primitiveCount);
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
