// Approximate agglomerative clustering: boxes in Morton order are halved down to a few; going back up, the clusters of
// two halves become one list, which is shortened by joining the closest. How many stay sets quality against time.
// Gu, He, Fatahalian, Blelloch: Efficient BVH Construction via Approximate Agglomerative Clustering (HPG 2013).
// O(n) but for the sort; runs on the CPU's threads.
// Inner node numbers come from the order: of m boxes side by side, m-1 joins use the numbers that these boxes bring.
#include <omp.h>

#include <algorithm>

#include "builder/bottom_up.h"
#include "builder/method.h"
#include "builder/methods/aac/clusters.h"
#include "builder/methods/on_host.h"
#include "builder/parallel/bits.h"
#include "builder/parallel/timeline.h"
#include "builder/phases.h"
#include "builder/primitives/morton_order.h"

namespace copse {

namespace {

constexpr PhaseName clusteringPhase{"clustering", &groups::agglomeration};

using aac::Cluster;
using List = std::vector<Cluster>;

/// Fewer boxes than this are one task. Fixed, and nothing depends on it but the time.
constexpr uint32_t taskSize = 2048;

struct Clustering {
  const Box* boxes;
  const uint64_t* keys;
  const uint32_t* order;
  uint32_t count, delta;
  double epsilon;
  aac::Joined to;
  std::vector<aac::Shortener> shorteners;  ///< One per thread.

  /// The first place of the range's second half: where the highest bit changes in which its codes differ; the middle
  /// where all are equal.
  uint32_t splitOf(uint32_t begin, uint32_t end) const {
    const uint64_t differing = keys[begin] ^ keys[end - 1];
    if (differing == 0) return begin + (end - begin) / 2;
    const uint64_t bit = uint64_t{1} << (63 - leadingZeros(differing));
    return static_cast<uint32_t>(
        std::partition_point(keys + begin, keys + end, [&](uint64_t key) { return !(key & bit); }) - keys);
  }

  void shorten(List& list, uint32_t half, uint32_t target) {
    if (list.size() > 1) shorteners[static_cast<std::size_t>(omp_get_thread_num())].shorten(list, half, target, to);
  }

  List single(uint32_t begin, uint32_t end) {
    List list(end - begin);
    for (uint32_t i = begin; i < end; ++i) {
      Cluster& cluster = list[i - begin];
      cluster.box = boxes[order[i]];
      cluster.node = count - 1 + i;
      cluster.spare = i;
      cluster.size = 1;
      to.nodes[cluster.node] = BvhNode::leaf(cluster.box, i, 1);
    }
    return list;
  }

  List build(uint32_t begin, uint32_t end) {
    const uint32_t size = end - begin;
    if (size < delta || size == 1) {
      List list = single(begin, end);
      shorten(list, 0, aac::keptOf(delta, epsilon, delta));
      return list;
    }
    const uint32_t middle = splitOf(begin, end);
    List list, right;
    if (size > taskSize) {
#pragma omp taskgroup
      {
#pragma omp task default(shared) firstprivate(begin, middle)
        list = build(begin, middle);
        right = build(middle, end);
      }
    } else {
      list = build(begin, middle);
      right = build(middle, end);
    }
    const auto half = static_cast<uint32_t>(list.size());
    list.insert(list.end(), right.begin(), right.end());
    shorten(list, half, size == count ? 1 : aac::keptOf(delta, epsilon, size));
    return list;
  }
};

OpenTree buildAac(const Device& device, const Primitives& input, const Parameters& parameters) {
  const uint32_t n = input.count;
  OpenTree bvh;
  if (n == 0) return bvh;
  const HostInput from(device, input);
  bvh.referenceCount = n;
  bvh.nodeCount = 2 * n - 1;
  bvh.firstLeaf = n - 1;
  Buffer<BvhNode> nodes(from.host, bvh.nodeCount);
  Buffer<uint32_t> parents(from.host, bvh.nodeCount);
  MortonOrder sorted;
  {
    Phase phase(device, phases::sort);
    sorted = mortonOrder(from.host, from.input, parameters);
  }
  {
    Phase phase(device, clusteringPhase);
    Clustering clustering{from.input.boxes,
                          sorted.keys.data(),
                          sorted.order.data(),
                          n,
                          static_cast<uint32_t>(parameters.integer("aac.delta")),
                          parameters.real("aac.epsilon"),
                          {nodes.data(), parents.data()},
                          std::vector<aac::Shortener>(static_cast<std::size_t>(from.host.threads))};
    List root;
#pragma omp parallel num_threads(from.host.threads) if (n > taskSize)
#pragma omp single
    {
      root = clustering.build(0, n);
      clustering.shorten(root, 0, 1);  // Fewer than delta boxes are still a list.
    }
    bringToFront(nodes.data(), parents.data(), root[0].node);
  }
  bvh.nodes = onDevice(device, std::move(nodes));
  bvh.parents = onDevice(device, std::move(parents));
  bvh.order = onDevice(device, std::move(sorted.order));
  return bvh;
}

}  // namespace

namespace methods {

Method aac() {
  return {.name = "aac",
          .source = "Gu 2013",
          .meaning = "approximate agglomerative clustering in Morton order",
          .page = "docs/builders/aac.md",
          .build = buildAac,
          .onCpuOnly = true,
          .parameters = {{.name = "aac.delta",
                          .standard = 20,
                          .min = 2,
                          .max = 1000,
                          .meaning = "initial clusters have fewer boxes than this; half as many are kept"},
                         {.name = "aac.epsilon",
                          .standard = 0.1,
                          .min = 0,
                          .max = 0.5,
                          .meaning = "clusters kept from n boxes, in proportion to n^(1/2 - epsilon)"}},
          .phases = {clusteringPhase},
          .presets = {{"aac-fast",
                       "approximate agglomerative clustering in Morton order, few candidates",
                       {{"aac.delta", 4}, {"aac.epsilon", 0.2}}},
                      {"aac-hq",
                       "approximate agglomerative clustering in Morton order, many candidates",
                       {{"aac.delta", 20}, {"aac.epsilon", 0.1}}}},
          .presetsOnly = true};
}

}  // namespace methods

}  // namespace copse
