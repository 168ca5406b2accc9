// The combination of n values to one, such as the box of all boxes, in a fixed tree: the result, float sums included,
// is the same to the bit on any number of threads and on both devices. Only .cu files include this.
// Cost: one pass over the values, 255 more combinations per tile, and a wait where the host needs the result.
#pragma once

#include <cstdint>
#include <new>
#include <type_traits>
#include <utility>

#include "builder/parallel/buffer.h"
#include "builder/parallel/launch.h"

namespace copse {

namespace detail {

// A tile of values becomes one partial: column c combines values c, c + 256, … of the tile in turn, then the columns
// are halved eight times. On CUDA a column is a thread of a block.
constexpr uint32_t reduceColumns = 256;
constexpr uint32_t reduceTile = 16 * reduceColumns;

constexpr uint32_t reduceTiles(uint32_t n) { return n / reduceTile + (n % reduceTile != 0); }

template <class T>
struct LoadPartial {
  const T* partials;
  HD T operator()(uint32_t i) const { return partials[i]; }
};

template <class T, class Transform, class Combine>
struct ReduceTile {
  T* partials;
  uint32_t n;
  T identity;
  Transform transform;
  Combine combine;

  HD T column(uint32_t tile, uint32_t column) const {
    const uint32_t begin = tile * reduceTile;
    const uint32_t end = n - begin < reduceTile ? n : begin + reduceTile;
    T sum = identity;
    for (uint32_t i = begin + column; i < end; i += reduceColumns) sum = combine(sum, transform(i));
    return sum;
  }

  /// The CPU's way: row by row, so that memory is read in order.
  void operator()(uint32_t tile) const {
    const uint32_t begin = tile * reduceTile;
    const uint32_t end = n - begin < reduceTile ? n : begin + reduceTile;
    alignas(T) unsigned char memory[reduceColumns * sizeof(T)];
    T* columns = reinterpret_cast<T*>(memory);
    for (uint32_t c = 0; c < reduceColumns; ++c) new (columns + c) T(identity);
    for (uint32_t row = begin; row < end; row += reduceColumns) {
      const uint32_t length = end - row < reduceColumns ? end - row : reduceColumns;
      for (uint32_t c = 0; c < length; ++c) columns[c] = combine(columns[c], transform(row + c));
    }
    for (uint32_t half = reduceColumns / 2; half > 0; half /= 2)
      for (uint32_t c = 0; c < half; ++c) columns[c] = combine(columns[c], columns[c + half]);
    partials[tile] = columns[0];
  }
};

#if defined(__CUDACC__)
template <class Tile, class T>
__global__ void __launch_bounds__(reduceColumns) reduceOnGrid(Tile tile, T* partials) {
  __shared__ alignas(16) unsigned char memory[reduceColumns * sizeof(T)];
  T* columns = reinterpret_cast<T*>(memory);
  columns[threadIdx.x] = tile.column(blockIdx.x, threadIdx.x);
  for (uint32_t half = reduceColumns / 2; half > 0; half /= 2) {
    __syncthreads();
    if (threadIdx.x < half) columns[threadIdx.x] = tile.combine(columns[threadIdx.x], columns[threadIdx.x + half]);
  }
  if (threadIdx.x == 0) partials[blockIdx.x] = columns[0];
}
#endif

template <class T, class Transform, class Combine>
void reduceLevel(const Device& device, [[maybe_unused]] PhaseName name, T* partials, uint32_t n, const T& identity,
                 const Transform& transform, const Combine& combine) {
  const ReduceTile<T, Transform, Combine> tile{partials, n, identity, transform, combine};
  const int64_t tiles = reduceTiles(n);
  if (device.timeline) device.timeline->countLaunch();
#if defined(__CUDACC__)
  if (device.isCuda()) {
    beforeLaunch(device, name);
    reduceOnGrid<<<static_cast<uint32_t>(tiles), reduceColumns, 0, static_cast<cudaStream_t>(device.stream)>>>(
        tile, partials);
    checkLaunch(device, name);
    return;
  }
#endif
#pragma omp parallel for schedule(static) num_threads(device.threads) if (tiles > 4)
  for (int64_t t = 0; t < tiles; ++t) tile(static_cast<uint32_t>(t));
}

}  // namespace detail

/// combine(… combine(transform(0), transform(1)) …, transform(n-1)) in a fixed tree, to `result` in the device's
/// memory; n > 0. transform: HD T operator()(uint32_t i) const. combine: HD T operator()(const T&, const T&) const,
/// associative but for rounding; combine(identity, x) is x. Both and T are trivially copyable.
template <class T, class Transform, class Combine>
void reduceInto(const Device& device, PhaseName name, uint32_t n, const T& identity, const Transform& transform,
                const Combine& combine, T* result) {
  static_assert(std::is_trivially_copyable_v<T> && std::is_trivially_copyable_v<Transform> &&
                std::is_trivially_copyable_v<Combine>);
  Phase phase(device, name);
  uint32_t count = detail::reduceTiles(n), fewer = detail::reduceTiles(count);
  Buffer<T> partials(device, count > 1 ? std::size_t{count} + fewer : 0);
  T *from = partials.data(), *to = count > 1 ? from + count : from;
  detail::reduceLevel(device, name, count > 1 ? from : result, n, identity, transform, combine);
  for (; count > 1; count = fewer, fewer = detail::reduceTiles(count)) {
    detail::reduceLevel(device, name, fewer > 1 ? to : result, count, identity, detail::LoadPartial<T>{from}, combine);
    std::swap(from, to);
  }
}

/// The same on the host; `identity` for n = 0. Waits for the device.
template <class T, class Transform, class Combine>
T reduce(const Device& device, PhaseName name, uint32_t n, const T& identity, const Transform& transform,
         const Combine& combine) {
  if (n == 0) return identity;
  Buffer<T> result(device, 1);
  reduceInto(device, name, n, identity, transform, combine, result.data());
  return result.read(0);
}

}  // namespace copse
