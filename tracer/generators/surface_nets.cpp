// The grid is walked in slabs of eight layers from the bottom up. A slab's blocks of eight cubed cells are sampled side
// by side, each by halving down to where the surface cannot be far, then vertices and quads are made layer by layer in
// a fixed order: two planes of indices are all that is kept.
#include "tracer/generators/surface_nets.h"

#include <cmath>

namespace copse::generator {

namespace {

constexpr int side = 8, corners = side + 1;
constexpr float unset = 4e9f, farOff = 1e9f;  ///< No sample yet; only its sign is known.

struct Block {
  int x, z;  ///< Those of its first cell.
  std::vector<float> samples;

  float& at(int i, int j, int k) { return samples[static_cast<std::size_t>((j * corners + k) * corners + i)]; }
  float at(int i, int j, int k) const { return samples[static_cast<std::size_t>((j * corners + k) * corners + i)]; }
};

class Mesher {
 public:
  Mesher(const DistanceField& field, double cell) : field_(field), cell_(cell), lo_(field.lowest()) {
    const dvec3 size = (field.highest() - lo_) / cell;
    for (int a = 0; a < 3; ++a) blocks_[a] = static_cast<int>(std::ceil(size[a] / side));
    columns_ = blocks_[0] * side;
    const std::size_t plane = static_cast<std::size_t>(columns_) * static_cast<std::size_t>(blocks_[2] * side);
    below_.resize(plane);
    current_.resize(plane);
  }

  QuadMesh run() {
    for (int slab = 0; slab < blocks_[1]; ++slab) {
      const std::vector<Block> blocks = sampleSlab(slab * side);
      for (int layer = 0; layer < side; ++layer) {
        std::swap(below_, current_);
        for (const Block& block : blocks) addVertices(block, slab * side, layer);
        for (const Block& block : blocks) addQuads(block, layer);
      }
    }
    return std::move(mesh_);
  }

 private:
  dvec3 place(double i, double j, double k) const { return lo_ + cell_ * dvec3(i, j, k); }

  /// How far the surface must be from the middle of `size` cubed cells not to pass through them.
  double reach(int size) const { return field_.steepness() * 0.5 * std::sqrt(3.0) * size * cell_; }

  /// The blocks of a slab that the surface may pass through, sampled wherever it may be near.
  std::vector<Block> sampleSlab(int y) {
    const int across = blocks_[0], count = across * blocks_[2];
    std::vector<Block> all(static_cast<std::size_t>(count));
#pragma omp parallel for schedule(dynamic, 4)
    for (int b = 0; b < count; ++b) {
      Block& block = all[static_cast<std::size_t>(b)];
      block.x = b % across * side;
      block.z = b / across * side;
      constexpr double half = 0.5 * side;
      if (std::abs(field_.distance(place(block.x + half, y + half, block.z + half))) > reach(side)) continue;
      block.samples.assign(corners * corners * corners, unset);
      sample(block, y, 0, 0, 0, side);
    }
    std::erase_if(all, [](const Block& block) { return block.samples.empty(); });
    return all;
  }

  void sample(Block& block, int y, int i0, int j0, int k0, int size) const {
    const auto distance = [&](double i, double j, double k) {
      return field_.distance(place(block.x + i, y + j, block.z + k));
    };
    const double half = 0.5 * size;
    const double middle = distance(i0 + half, j0 + half, k0 + half);
    const bool passed = std::abs(middle) <= reach(size);
    if (passed && size > 2) {
      for (int c = 0; c < 8; ++c)
        sample(block, y, i0 + (c & 1) * size / 2, j0 + (c >> 1 & 1) * size / 2, k0 + (c >> 2) * size / 2, size / 2);
      return;
    }
    for (int j = j0; j <= j0 + size; ++j)
      for (int k = k0; k <= k0 + size; ++k)
        for (int i = i0; i <= i0 + size; ++i) {
          float& value = block.at(i, j, k);
          if (passed && std::abs(value) >= farOff)
            value = static_cast<float>(distance(i, j, k));
          else if (value == unset)
            value = middle < 0 ? -farOff : farOff;
        }
  }

  /// One vertex per cell that the surface passes: the mean of where it cuts the cell's edges.
  void addVertices(const Block& block, int y, int j) {
    for (int k = 0; k < side; ++k)
      for (int i = 0; i < side; ++i) {
        float value[8];
        int inside = 0;
        for (int c = 0; c < 8; ++c) {
          value[c] = block.at(i + (c & 1), j + (c >> 1 & 1), k + (c >> 2));
          inside += value[c] < 0;
        }
        if (inside == 0 || inside == 8) continue;
        dvec3 sum(0);
        int cuts = 0;
        for (int c = 0; c < 8; ++c)
          for (int a = 0; a < 3; ++a) {
            const int d = c | 1 << a;
            if (c == d || (value[c] < 0) == (value[d] < 0)) continue;
            dvec3 cut(c & 1, c >> 1 & 1, c >> 2);
            cut[a] = static_cast<double>(value[c]) / (static_cast<double>(value[c]) - value[d]);
            sum += cut;
            ++cuts;
          }
        // Kept off the cell's border: no two vertices may fall into one.
        const dvec3 mean = 0.02 + 0.96 * sum / static_cast<double>(cuts);
        index(block.x + i, block.z + k) = static_cast<uint32_t>(mesh_.positions.size());
        mesh_.positions.push_back(vec3(place(block.x + i + mean.x, y + j + mean.y, block.z + k + mean.z)));
      }
  }

  /// One quad an edge that the surface cuts, between the four cells around that edge.
  void addQuads(const Block& block, int j) {
    for (int k = 0; k < side; ++k)
      for (int i = 0; i < side; ++i) {
        const bool in = block.at(i, j, k) < 0;
        const int x = block.x + i, z = block.z + k;
        const auto add = [&](uint32_t a, uint32_t b, uint32_t c, uint32_t d) {
          if (in)
            mesh_.quads.push_back({a, b, c, d});
          else
            mesh_.quads.push_back({d, c, b, a});
        };
        if (in != (block.at(i + 1, j, k) < 0)) add(under(x, z - 1), index(x, z - 1), index(x, z), under(x, z));
        if (in != (block.at(i, j + 1, k) < 0)) add(index(x - 1, z - 1), index(x - 1, z), index(x, z), index(x, z - 1));
        if (in != (block.at(i, j, k + 1) < 0)) add(under(x - 1, z), under(x, z), index(x, z), index(x - 1, z));
      }
  }

  uint32_t& index(int x, int z) { return current_[static_cast<std::size_t>(z) * columns_ + x]; }
  uint32_t under(int x, int z) const { return below_[static_cast<std::size_t>(z) * columns_ + x]; }

  const DistanceField& field_;
  double cell_;
  dvec3 lo_;
  int blocks_[3];
  std::size_t columns_;
  std::vector<uint32_t> below_, current_;  ///< A layer's vertices by cell; what no vertex is in is never asked for.
  QuadMesh mesh_;
};

}  // namespace

QuadMesh surfaceNets(const DistanceField& field, double cell) { return Mesher(field, cell).run(); }

}  // namespace copse::generator
