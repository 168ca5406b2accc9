// Numbers the nodes of a binary tree level by level, siblings side by side, without a wait of the host. The numbers
// depend on the tree alone: not on threads, and not on the device. O(n). Only .cu files include this.
//
// On CUDA one cooperative kernel goes through the levels: a large level is cut among the blocks, which count its inner
// nodes, meet, write their part, and meet again; small ones are one block's. On the CPU the tree is cut into parts that
// fit into a thread's cache, and a part's levels are gone through while it is there: where each begins follows from how
// many nodes every part has on each level.
#pragma once

#include <algorithm>
#include <cstdint>
#include <type_traits>
#include <utility>
#include <vector>

#include "builder/parallel/buffer.h"
#include "builder/parallel/launch_warps.h"

#if defined(__CUDACC__)
#include <cooperative_groups.h>
#endif

namespace copse {

namespace detail {

/// The CPU's way.
template <class Tree>
class BreadthFirst {
 public:
  using Item = typename Tree::Item;

  BreadthFirst(const Device& device, const Tree& tree) : device_(device), tree_(tree) {}

  void run(const Item& root) {
    cut(root);
    const int64_t count = static_cast<int64_t>(parts_.size());
#pragma omp parallel num_threads(device_.threads) if (count > 1)
    {
      std::vector<Item> queue;
#pragma omp for schedule(dynamic, 1)
      for (int64_t p = 0; p < count; ++p)
        if (parts_[p].whole) countLevels(parts_[p], queue);
    }
    place();
#pragma omp parallel num_threads(device_.threads) if (count > 1)
    {
      std::vector<Item> queue;
#pragma omp for schedule(dynamic, 1)
      for (int64_t p = 0; p < count; ++p) {
        const Part& part = parts_[p];
        Item left, right;
        if (part.whole)
          writeLevels(part, queue);
        else
          tree_.write(part.root, part.at, parts_[p + 1].at, left, right);  // The next is its left child.
      }
    }
  }

 private:
  /// A node with all that is below it, or a node alone, whose children's parts follow.
  struct Part {
    Item root;
    uint32_t level;
    bool whole;
    uint32_t at = 0;              ///< The root's number.
    std::vector<uint32_t> below;  ///< Nodes on each level below the root; later the number of the first.
  };

  static constexpr uint32_t leavesInCache = 4096;  ///< Nodes of 32 bytes, read and written: half a megabyte.
  static constexpr std::size_t ahead = 32;         ///< Nodes between a request for memory and its use.

  /// In the order in which a walk, left before right, first comes to their roots.
  void cut(const Item& root) {
    const uint32_t share = tree_.leaves(root) / (16u * static_cast<uint32_t>(device_.threads));
    const uint32_t most = std::clamp(share, 64u, leavesInCache);
    std::vector<Part> waiting{{root, 0, false, 0, {}}};
    while (!waiting.empty()) {
      Part part = std::move(waiting.back());
      waiting.pop_back();
      part.whole = tree_.leaves(part.root) <= most;
      if (!part.whole) {
        Item left, right;
        tree_.children(part.root, left, right);
        waiting.push_back({right, part.level + 1, false, 0, {}});
        waiting.push_back({left, part.level + 1, false, 0, {}});
      }
      parts_.push_back(std::move(part));
    }
  }

  void countLevels(Part& part, std::vector<Item>& queue) const {
    if (!tree_.isInner(part.root)) return;
    room(part, queue);
    Item* const items = queue.data();
    for (std::size_t begin = 0, end = 1; begin < end;) {
      part.below.push_back(2 * static_cast<uint32_t>(end - begin));
      for (const std::size_t levelEnd = end; begin < levelEnd; ++begin) {
        tree_.prefetchNode(items[begin + ahead]);
        Item left, right;
        tree_.children(items[begin], left, right);
        items[end] = left;  // Whether a child is inner cannot be foreseen: no branch asks.
        end += tree_.isInner(left);
        items[end] = right;
        end += tree_.isInner(right);
      }
    }
  }

  void place() {
    std::vector<uint32_t> next;  // Of each level: its nodes, then the number of the next one to be placed.
    const auto atLevel = [&](std::size_t level) -> uint32_t& {
      if (level >= next.size()) next.resize(level + 1, 0);
      return next[level];
    };
    for (const Part& part : parts_) {
      ++atLevel(part.level);
      for (std::size_t k = 0; k < part.below.size(); ++k) atLevel(part.level + 1 + k) += part.below[k];
    }
    uint32_t before = 0;
    for (uint32_t& level : next) before += std::exchange(level, before);
    for (Part& part : parts_) {
      part.at = next[part.level]++;
      for (std::size_t k = 0; k < part.below.size(); ++k) {
        uint32_t& level = next[part.level + 1 + k];
        level += std::exchange(part.below[k], level);
      }
    }
  }

  void writeLevels(const Part& part, std::vector<Item>& queue) const {
    room(part, queue);
    Item* const items = queue.data();
    uint32_t at = part.at;
    auto below = part.below.begin();
    for (std::size_t begin = 0, end = 1; begin < end;) {
      const uint32_t nextAt = below != part.below.end() ? *below++ : 0;
      uint32_t child = nextAt;
      for (const std::size_t levelEnd = end; begin < levelEnd; ++begin) {
        tree_.prefetchNode(items[begin + ahead]);
        const Item item = items[begin];
        tree_.write(item, at++, child, items[end], items[end + 1]);
        const uint32_t children = 2 * tree_.isInner(item);
        end += children;
        child += children;
      }
      at = nextAt;
    }
  }

  /// For the part's nodes, for those asked for ahead, and for two that a leaf does not have.
  void room(const Part& part, std::vector<Item>& queue) const {
    const std::size_t most = 2 * std::size_t{tree_.leaves(part.root)} + 1 + ahead;
    if (queue.size() < most) queue.resize(most, part.root);
    queue[0] = part.root;
  }

  const Device& device_;
  const Tree& tree_;
  std::vector<Part> parts_;
};

#if defined(__CUDACC__)
constexpr uint32_t breadthFirstThreads = 256;

/// Of all threads of the block.
__device__ inline uint32_t sumOfBlock(uint32_t value, uint32_t* ofWarps) {
  for (uint32_t step = 16; step > 0; step /= 2) value += __shfl_xor_sync(~0u, value, step);
  if (threadIdx.x % 32 == 0) ofWarps[threadIdx.x / 32] = value;
  __syncthreads();
  uint32_t sum = 0;
  for (uint32_t w = 0; w < breadthFirstThreads / 32; ++w) sum += ofWarps[w];
  __syncthreads();  // Before the next sum writes there.
  return sum;
}

/// Writes items `from` to `to`-1 of a level in their order, their children's from `child` on, and returns where the
/// next children go. By all threads of the block.
template <class Tree>
__device__ uint32_t writeRows(const Tree& tree, typename Tree::Item* items, uint32_t from, uint32_t to, uint32_t child,
                              uint32_t* ofWarps) {
  using Item = typename Tree::Item;
  const uint32_t thread = threadIdx.x;
  for (uint32_t row = from; row < to; row += breadthFirstThreads) {
    const uint32_t i = row + thread;
    const Item item = items[i < to ? i : row];
    const bool isInner = i < to && tree.isInner(item);
    const uint32_t innerOfWarp = __ballot_sync(~0u, isInner);
    if (thread % 32 == 0) ofWarps[thread / 32] = __popc(innerOfWarp);
    __syncthreads();
    uint32_t rank = __popc(innerOfWarp & ((1u << thread % 32) - 1)), ofRow = 0;
    for (uint32_t w = 0; w < breadthFirstThreads / 32; ++w) {
      rank += w < thread / 32 ? ofWarps[w] : 0;
      ofRow += ofWarps[w];
    }
    __syncthreads();  // Before the next row writes there.
    if (i < to) {
      const uint32_t firstChild = child + 2 * rank;
      Item left, right;
      tree.write(item, i, firstChild, left, right);
      if (isInner) {
        items[firstChild] = left;
        items[firstChild + 1] = right;
      }
    }
    child += 2 * ofRow;
  }
  return child;
}

/// `items` has room for the whole tree, `counts` for the blocks and two more. All blocks must be resident.
template <class Tree>
__global__ void __launch_bounds__(breadthFirstThreads, 4)
    breadthFirstOnGrid(Tree tree, typename Tree::Item root, typename Tree::Item* items, uint32_t* counts) {
  __shared__ uint32_t ofWarps[breadthFirstThreads / 32];
  const cooperative_groups::grid_group grid = cooperative_groups::this_grid();
  const uint32_t thread = threadIdx.x, block = blockIdx.x, blocks = gridDim.x;
  uint32_t* const reached = counts + blocks;  // The level that the first block has come to by itself.
  if (block == 0 && thread == 0) items[0] = root;
  for (uint32_t begin = 0, end = 1; begin < end;) {
    // Small levels, the first and often the last ones, are the first block's, which need not meet the others for them.
    if (end - begin <= breadthFirstThreads) {
      if (block == 0) {
        while (begin < end && end - begin <= breadthFirstThreads) {
          __syncthreads();  // The level has been written by then.
          const uint32_t next = writeRows(tree, items, begin, end, end, ofWarps);
          begin = end;
          end = next;
        }
        if (thread == 0) reached[0] = begin, reached[1] = end;
      }
      grid.sync();
      begin = reached[0];
      end = reached[1];
      continue;
    }
    // The block's own run of the level: whole rows of threads, so that only one block has a row that is not full.
    const uint32_t rows = (end - begin - 1) / breadthFirstThreads + 1;
    const uint32_t share = ((rows - 1) / blocks + 1) * breadthFirstThreads;
    const uint64_t offset = uint64_t{block} * share;
    const uint32_t from = offset < end - begin ? begin + static_cast<uint32_t>(offset) : end;
    const uint32_t to = share < end - from ? from + share : end;

    uint32_t inner = 0;
    for (uint32_t i = from + thread; i < to; i += breadthFirstThreads) inner += tree.isInner(items[i]);
    inner = sumOfBlock(inner, ofWarps);
    if (thread == 0) counts[block] = inner;
    grid.sync();

    uint32_t before = 0, all = 0;
    for (uint32_t b = thread; b < blocks; b += breadthFirstThreads) {
      all += counts[b];
      before += b < block ? counts[b] : 0;
    }
    all = sumOfBlock(all, ofWarps);
    writeRows(tree, items, from, to, end + 2 * sumOfBlock(before, ofWarps), ofWarps);
    grid.sync();
    begin = end;
    end += 2 * all;
  }
}

template <class Tree>
void runBreadthFirst(const Device& device, const char* name, uint32_t count, Tree tree, typename Tree::Item root) {
  // More blocks than this keep no more requests for memory under way that are needed, and take longer to meet.
  constexpr uint32_t blocksPerProcessor = 4;
  const void* const kernel = reinterpret_cast<const void*>(&breadthFirstOnGrid<Tree>);
  const uint32_t blocks = std::min((count - 1) / breadthFirstThreads + 1,
                                   residentBlocks(device, kernel, breadthFirstThreads, 0, blocksPerProcessor));
  Buffer<typename Tree::Item> items(device, count);
  Buffer<uint32_t> counts(device, std::size_t{blocks} + 2);
  auto* itemsData = items.data();
  uint32_t* countsData = counts.data();
  void* arguments[] = {&tree, &root, &itemsData, &countsData};
  beforeLaunch(device, name);
  cudaLaunchCooperativeKernel(kernel, dim3(blocks), dim3(breadthFirstThreads), arguments, 0,
                              static_cast<cudaStream_t>(device.stream));
  checkLaunch(device, name);
}
#endif

}  // namespace detail

/// Calls write() once for every node of the tree below `root`, which has `count` nodes, at least one, with its place:
/// the root's is 0, then level by level, each from left to right; the two children of a node stand side by side.
///
/// Tree is trivially copyable and has
///   Item, trivially copyable, which stands for a node;
///   HD bool isInner(const Item&) const;
///   HD void children(const Item&, Item& left, Item& right) const, of an inner node;
///   HD void write(const Item&, uint32_t at, uint32_t firstChild, Item& left, Item& right) const, which may leave
///     anything in `left` and `right` for a leaf, and the same as children() for an inner node;
/// and for the CPU
///   uint32_t leaves(const Item&) const, below it;
///   HD void prefetchNode(const Item&) const, which must bear any item that it was given.
template <class Tree>
void breadthFirst(const Device& device, const char* name, [[maybe_unused]] uint32_t count, const Tree& tree,
                  const typename Tree::Item& root) {
  static_assert(std::is_trivially_copyable_v<Tree> && std::is_trivially_copyable_v<typename Tree::Item>);
  Phase phase(device, name);
  if (device.timeline) device.timeline->countLaunch();
#if defined(__CUDACC__)
  if (device.isCuda()) return detail::runBreadthFirst(device, name, count, tree, root);
#endif
  detail::BreadthFirst<Tree>(device, tree).run(root);
}

}  // namespace copse
