// Median-split, chain-shaped and one-leaf trees on the host.
#include "tests/support/trees.h"

#include <algorithm>
#include <numeric>
#include <random>

#include "tracer/accel/tracers.h"

namespace copse::test {

namespace {

Box boxOf(const TestMesh& mesh, uint32_t triangle) {
  Box box;
  for (int k = 0; k < 3; ++k) box.grow(mesh.positions[mesh.indices[triangle][k]]);
  return box;
}

Bvh upload(const Device& device, const std::vector<BvhNode>& nodes, const std::vector<uint32_t>& order) {
  Bvh bvh;
  bvh.nodeCount = static_cast<uint32_t>(nodes.size());
  bvh.referenceCount = bvh.triangleCount = static_cast<uint32_t>(order.size());
  bvh.nodes = Buffer<BvhNode>(device, nodes);
  bvh.order = Buffer<uint32_t>(device, order);
  return bvh;
}

}  // namespace

Bvh medianTree(const Device& device, const TestMesh& mesh, uint32_t leaf) {
  std::vector<uint32_t> order(mesh.count());
  std::iota(order.begin(), order.end(), 0u);
  std::vector<BvhNode> nodes;
  struct Task {
    uint32_t node, begin, end;
  };
  std::vector<Task> tasks;
  if (!order.empty()) {
    nodes.emplace_back();
    tasks.push_back({0, 0, mesh.count()});
  }
  while (!tasks.empty()) {
    const Task task = tasks.back();
    tasks.pop_back();
    Box box, centres;
    for (uint32_t i = task.begin; i < task.end; ++i) {
      box.grow(boxOf(mesh, order[i]));
      centres.grow(boxOf(mesh, order[i]).centre2());
    }
    if (task.end - task.begin <= leaf) {
      nodes[task.node] = BvhNode::leaf(box, task.begin, task.end - task.begin);
      continue;
    }
    const vec3 size = centres.hi - centres.lo;
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const uint32_t middle = (task.begin + task.end) / 2;
    std::nth_element(order.begin() + task.begin, order.begin() + middle, order.begin() + task.end,
                     [&](uint32_t a, uint32_t b) {
                       const float ca = boxOf(mesh, a).centre2()[axis], cb = boxOf(mesh, b).centre2()[axis];
                       return ca != cb ? ca < cb : a < b;
                     });
    const uint32_t left = static_cast<uint32_t>(nodes.size());
    nodes.resize(nodes.size() + 2);
    nodes[task.node] = BvhNode::inner(box, left, left + 1);
    tasks.push_back({left, task.begin, middle});
    tasks.push_back({left + 1, middle, task.end});
  }
  return upload(device, nodes, order);
}

Bvh chainTree(const Device& device, const TestMesh& mesh) {
  const uint32_t n = mesh.count();
  std::vector<uint32_t> order(n);
  std::iota(order.begin(), order.end(), 0u);
  std::vector<BvhNode> nodes(n ? 2 * n - 1 : 0);
  Box below;
  for (uint32_t i = n; i-- > 0;) {  // Node 2i has the triangles from i on; node 2i+1 is the leaf of triangle i.
    below.grow(boxOf(mesh, i));
    if (i == n - 1) {
      nodes[2 * i] = BvhNode::leaf(below, i, 1);
    } else {
      nodes[2 * i] = BvhNode::inner(below, 2 * i + 1, 2 * i + 2);
      nodes[2 * i + 1] = BvhNode::leaf(boxOf(mesh, i), i, 1);
    }
  }
  return upload(device, nodes, order);
}

Bvh leafTree(const Device& device, const TestMesh& mesh) {
  std::vector<uint32_t> order(mesh.count());
  std::iota(order.begin(), order.end(), 0u);
  Box box;
  for (uint32_t i = 0; i < mesh.count(); ++i) box.grow(boxOf(mesh, i));
  std::vector<BvhNode> nodes;
  if (mesh.count()) nodes.push_back(BvhNode::leaf(box, 0, mesh.count()));
  return upload(device, nodes, order);
}

std::vector<Ray> raysAround(const TestMesh& mesh, uint32_t count, uint32_t seed) {
  std::mt19937 random(seed);
  auto uniform = [&] { return static_cast<float>(random() >> 8) / (1 << 24); };
  Box box;
  for (uint32_t i = 0; i < mesh.count(); ++i) box.grow(boxOf(mesh, i));
  if (box.empty()) box.grow(vec3(0)), box.grow(vec3(1));
  const vec3 size = box.hi - box.lo;
  const float extent = std::max({size.x, size.y, size.z, 1e-30f});
  auto inBox = [&] { return box.lo + size * vec3(uniform(), uniform(), uniform()); };
  std::vector<Ray> rays(count);
  for (uint32_t i = 0; i < count; ++i) {
    vec3 origin = inBox();
    if (i % 2) origin += extent * (vec3(uniform(), uniform(), uniform()) - 0.5f) * 4.0f;
    vec3 direction;
    if (i % 7 == 6 || mesh.count() == 0) {
      direction = vec3(0);
      direction[random() % 3] = random() % 2 ? extent : -extent;
      if (random() % 2 && mesh.count()) origin = mesh.positions[mesh.indices[random() % mesh.count()][0]] - direction;
    } else if (i % 7 == 5) {
      direction = inBox() - origin;
    } else {
      const uvec3 t = mesh.indices[random() % mesh.count()];
      float u = uniform(), v = uniform();
      if (u + v > 1) u = 1 - u, v = 1 - v;
      if (i % 7 == 0) v = 0;   // On an edge,
      if (i % 14 == 0) u = 0;  // at a vertex.
      const vec3 a = mesh.positions[t.x], b = mesh.positions[t.y], c = mesh.positions[t.z];
      direction = (1 - u - v) * a + u * b + v * c - origin;
    }
    rays[i] = {origin, 0, direction, i % 5 == 4 ? 1.5f : 1e30f};
  }
  return rays;
}

std::vector<Hit> hitsOf(const Device& device, const Bvh& tree, const TestMesh& mesh, const std::vector<Ray>& rays) {
  const DeviceMesh there(device, mesh);
  const Buffer<Ray> from(device, rays);
  Buffer<Hit> to(device, rays.size());
  makeTracer(device, tree, there.view())
      ->closest(device, "closest", static_cast<uint32_t>(rays.size()), from.data(), to.data());
  return to.toHost();
}

}  // namespace copse::test
