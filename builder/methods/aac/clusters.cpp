// Shortening lists of clusters, eight distances at a time.
#include "builder/methods/aac/clusters.h"

#include <algorithm>
#include <cmath>

#include "builder/math/simd.h"
#include "builder/parallel/bits.h"

namespace copse::aac {

namespace {

constexpr uint32_t lanes = 8;

I32x8 places(uint32_t all) { return I32x8(static_cast<int32_t>(all)); }

/// Calls see(i) for each i below `count` with values[i] == value.
template <class See>
void forEachEqual(const float* values, uint32_t count, float value, const See& see) {
  for (uint32_t begin = 0; begin < count; begin += lanes)
    for (uint32_t bits = (F32x8::load(values + begin) == F32x8(value)).bits(); bits; bits &= bits - 1)
      if (begin + lowestBit(bits) < count) see(begin + lowestBit(bits));
}

}  // namespace

uint32_t keptOf(uint32_t delta, double epsilon, uint32_t count) {
  const double kept = 0.5 * delta * std::pow(static_cast<double>(count) / delta, 0.5 - epsilon);
  return std::max(1u, static_cast<uint32_t>(std::ceil(kept * (1 - 1e-9))));  // A whole number may come out just above.
}

void Shortener::put(uint32_t at, const Cluster& cluster) {
  for (int axis = 0; axis < 3; ++axis) {
    lo_[axis][at] = cluster.box.lo[axis];
    negatedHi_[axis][at] = -cluster.box.hi[axis];
  }
  node_[at] = cluster.node;
  spare_[at] = cluster.spare;
  size_[at] = cluster.size;
  setNearest(at, {cluster.distance, cluster.nearest});
}

Cluster Shortener::at(uint32_t place) const {
  Cluster cluster;
  for (int axis = 0; axis < 3; ++axis) {
    cluster.box.lo[axis] = lo_[axis][place];
    cluster.box.hi[axis] = -negatedHi_[axis][place];
  }
  cluster.node = node_[place];
  cluster.spare = spare_[place];
  cluster.size = size_[place];
  cluster.nearest = nearest_[place];
  cluster.distance = distance_[place];
  return cluster;
}

void Shortener::load(const std::vector<Cluster>& list, uint32_t half) {
  count_ = static_cast<uint32_t>(list.size());
  if (seen_.size() < count_ + lanes) {
    const std::size_t room = 2 * std::size_t{count_} + lanes;  // What is past the end is read, and left out.
    for (int axis = 0; axis < 3; ++axis) lo_[axis].resize(room), negatedHi_[axis].resize(room);
    for (std::vector<float>* values : {&distance_, &seen_}) values->resize(room);
    for (std::vector<uint32_t>* values : {&nearest_, &node_, &spare_, &size_}) values->resize(room);
  }
  for (uint32_t i = 0; i < count_; ++i) {
    put(i, list[i]);
    if (i >= half) nearest_[i] += half;
  }
}

/// Ties go to fewer boxes, then to the place that differs in lower bits: equal clusters pair up, two and two.
bool Shortener::nearer(uint32_t of, const Nearest& a, const Nearest& b) const {
  if (a.distance != b.distance) return a.distance < b.distance;
  if (a.distance == Cluster::nothing) return false;
  if (size_[a.place] != size_[b.place]) return size_[a.place] < size_[b.place];
  return (a.place ^ of) < (b.place ^ of);
}

/// Among places begin … end-1 but for its own. What is no number, of boxes that reach to infinity, is the furthest.
Shortener::Nearest Shortener::findNearest(uint32_t of, uint32_t begin, uint32_t end) {
  constexpr float furthest = std::numeric_limits<float>::max();
  F32x8 lo[3], negatedHi[3];
  for (int axis = 0; axis < 3; ++axis) {
    lo[axis] = F32x8(lo_[axis][of]);
    negatedHi[axis] = F32x8(negatedHi_[axis][of]);
  }
  const I32x8 own = places(of), last = places(end - 1);
  I32x8 place = places(begin) + I32x8(I32x4(0, 1, 2, 3), I32x4(4, 5, 6, 7));
  F32x8 nearest(Cluster::nothing);
  for (uint32_t i = begin; i < end; i += lanes, place = place + places(lanes)) {
    F32x8 d[3];  // Extents of the union, negated.
    for (int axis = 0; axis < 3; ++axis)
      d[axis] = minOf(lo[axis], F32x8::load(&lo_[axis][i])) + minOf(negatedHi[axis], F32x8::load(&negatedHi_[axis][i]));
    F32x8 area = d[0] * d[1] + (d[0] + d[1]) * d[2];
    area = minOf(area, F32x8(furthest));
    area = select((place == own) | (last < place), F32x8(Cluster::nothing), area);
    area.store(&seen_[i - begin]);
    nearest = minOf(area, nearest);
  }
  const float distance = minLane(nearest);
  Nearest best;
  if (distance == Cluster::nothing) return best;
  forEachEqual(seen_.data(), end - begin, distance, [&](uint32_t i) {
    const Nearest other{distance, begin + i};
    if (nearer(of, other, best)) best = other;
  });
  return best;
}

uint32_t Shortener::firstOfClosestPair() {
  for (uint32_t i = count_; i < count_ + lanes; ++i) distance_[i] = Cluster::nothing;
  F32x8 nearest(Cluster::nothing);
  for (uint32_t i = 0; i < count_; i += lanes) nearest = minOf(F32x8::load(&distance_[i]), nearest);
  uint32_t best = 0, bestSize = ~0u;
  forEachEqual(distance_.data(), count_, minLane(nearest), [&](uint32_t i) {
    const uint32_t size = size_[i] + size_[nearest_[i]];
    if (size >= bestSize) return;
    best = i;
    bestSize = size;
  });
  return best;
}

/// The union takes the first place and the last cluster the second.
void Shortener::join(uint32_t first, uint32_t second, const Joined& joined) {
  const Cluster a = at(first), b = at(second);
  Cluster both;
  both.box = unite(a.box, b.box);
  both.node = std::max(a.spare, b.spare) - 1;
  both.spare = std::min(a.spare, b.spare);
  both.size = a.size + b.size;
  joined.nodes[both.node] = BvhNode::inner(both.box, a.node, b.node);
  joined.parents[a.node] = both.node;
  joined.parents[b.node] = both.node;

  const uint32_t last = --count_;
  put(second, at(last));  // Where it is the second itself, that is out of the list now.
  put(first, both);
  setNearest(first, findNearest(first, 0, count_));
  // No other's nearest changes but that of those that were nearest to one of the two: the union is further.
  for (uint32_t begin = 0; begin < count_; begin += lanes) {
    const U32x8 nearest = U32x8::load(&nearest_[begin]);
    const SimdMask<8> gone = (nearest == U32x8(first)) | (nearest == U32x8(second)) | (nearest == U32x8(last));
    for (uint32_t bits = gone.bits(); bits; bits &= bits - 1) {
      const uint32_t i = begin + lowestBit(bits);
      if (i >= count_ || i == first) continue;
      if (nearest_[i] == last && last != second)
        nearest_[i] = second;
      else
        setNearest(i, findNearest(i, 0, count_));
    }
  }
}

void Shortener::shorten(std::vector<Cluster>& list, uint32_t half, uint32_t target, const Joined& joined) {
  load(list, half);
  for (uint32_t i = 0; i < count_; ++i) {
    const bool inFirst = i < half;
    const Nearest known{distance_[i], nearest_[i]};
    const Nearest across = findNearest(i, inFirst ? half : 0, inFirst || half == 0 ? count_ : half);
    if (nearer(i, across, known)) setNearest(i, across);
  }
  while (count_ > target) {
    const uint32_t i = firstOfClosestPair(), j = nearest_[i];
    join(std::min(i, j), std::max(i, j), joined);
  }
  list.resize(count_);
  for (uint32_t i = 0; i < count_; ++i) list[i] = at(i);
}

}  // namespace copse::aac
