// Numbering level by level: against a plain queue, for trees of every shape, on any number of threads.
#include <cstdint>
#include <deque>
#include <string>
#include <vector>

#include "builder/parallel/breadth_first.h"
#include "tests/support/catch.h"
#include "tests/support/devices.h"

using namespace copse;

namespace {

struct Links {
  uint32_t left, right, leaves;  ///< A leaf has left = right.
};

struct Written {
  uint32_t node, firstChild, times;

  bool operator==(const Written&) const = default;
};

/// Items are nodes' indices.
struct Recorder {
  using Item = uint32_t;

  const Links* nodes;
  Written* written;

  HD bool isInner(Item node) const { return nodes[node].left != nodes[node].right; }
  uint32_t leaves(Item node) const { return nodes[node].leaves; }
  HD void prefetchNode(Item node) const { prefetch(nodes + node); }
  HD void children(Item node, Item& left, Item& right) const {
    left = nodes[node].left;
    right = nodes[node].right;
  }
  HD void write(Item node, uint32_t at, uint32_t firstChild, Item& left, Item& right) const {
    children(node, left, right);
    written[at] = {node, isInner(node) ? firstChild : 0, written[at].times + 1};
  }
};

/// A tree of `leaves` leaves; `leftOf` says how many of them go to the left.
template <class LeftOf>
std::vector<Links> grow(uint32_t leaves, LeftOf leftOf) {
  std::vector<Links> nodes{{0, 0, leaves}};
  for (uint32_t i = 0; i < nodes.size(); ++i) {
    const uint32_t below = nodes[i].leaves;
    if (below == 1) continue;
    const uint32_t left = leftOf(below);
    nodes[i].left = static_cast<uint32_t>(nodes.size());
    nodes[i].right = nodes[i].left + 1;
    nodes.push_back({0, 0, left});
    nodes.push_back({0, 0, below - left});
  }
  // So that no index tells where a node belongs: all but the root change places with their mirror image.
  const uint32_t last = static_cast<uint32_t>(nodes.size());
  const auto moved = [&](uint32_t i) { return i == 0 ? 0 : last - i; };
  std::vector<Links> shuffled(nodes.size());
  for (uint32_t i = 0; i < last; ++i) {
    const bool isLeaf = nodes[i].leaves == 1;
    shuffled[moved(i)] = {isLeaf ? 0 : moved(nodes[i].left), isLeaf ? 0 : moved(nodes[i].right), nodes[i].leaves};
  }
  return shuffled;
}

std::vector<Written> byQueue(const std::vector<Links>& nodes) {
  std::vector<Written> expected;
  std::deque<uint32_t> queue{0};
  uint32_t next = 1;
  for (; !queue.empty(); queue.pop_front()) {
    const Links& node = nodes[queue.front()];
    const bool isInner = node.left != node.right;
    expected.push_back({queue.front(), isInner ? next : 0, 1});
    if (!isInner) continue;
    queue.push_back(node.left);
    queue.push_back(node.right);
    next += 2;
  }
  return expected;
}

void check(const std::string& what, const std::vector<Links>& nodes) {
  const std::vector<Written> expected = byQueue(nodes);
  for (Device device : test::devices()) {
    for (const int threads : {1, 2, 3, 7}) {
      if (device.isCuda() && threads > 1) continue;
      device.threads = threads;
      INFO(what << " on " << device.name << " with threads: " << threads);
      const Buffer<Links> links(device, std::span<const Links>(nodes));
      Buffer<Written> written(device, nodes.size());
      written.fill(0);
      breadthFirst(device, "number", static_cast<uint32_t>(nodes.size()), Recorder{links.data(), written.data()}, 0u);
      CHECK((written.toHost() == expected));
    }
  }
}

}  // namespace

TEST_CASE("nodes are numbered level by level as by a plain queue", "[breadth_first]") {
  for (const uint32_t leaves : {1u, 2u, 3u, 4u, 63u, 64u, 65u, 257u, 4097u, 100000u}) {
    const std::string of = std::to_string(leaves) + " leaves";
    check("a balanced tree of " + of, grow(leaves, [](uint32_t n) { return n / 2; }));
    check("a tree that leans to the left, of " + of, grow(leaves, [](uint32_t n) { return n - (n + 9) / 10; }));
    uint32_t state = 1;
    check("a random tree of " + of, grow(leaves, [&](uint32_t n) {
            state = state * 747796405u + 2891336453u;
            return 1 + (state >> 8) % (n - 1);
          }));
  }
  check("a chain to the right", grow(20000, [](uint32_t) { return 1u; }));
  check("a chain to the left", grow(20000, [](uint32_t n) { return n - 1; }));
}
