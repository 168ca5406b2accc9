// k-means BVH: triangles are split into k clusters by k-means, again and again, and the k children of each node are
// joined by agglomerative clustering into binary treelets.
// Meister and Bittner: Parallel BVH Construction using k-means Clustering (The Visual Computer 2016).
// O(n k i) a level, about log_k n levels. The host reads five numbers a pass: how many tasks the next one has.
// Sums are integers and places come from scans, so the tree depends on the triangles and the parameters alone.
#include "builder/math/morton.h"
#include "builder/methods/kmeans/passes.h"
#include "builder/methods/methods.h"
#include "builder/parallel/launch.h"
#include "builder/parallel/primitives.h"

namespace copse {

namespace kmeans {

namespace {

struct EncodeCentres {
  const Box* boxes;
  MortonGrid grid;
  uint64_t* keys;
  uint32_t* order;
  HD void operator()(uint32_t i) const {
    keys[i] = grid.code(boxes[i].centre2());
    order[i] = i;
  }
};

struct ToUnit {
  const Box* boxes;
  const uint32_t* mortonOrder;
  vec3 origin;
  float scale;
  UnitBox* unit;
  uint32_t* order;
  HD void operator()(uint32_t i) const {
    const uint32_t id = mortonOrder[i];
    const Box& b = boxes[id];
    UnitBox& u = unit[i];
    for (int d = 0; d < 3; ++d) {
      u.lo[d] = (b.lo[d] - origin[d]) * scale;
      u.hi[d] = (b.hi[d] - origin[d]) * scale;
    }
    u.id = id;
    u.pad = 0;
    order[i] = i;
  }
};

struct WriteLeaves {
  const Box* boxes;
  const UnitBox* unit;
  const uint32_t* order;
  BvhNode* leaves;
  uint32_t* primitives;
  HD void operator()(uint32_t place) const {
    const uint32_t id = unit[order[place]].id;
    primitives[place] = id;
    leaves[place] = BvhNode::leaf(boxes[id], place, 1);
  }
};

/// What the agglomeration needs of a pass once it is over.
struct Level {
  Buffer<Task> tasks;
  Buffer<uint32_t> firstKid, kidNodes, extraNodes;
  uint32_t taskCount, kidCount;
};

struct Totals {
  uint32_t kids, open, queued, nodes, openChunks;
};

class Build {
 public:
  Build(const Device& device, const BuildInput& input, const Settings& settings)
      : device_(device),
        settings_(settings),
        n_(input.count),
        unit_(device, n_),
        order_(device, n_),
        next_(device, n_),
        done_(device, n_),
        cluster_(device, n_),
        leafQueue_(device, n_ / 2 + 1) {
    bvh_.primitiveCount = n_;
    bvh_.nodeCount = 2 * n_ - 1;
    bvh_.nodes = Buffer<BvhNode>(device, bvh_.nodeCount);
    bvh_.order = Buffer<uint32_t>(device, n_);
    initialise(input);
  }

  Bvh run(const BuildInput& input) {
    if (n_ == 1) {
      copyOnDevice(device_, done_.data(), order_.data(), sizeof(uint32_t));
    } else if (n_ < settings_.leafQueueBelow) {
      copyOnDevice(device_, done_.data(), order_.data(), order_.bytes());
      const LeafTask all{0, n_, 0};
      copyToDevice(device_, leafQueue_.data(), &all, sizeof all);
      queued_ = 1;
    } else {
      const Task all{0, n_, 0, 0};
      Buffer<Task> tasks(device_, std::span(&all, 1));
      uint32_t taskCount = 1, chunkCount = all.chunks();
      while (taskCount) split(tasks, taskCount, chunkCount);
    }
    finish(input);
    return std::move(bvh_);
  }

 private:
  /// Triangles in Morton order: neighbours in memory then mostly fall into one cluster. 30 bits are enough for that.
  void initialise(const BuildInput& input) {
    Phase phase(device_, "initialise");
    Buffer<uint64_t> keys(device_, n_), keyScratch(device_, n_);
    constexpr int bits = 10;
    launch(device_, "encode", n_,
           EncodeCentres{input.boxes, MortonGrid::over(input.bounds, bits, true), keys.data(), next_.data()});
    radixSort(device_, "sort", n_, 3 * bits, keys, next_, keyScratch, done_);
    const vec3 extent = input.bounds.hi - input.bounds.lo;
    const float longest = maxOf(extent.x, maxOf(extent.y, extent.z));
    launch(device_, "to unit", n_,
           ToUnit{input.boxes, next_.data(), input.bounds.lo, longest > 0 ? 1 / longest : 0.0f, unit_.data(),
                  order_.data()});
  }

  /// One pass: `tasks` are split, and replaced by those of the next pass.
  void split(Buffer<Task>& tasks, uint32_t& taskCount, uint32_t& chunkCount) {
    const uint32_t k = settings_.k;
    Buffer<float> reps(device_, std::size_t{taskCount} * 6 * padded(k));
    Buffer<Sums> sums(device_, std::size_t{taskCount} * k);
    Buffer<uint32_t> counts(device_, std::size_t{chunkCount} * k + 1);
    const Pass pass{settings_, unit_.data(), order_.data(), cluster_.data(), tasks.data(),
                    taskCount, chunkCount,   reps.data(),   sums.data(),     counts.data()};
    launchTeams(device_, "representatives", taskCount, DrawAll{pass}, sizeof(Workspace), 1);
    for (uint32_t t = 0; t < settings_.iterations; ++t) {
      {
        Phase phase(device_, "reset");
        sums.fill(0);
      }
      launchTeams(device_, "assign and sum", chunkCount, AssignAndSum{pass}, sizeof(Workspace));
      launch(device_, "normalise", taskCount * k, Normalise{pass});
    }
    launchTeams(device_, "cluster sizes", chunkCount, ClusterSizes{pass}, sizeof(Workspace));
    exclusiveScan(device_, "cluster sizes", chunkCount * k, counts.data(), counts.data(),
                  counts.data() + chunkCount * k);

    Level level{Buffer<Task>(),     Buffer<uint32_t>(device_, taskCount),
                Buffer<uint32_t>(), Buffer<uint32_t>(device_, taskCount),
                taskCount,          0};
    Totals totals{};
    Buffer<Task> nextTasks;
    {
      Phase phase(device_, "tasks");
      Buffer<uint32_t> numbers(device_, std::size_t{taskCount} * 4), sumsOf(device_, 5);
      const Children children{level.firstKid.data(), numbers.data(), numbers.data() + taskCount,
                              numbers.data() + 2 * std::size_t{taskCount}, numbers.data() + 3 * std::size_t{taskCount}};
      launch(device_, "count children", taskCount, CountChildren{pass, children});
      uint32_t* const rows[5] = {children.kids, children.open, children.queued, children.nodes, children.openChunks};
      for (int row = 0; row < 5; ++row)
        exclusiveScan(device_, "place children", taskCount, rows[row], rows[row], sumsOf.data() + row);
      copyToHost(device_, &totals, sumsOf.data(), sizeof totals);
      nextTasks = Buffer<Task>(device_, totals.open);
      level.kidNodes = Buffer<uint32_t>(device_, totals.kids);
      level.kidCount = totals.kids;
      launch(device_, "create tasks", taskCount,
             CreateTasks{pass, children, nodes_, queued_, n_ - 1, nextTasks.data(), leafQueue_.data(),
                         level.kidNodes.data(), level.extraNodes.data()});
    }
    launchTeams(device_, "reorder", chunkCount, Reorder{pass, next_.data(), done_.data()}, sizeof(Workspace));
    order_.swap(next_);
    nodes_ += totals.nodes;
    queued_ += totals.queued;
    level.tasks = std::move(tasks);
    levels_.push_back(std::move(level));
    tasks = std::move(nextTasks);
    taskCount = totals.open;
    chunkCount = totals.openChunks;
  }

  void finish(const BuildInput& input) {
    const uint32_t leafNodes = n_ - 1;
    BvhNode* const nodes = bvh_.nodes.data();
    launchTeams(device_, "leaf queue", queued_,
                Refine{settings_, unit_.data(), done_.data(), next_.data(), cluster_.data(), leafQueue_.data(), nodes,
                       leafNodes},
                sizeof(Refine::Shared));
    {
      Phase phase(device_, "boxes");
      launch(device_, "leaves", n_,
             WriteLeaves{input.boxes, unit_.data(), done_.data(), nodes + leafNodes, bvh_.order.data()});
      launch(device_, "leaf queue boxes", queued_, LeafBoxes{leafQueue_.data(), nodes}, 64);
    }
    for (auto level = levels_.rbegin(); level != levels_.rend(); ++level)
      launch(device_, "agglomerate", level->taskCount,
             AgglomerateAll{level->tasks.data(), level->firstKid.data(), level->taskCount, level->kidCount,
                            level->kidNodes.data(), level->extraNodes.data(), nodes},
             4);
  }

  Device device_;
  Settings settings_;
  uint32_t n_;
  Buffer<UnitBox> unit_;
  Buffer<uint32_t> order_, next_, done_;
  Buffer<uint8_t> cluster_;
  Buffer<LeafTask> leafQueue_;
  uint32_t queued_ = 0;
  uint32_t nodes_ = 1;  // Node 0 is the root's.
  std::vector<Level> levels_;
  Bvh bvh_;
};

}  // namespace

}  // namespace kmeans

Bvh buildKmeans(const Device& device, const BuildInput& input, const Parameters& parameters) {
  if (input.count == 0) return {};
  const auto number = [&](const char* name) { return static_cast<uint32_t>(parameters.integer(name)); };
  kmeans::Settings settings{};
  settings.k = number("kmeans.k");
  settings.draws = number("kmeans.p");
  settings.iterations = number("kmeans.i");
  settings.seed = number("kmeans.seed");
  settings.leafQueueBelow = number("kmeans.m") * settings.k;
  const std::string& metric = parameters.text("kmeans.distance");
  settings.metric = metric == "manhattan"    ? kmeans::Metric::manhattan
                    : metric == "chebyshev"  ? kmeans::Metric::chebyshev
                    : metric == "union-area" ? kmeans::Metric::unionArea
                                             : kmeans::Metric::euclid;
  return kmeans::Build(device, input, settings).run(input);
}

}  // namespace copse
