// k-means BVH: triangles are split into k clusters by k-means, again and again, and the k children of each node are
// joined by agglomerative clustering into binary treelets.
// Meister and Bittner: Parallel BVH Construction using k-means Clustering (The Visual Computer 2016).
// O(n k i) per level, about log_k n levels. The host reads four numbers per pass: how many tasks the next one has.
// Sums are whole numbers and places come from scans, so the tree depends on the triangles and the parameters alone.
#include <string>

#include "builder/base/error.h"
#include "builder/bottom_up.h"
#include "builder/method.h"
#include "builder/methods/kmeans/agglomerate.h"
#include "builder/methods/kmeans/build.h"
#include "builder/methods/kmeans/pass_clusters.h"
#include "builder/methods/kmeans/plusplus_passes.h"
#include "builder/parallel/arena.h"
#include "builder/parallel/launch.h"
#include "builder/parallel/pending_read.h"
#include "builder/parallel/primitives.h"
#include "builder/primitives/morton_order.h"

namespace copse {

namespace kmeans {

namespace {

constexpr uint32_t prefetchDistance = 8;  ///< In triangles, whose boxes may lie anywhere.

/// What the first pass, or the leaf queue where there is none, finds.
struct Start {
  uint32_t* parents;
  Task* task;  ///< Null where there is no pass.
  LeafTask* queued;

  HD void write(uint32_t count) const {
    parents[0] = ParentLinks::none;
    if (task)
      *task = {0, count, 0, 0};
    else
      *queued = {0, count, 0};
  }
};

struct ToUnit {
  const Box *boxes, *bounds;
  const uint32_t* order;
  uint32_t count;
  UnitBox* unit;
  Start start;
  vec3 origin{};
  float scale = 0;

  HD void prepare() {
    origin = bounds->lo;
    const vec3 extent = bounds->hi - bounds->lo;
    const float longest = maxOf(extent.x, maxOf(extent.y, extent.z)), unitsPerLength = 1 / longest;
    scale = longest > 0 && unitsPerLength < FLT_MAX ? unitsPerLength : 0.0f;
  }

  HD float coordinate(float x, float from) const { return maxOf((x - from) * scale, 0.0f); }
  HD void operator()(uint32_t i) const {
    if (i == 0) start.write(count);
    if (i + prefetchDistance < count) prefetch(boxes + order[i + prefetchDistance]);
    const Box b = boxes[order[i]];  // A copy, for two loads of 16 bytes.
    UnitBox u;
    for (int d = 0; d < 3; ++d) {
      u.lo[d] = minOf(coordinate(b.lo[d], origin[d]), 1.0f);
      u.hi[d] = minOf(coordinate(b.hi[d], origin[d]), 1.0f);
    }
    u.id = order[i];
    u.pad = 0;
    unit[i] = u;
  }
};

struct WriteLeaves {
  const Box* boxes;
  const UnitBox* unit;
  uint32_t count;
  BvhNode* leaves;
  uint32_t* primitives;
  HD void operator()(uint32_t place) const {
    if (place + prefetchDistance < count) prefetch(boxes + unit[place + prefetchDistance].id);
    const uint32_t id = unit[place].id;
    primitives[place] = id;
    const Box box = boxes[id];
    leaves[place] = BvhNode::leaf(box, place, 1);
  }
};

class Build {
 public:
  Build(const Device& device, const Primitives& input, const Settings& settings)
      : device_(device),
        settings_(settings),
        n_(input.count),
        chunkSize_(chunkSizeFor(device, settings, n_)),
        boxes_(device, n_),
        next_(device, n_),
        done_(device, n_),
        cluster_(device, n_),
        leafQueue_(device, n_ / 2 + 1),
        maxTasks_(n_ / settings.leafQueueBelow),
        tasks_(device, maxTasks_),
        nextTasks_(device, maxTasks_),
        totals_(device, 1),
        read_(device),
        // A guess: half of the tasks that the widest pass may have in all passes, and a tenth in one.
        kept_(device, maxTasks_ / 2 * (std::size_t{settings.k} + 3) * sizeof(uint32_t)),
        scratch_(device, maxTasks_ / 10 * std::size_t{settings.k} * (sizeof(UnitBox) + sizeof(Sums))) {
    bvh_.referenceCount = n_;
    bvh_.nodeCount = 2 * n_ - 1;
    bvh_.nodes = Buffer<BvhNode>(device, bvh_.nodeCount);
    bvh_.order = Buffer<uint32_t>(device, n_);
    bvh_.parents = Buffer<uint32_t>(device, bvh_.nodeCount);
    bvh_.firstLeaf = n_ - 1;
    bvh_.arity = settings.arity;
    if (settings.arity > 2) {
      bvh_.joints = Buffer<uint8_t>(device, bvh_.nodeCount);
      bvh_.joints.fill(0);
    }
    initialise(input);
  }

  OpenTree run(const Primitives& input) {
    passes();
    finish(input);
    return std::move(bvh_);
  }

  void passes(PassWatch* watch = nullptr) {
    if (maxTasks_ == 0) {
      boxes_.swap(done_);
      queued_ = n_ > 1;
      return;
    }
    uint32_t taskCount = 1, chunkCount = chunksOf(n_, chunkSize_);
    while (taskCount) split(taskCount, chunkCount, watch);
  }

 private:
  template <class Kernel>
  void teams(PhaseName name, uint32_t count, const Kernel& kernel, uint32_t sharedBytes, uint32_t grain) {
    if (settings_.onFibers)
      launchWarps(device_, name, count, kernel, sharedBytes);
    else
      launchTeams(device_, name, count, kernel, sharedBytes, grain);
  }

  /// Boxes in Morton order: neighbours in memory then mostly fall into one cluster. 30 bits are enough for that.
  void initialise(const Primitives& input) {
    Phase phase(device_, phases::initialise);
    const Buffer<uint32_t> order = mortonOrder(device_, input, 10, true).order;
    launch(device_, "to unit", n_,
           ToUnit{input.boxes, input.bounds, order.data(), n_, boxes_.data(),
                  Start{bvh_.parents.data(), tasks_.data(), leafQueue_.data()}});
  }

  void drawPlusPlus(const Pass& pass) {
    Phase phase(device_, phases::representatives);
    Buffer<float> distances(device_, n_), largest(device_, pass.taskCount);
    Buffer<uint64_t> chunkSums(device_, pass.chunkCount);
    PlusPlus draw{pass, 1, distances.data(), largest.data(), chunkSums.data()};
    launch(device_, "draw first", pass.taskCount, DrawFirst{draw}, 64);
    for (; draw.c < settings_.k; ++draw.c) {
      teams("measure", pass.chunkCount, MeasureFrom{draw}, 0, 8);
      teams("sum", pass.chunkCount, SumShares{draw}, 0, 8);
      launch(device_, "draw next", pass.taskCount, DrawNext{draw}, 64);
    }
  }

  /// One pass: the tasks are split, and replaced by those of the next pass.
  void split(uint32_t& taskCount, uint32_t& chunkCount, PassWatch* watch) {
    const uint32_t k = settings_.k;
    const std::size_t rows = std::size_t{taskCount} * k, countCount = std::size_t{chunkCount} * k;
    const std::size_t numberCount = Children::rows * std::size_t{taskCount};
    scratch_.clear(Arena::bytesOf<UnitBox>(rows) + Arena::bytesOf<Sums>(rows) + Arena::bytesOf<uint32_t>(taskCount) +
                   Arena::bytesOf<uint32_t>(countCount + 1) + Arena::bytesOf<uint32_t>(numberCount + 1));
    UnitBox* const reps = scratch_.take<UnitBox>(rows);
    Sums* const sums = scratch_.take<Sums>(rows);
    uint32_t* const lastMove = scratch_.take<uint32_t>(taskCount);
    uint32_t* const counts = scratch_.take<uint32_t>(countCount + 1);
    const Pass pass{settings_,  chunkSize_, boxes_.data(), cluster_.data(), tasks_.data(), taskCount,
                    chunkCount, reps,       sums,          lastMove,        counts};
    if (settings_.plusPlus)
      drawPlusPlus(pass);
    else
      teams(phases::representatives, taskCount, DrawAll{pass}, sizeof(Workspace), 1);
    for (uint32_t t = 0; t < settings_.iterations; ++t) {
      teams(phases::assignAndSum, chunkCount, AssignAndSum{pass, t}, sizeof(Workspace), 8);
      launch(device_, phases::normalise, taskCount * k, Normalise{pass, t});
    }
    teams(phases::clusterSizes, chunkCount, ClusterSizes{pass}, sizeof(Workspace), 8);
    exclusiveScan(device_, phases::clusterSizes, chunkCount * k, counts, counts, counts + countCount);

    const Children children{scratch_.take<uint32_t>(numberCount + 1), taskCount};
    const Level level{kept_.take<uint32_t>(taskCount), kept_.take<uint32_t>(std::size_t{taskCount} + 1),
                      kept_.take<uint32_t>(rows), kept_.take<uint32_t>(taskCount), taskCount};
    {
      Phase phase(device_, phases::tasks);
      launch(device_, "count children", taskCount, CountChildren{pass, children}, 64);
      exclusiveScan(device_, "place children", static_cast<uint32_t>(numberCount), children.numbers, children.numbers,
                    children.numbers + numberCount);
      launch(device_, "create tasks", taskCount,
             CreateTasks{pass, children, nodes_, queued_, n_ - 1, nextTasks_.data(), leafQueue_.data(), level,
                         totals_.data()},
             64);
    }
    read_.start(totals_.data());  // On its way while the boxes are moved.
    teams(phases::reorder, chunkCount, Reorder{pass, next_.data(), done_.data()}, sizeof(Workspace), 8);
    Totals totals = read_.wait<Totals>();
    if (watch && !watch->pass(device_, pass, next_.data(), done_.data())) totals = {};
    boxes_.swap(next_);
    tasks_.swap(nextTasks_);
    levels_.push_back(level);
    nodes_ += totals.nodes;
    queued_ += totals.queued;
    taskCount = totals.open;
    chunkCount = totals.openChunks;
  }

  /// Two kernels, as the one with both ways of drawing would not fit into a GPU's registers.
  template <class Kernel>
  void refine() {
    teams(phases::leafQueue, queued_,
          Kernel{settings_, done_.data(), next_.data(), cluster_.data(), leafQueue_.data(), bvh_.nodes.data(),
                 bvh_.parents.data(), n_ - 1},
          sizeof(typename Kernel::Shared), 64);
  }

  void finish(const Primitives& input) {
    const uint32_t leafNodes = n_ - 1;
    BvhNode* const nodes = bvh_.nodes.data();
    uint32_t* const parents = bvh_.parents.data();
    if (settings_.plusPlus)
      refine<Refine<true>>();
    else
      refine<Refine<false>>();
    launch(device_, phases::leaves, n_,
           WriteLeaves{input.boxes, done_.data(), n_, nodes + leafNodes, bvh_.order.data()});
    for (auto level = levels_.rbegin(); level != levels_.rend(); ++level)
      teams(phases::agglomerate, level->taskCount,
            AgglomerateAll{*level, done_.data(), nodes, parents, bvh_.joints.data(), leafNodes},
            sizeof(Agglomeration::Clusters), 4);
  }

  Device device_;
  Settings settings_;
  uint32_t n_, chunkSize_;
  Buffer<UnitBox> boxes_, next_, done_;
  Buffer<uint8_t> cluster_;
  Buffer<LeafTask> leafQueue_;
  uint32_t maxTasks_;  ///< Per pass.
  Buffer<Task> tasks_, nextTasks_;
  Buffer<Totals> totals_;
  PendingRead read_;
  Arena kept_;     ///< Each pass's Level.
  Arena scratch_;  ///< For the current pass.
  uint32_t queued_ = 0;
  uint32_t nodes_ = 1;  // Node 0 is the root's.
  std::vector<Level> levels_;
  OpenTree bvh_;
};

/// Who chooses an arity and no k means as many clusters, whatever the preset has.
void widthIsK(Parameters& parameters, const Parameters& chosen) {
  if (parameters.integer("kmeans.arity") > 2 && !chosen.isSet("kmeans.k"))
    parameters.set("kmeans.k", parameters.value("kmeans.arity"));
}

}  // namespace

Settings settingsOf(const Parameters& given) {
  Parameters parameters = given;
  widthIsK(parameters, given);
  const auto number = [&](const char* name) { return static_cast<uint32_t>(parameters.integer(name)); };
  const std::string metric = parameters.text("kmeans.distance");
  Settings settings{};
  settings.arity = number("kmeans.arity");
  settings.k = number("kmeans.k");
  if (settings.arity > 2 && settings.arity != settings.k)
    throw InputError("kmeans.arity = " + std::to_string(settings.arity) + ": expected the same kmeans.k, got " +
                     std::to_string(settings.k));
  settings.draws = number("kmeans.p");
  settings.iterations = number("kmeans.i");
  settings.seed = number("kmeans.seed");
  settings.chunkSize = number("kmeans.chunk");
  settings.leafQueueBelow = number("kmeans.m") * settings.k;
  settings.metric = metric == "manhattan"    ? Metric::manhattan
                    : metric == "chebyshev"  ? Metric::chebyshev
                    : metric == "union-area" ? Metric::unionArea
                                             : Metric::euclid;
  settings.plusPlus = parameters.text("kmeans.seeding") == "plusplus";
  return settings;
}

OpenTree build(const Device& device, const Primitives& input, const Settings& settings) {
  if (input.count == 0) return {};
  return Build(device, input, settings).run(input);
}

void watchPasses(const Device& device, const Primitives& input, const Settings& settings, PassWatch& watch) {
  if (input.count > 0) Build(device, input, settings).passes(&watch);
}

}  // namespace kmeans

namespace {

OpenTree buildKmeans(const Device& device, const Primitives& input, const Parameters& parameters) {
  return kmeans::build(device, input, kmeans::settingsOf(parameters));
}

}  // namespace

namespace methods {

Method kmeans() {
  return {
      .name = "kmeans",
      .source = "Meister and Bittner 2016",
      .meaning = "k-means clustering from the top, agglomeration of each node's k clusters",
      .page = "docs/builders/kmeans.md",
      .build = buildKmeans,
      .parameters =
          {{.name = "kmeans.k", .standard = 8, .min = 2, .max = 64, .meaning = "clusters that a node is split into"},
           {.name = "kmeans.p",
            .standard = 5,
            .min = 1,
            .max = 64,
            .meaning = "candidates drawn for each representative"},
           {.name = "kmeans.i",
            .standard = 2,
            .min = 0,
            .max = 100,
            .meaning = "iterations of the k-means loop; 0 takes the drawn representatives"},
           {.name = "kmeans.m",
            .standard = 4,
            .min = 1,
            .max = 64,
            .meaning = "nodes of fewer than m·k triangles are split in two instead of k; the paper's value is 8"},
           {.name = "kmeans.arity",
            .standard = 2,
            .min = 2,
            .max = maxArity,
            .meaning = "maximum children per node: 2 joins clusters in pairs; more keeps them as siblings and sets "
                       "kmeans.k"},
           {.name = "kmeans.chunk",
            .standard = 0,
            .min = 0,
            .max = 65536,
            .meaning = "triangles that a team processes at a time, a multiple of 32; 0: by size. Changes the time, "
                       "not the tree"},
           {.name = "kmeans.seed", .standard = 1, .min = 0, .max = 4294967295.0, .meaning = "seed of the draws"},
           {.name = "kmeans.seeding",
            .standard = "candidates",
            .words = {"candidates", "plusplus"},
            .meaning =
                "how representatives are drawn: the farthest of p candidates, as in the paper, or as k-means++ does"},
           {.name = "kmeans.distance",
            .standard = "euclid",
            .words = {"euclid", "manhattan", "chebyshev", "union-area"},
            .meaning = "distance between boxes: euclid, the paper's, is the sum of squares over the six coordinates"}},
      .phases = {std::begin(kmeans::phases::all), std::end(kmeans::phases::all)},
      .presets =
          {{"kmeans-q1", "k-means with k = 8, p = 5, i = 0", {{"kmeans.k", 8}, {"kmeans.p", 5}, {"kmeans.i", 0}}},
           {"kmeans-q2", "k-means with k = 8, p = 5, i = 2", {{"kmeans.k", 8}, {"kmeans.p", 5}, {"kmeans.i", 2}}},
           {"kmeans-q3", "k-means with k = 16, p = 5, i = 5", {{"kmeans.k", 16}, {"kmeans.p", 5}, {"kmeans.i", 5}}},
           {"kmeans-q4", "k-means with k = 32, p = 20, i = 10", {{"kmeans.k", 32}, {"kmeans.p", 20}, {"kmeans.i", 10}}},
           {"kmeans-q5", "k-means with k = 64, p = 30, i = 15", {{"kmeans.k", 64}, {"kmeans.p", 30}, {"kmeans.i", 15}}},
           {"kmeans-r1", "k-means with k = 8, p = 5; the paper's plots vary i", {{"kmeans.k", 8}, {"kmeans.p", 5}}},
           {"kmeans-r2", "k-means with k = 16, p = 5; the paper's plots vary i", {{"kmeans.k", 16}, {"kmeans.p", 5}}},
           {"kmeans-r3", "k-means with k = 32, p = 20; the paper's plots vary i", {{"kmeans.k", 32}, {"kmeans.p", 20}}},
           {"kmeans-r4",
            "k-means with k = 64, p = 30; the paper's plots vary i",
            {{"kmeans.k", 64}, {"kmeans.p", 30}}}},
      .derive = kmeans::widthIsK,
      .passClusters = kmeans::passClusters};
}

}  // namespace methods

}  // namespace copse
