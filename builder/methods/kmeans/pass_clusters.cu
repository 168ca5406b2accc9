// Reads a pass's clusters back: sizes and representatives to the host, where clusters are few, and the triangles'
// numbers on the device.
#include "builder/methods/kmeans/pass_clusters.h"

#include <algorithm>

#include "builder/methods/kmeans/build.h"
#include "builder/methods/kmeans/passes.h"
#include "builder/parallel/launch.h"

namespace copse::kmeans {

namespace {

/// A cluster's triangles stand side by side.
struct Range {
  uint32_t first, count;
  uint32_t isOpen;  ///< Its boxes are with the next pass's tasks.
};

struct NumberTriangles {
  const Range* ranges;
  uint32_t rangeCount;
  const UnitBox *open, *done;
  uint32_t* clusterOf;

  HD void operator()(uint32_t place) const {
    uint32_t low = 0, high = rangeCount;
    while (high - low > 1) {
      const uint32_t middle = (low + high) / 2;
      (ranges[middle].first <= place ? low : high) = middle;
    }
    clusterOf[(ranges[low].isOpen ? open : done)[place].id] = low;
  }
};

template <class T>
std::vector<T> toHost(const Device& device, const T* from, std::size_t count) {
  std::vector<T> host(count);
  if (count) copyToHost(device, host.data(), from, count * sizeof(T));
  return host;
}

class Clusters final : public PassWatch {
 public:
  Clusters(const Primitives& input, const Box& bounds, uint32_t level)
      : input_(input), bounds_(bounds), level_(level) {}

  bool pass(const Device& device, const Pass& pass, const UnitBox* open, const UnitBox* done) override {
    ++result_.level;
    std::erase_if(found_, [](const Cluster& cluster) { return cluster.range.isOpen; });
    find(device, pass);
    const bool more = std::ranges::any_of(found_, [](const Cluster& cluster) { return cluster.range.isOpen; });
    if (more && result_.level < level_) return true;
    number(device, open, done);
    return false;
  }

  PassClusters take() { return std::move(result_); }

 private:
  struct Cluster {
    Range range;
    Box representative;
  };

  /// Adds the clusters of all tasks of the pass.
  void find(const Device& device, const Pass& pass) {
    const uint32_t k = pass.settings.k;
    const auto tasks = toHost(device, pass.tasks, pass.taskCount);
    const auto counts = toHost(device, pass.counts, std::size_t{pass.chunkCount} * k + 1);
    const auto reps = toHost(device, pass.reps, std::size_t{pass.taskCount} * k);
    Pass onHost = pass;
    onHost.tasks = tasks.data();
    onHost.counts = const_cast<uint32_t*>(counts.data());
    for (uint32_t t = 0; t < pass.taskCount; ++t) {
      const bool halves = onHost.undivided(tasks[t]);
      uint32_t only = 0;  // Both halves are of the one cluster that is not empty.
      while (halves && only + 1 < k && onHost.sizeOf(tasks[t], only) == 0) ++only;
      uint32_t first = tasks[t].first;
      for (uint32_t c = 0; c < k; ++c) {
        const uint32_t size = onHost.splitSize(tasks[t], c, halves);
        if (size == 0) continue;
        found_.push_back({{first, size, onHost.staysOpen(size)}, inScene(reps[onHost.row(t) + (halves ? only : c)])});
        first += size;
      }
    }
  }

  Box inScene(const UnitBox& unit) const {
    const vec3 extent = bounds_.hi - bounds_.lo;
    const float longest = maxOf(extent.x, maxOf(extent.y, extent.z));
    Box box = unit.box();
    box.lo = bounds_.lo + box.lo * longest;
    box.hi = bounds_.lo + box.hi * longest;
    return box;
  }

  void number(const Device& device, const UnitBox* open, const UnitBox* done) {
    std::ranges::sort(found_, {}, [](const Cluster& cluster) { return cluster.range.first; });
    std::vector<Range> ranges;
    for (const Cluster& cluster : found_) {
      ranges.push_back(cluster.range);
      result_.representatives.push_back(cluster.representative);
    }
    const Buffer<Range> onDevice(device, std::span<const Range>(ranges));
    result_.clusterOf = Buffer<uint32_t>(device, input_.count);
    launch(
        device, "number triangles", input_.count,
        NumberTriangles{onDevice.data(), static_cast<uint32_t>(ranges.size()), open, done, result_.clusterOf.data()});
    synchronise(device);  // The boxes and the ranges are gone once this returns.
  }

  Primitives input_;
  Box bounds_;
  uint32_t level_;
  std::vector<Cluster> found_;  ///< So far; those that are open are of the last pass.
  PassClusters result_;
};

}  // namespace

PassClusters passClusters(const Device& device, const Primitives& input, const Parameters& parameters, uint32_t level) {
  Box bounds;
  if (input.count > 0) copyToHost(device, &bounds, input.bounds, sizeof bounds);
  Clusters clusters(input, bounds, level);
  watchPasses(device, input, settingsOf(parameters), clusters);
  PassClusters result = clusters.take();
  if (result.level == 0 && input.count > 0) {
    result.clusterOf = Buffer<uint32_t>(device, input.count);
    result.clusterOf.fill(0);
    result.representatives.push_back(bounds);
  }
  return result;
}

}  // namespace copse::kmeans
