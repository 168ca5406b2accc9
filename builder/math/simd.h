// Vectors of 4, 8 or 16 numbers: a register of the host's processor, two halves where no register is as wide, and
// single numbers on a GPU. The same operations in the same order give the same bits on all of them.
//
// No packaged library does it: xsimd and Highway have no vector wider than the registers that the compiler's flags
// allow, std::experimental::simd takes three seconds to compile per file, and none of the three is device code for
// nvcc.
#pragma once

#include <cmath>
#include <cstdint>
#include <cstring>

#include "builder/parallel/platform.h"

/// The instruction set whose registers a Simd is made of, as the name of an inline namespace: `namespace copse::inline
/// COPSE_ISA {`. In it stands whatever a header defines that holds a Simd or computes with one. The reason is that an
/// installed library was compiled with -march=native and its user's program mostly was not, and of two inline functions
/// with the same name the linker keeps one. Vectors have the same size and alignment in both, but are passed to
/// functions in other places, and the loser's may be slower; with the name of the instruction set in theirs, both are
/// kept. What a header declares and a source file defines stands outside, as it is called from both, and has no Simd as
/// an argument.
#if defined(__AVX512F__)
#define COPSE_ISA avx512
#elif defined(__AVX2__)
#define COPSE_ISA avx2
#else
#define COPSE_ISA baseline
#endif

namespace copse::detail::inline COPSE_ISA {

/// How many numbers of type T lie in one register.
#if COPSE_DEVICE_CODE
template <class T>
constexpr uint32_t registerLanes = 1;
#elif defined(__AVX512F__)
template <class T>
constexpr uint32_t registerLanes = 64 / sizeof(T);
#elif defined(__AVX2__)
template <class T>
constexpr uint32_t registerLanes = 32 / sizeof(T);
#else
template <class T>
constexpr uint32_t registerLanes = 16 / sizeof(T);
#endif

/// N numbers as a type on which the operators of C++ work, all lanes at once: a vector of GCC and clang, or a number.
template <class T, uint32_t N>
struct Register {
  using Type __attribute__((vector_size(N * sizeof(T)))) = T;
  using Mask __attribute__((vector_size(N * sizeof(T)))) = int32_t;  ///< Lanes of 0 or -1.
};
template <class T>
struct Register<T, 1> {
  using Type = T;
  using Mask = bool;
};

}  // namespace copse::detail::inline COPSE_ISA

namespace copse::inline COPSE_ISA {

/// A truth value per lane, for lanes of four bytes.
template <uint32_t N>
struct alignas(4 * N) SimdMask {
  using Half = SimdMask<N / 2>;
  Half low, high;

  SimdMask() = default;
  HD explicit SimdMask(bool all) : low(all), high(all) {}
  HD SimdMask(const Half& lower, const Half& upper) : low(lower), high(upper) {}
  HD Half lower() const { return low; }
  /// Bit i is lane i.
  HD uint32_t bits() const { return low.bits() | high.bits() << (N / 2); }

  HD friend SimdMask operator&(const SimdMask& a, const SimdMask& b) { return {a.low & b.low, a.high & b.high}; }
  HD friend SimdMask operator|(const SimdMask& a, const SimdMask& b) { return {a.low | b.low, a.high | b.high}; }
};

/// N lanes of T, which is float, double, int32_t or uint32_t, in memory one after the other. Comparisons, select() and
/// shuffle() are for lanes of four bytes.
template <class T, uint32_t N>
struct alignas(N * sizeof(T)) Simd {
  using Half = Simd<T, N / 2>;
  using Mask = SimdMask<N>;
  Half low, high;

  Simd() = default;
  HD explicit Simd(T all) : low(all), high(all) {}
  HD Simd(const Half& lower, const Half& upper) : low(lower), high(upper) {}
  HD Simd(T a, T b, T c, T d) requires(N == 4 && sizeof(T) == 4)
      : low(Simd<T, 1>(a), Simd<T, 1>(b)), high(Simd<T, 1>(c), Simd<T, 1>(d)) {}
  /// N numbers in a row.
  HD static Simd load(const T* from) { return {Half::load(from), Half::load(from + N / 2)}; }
  /// The same from an address divisible by 16, for lanes of four bytes: on a GPU one load for every four.
  HD static Simd loadAligned(const T* from) {
    if constexpr (N == 4 && sizeof(T) == 4) {
      struct alignas(16) Words {
        T v[4];
      };
      const Words w = *reinterpret_cast<const Words*>(from);
      return Simd(w.v[0], w.v[1], w.v[2], w.v[3]);
    } else {
      return {Half::loadAligned(from), Half::loadAligned(from + N / 2)};
    }
  }
  HD void store(T* to) const {
    low.store(to);
    high.store(to + N / 2);
  }
  HD Half lower() const { return low; }
  HD Half upper() const { return high; }
  HD T operator[](uint32_t lane) const { return lane < N / 2 ? low[lane] : high[lane - N / 2]; }

  /// In every four lanes, lane i is lane Li of these four, or for Li of 4 … 7 lane Li - 4 of the four in `b`.
  template <int L0, int L1, int L2, int L3>
  HD Simd shuffle(const Simd& b) const {
    if constexpr (N == 4)
      return Simd(pick<L0>(b), pick<L1>(b), pick<L2>(b), pick<L3>(b));
    else
      return {low.template shuffle<L0, L1, L2, L3>(b.low), high.template shuffle<L0, L1, L2, L3>(b.high)};
  }
  template <int L0, int L1, int L2, int L3>
  HD Simd shuffle() const {
    return shuffle<L0, L1, L2, L3>(*this);
  }
  /// Two halves of four, where 0 and 1 are the lower and the upper one, 2 and 3 those of `b`.
  template <int first, int second>
  HD Simd halves(const Simd& b) const {
    const Half from[4] = {low, high, b.low, b.high};
    return {from[first], from[second]};
  }
  template <int first, int second>
  HD Simd halves() const {
    return halves<first, second>(*this);
  }

  HD friend Simd operator+(const Simd& a, const Simd& b) { return {a.low + b.low, a.high + b.high}; }
  HD friend Simd operator-(const Simd& a, const Simd& b) { return {a.low - b.low, a.high - b.high}; }
  HD friend Simd operator*(const Simd& a, const Simd& b) { return {a.low * b.low, a.high * b.high}; }
  HD friend Simd operator-(const Simd& a) { return {-a.low, -a.high}; }
  HD friend Simd operator&(const Simd& a, const Simd& b) { return {a.low & b.low, a.high & b.high}; }
  HD friend Simd operator|(const Simd& a, const Simd& b) { return {a.low | b.low, a.high | b.high}; }
  HD friend Mask operator<(const Simd& a, const Simd& b) { return {a.low < b.low, a.high < b.high}; }
  HD friend Mask operator<=(const Simd& a, const Simd& b) { return {a.low <= b.low, a.high <= b.high}; }
  HD friend Mask operator==(const Simd& a, const Simd& b) { return {a.low == b.low, a.high == b.high}; }
  /// `a < b ? a : b`: b where either is NaN.
  HD friend Simd minOf(const Simd& a, const Simd& b) { return {minOf(a.low, b.low), minOf(a.high, b.high)}; }
  /// `a > b ? a : b`: b where either is NaN.
  HD friend Simd maxOf(const Simd& a, const Simd& b) { return {maxOf(a.low, b.low), maxOf(a.high, b.high)}; }
  /// maxOf() where b is no NaN; of 0 and -0 it may be either. One instruction per lane on a GPU.
  HD friend Simd maxNum(const Simd& a, const Simd& b) { return {maxNum(a.low, b.low), maxNum(a.high, b.high)}; }
  HD friend Simd select(const Mask& m, const Simd& yes, const Simd& no) {
    return {select(m.low, yes.low, no.low), select(m.high, yes.high, no.high)};
  }
  /// The minimum of all lanes, none of which is NaN.
  HD friend T minLane(const Simd& a) { return minLane(minOf(a.low, a.high)); }

 private:
  template <int L>
  HD T pick(const Simd& b) const {
    return L < 4 ? (*this)[L % 4] : b[L % 4];
  }
};

// What follows is the same where N lanes are one register, or one number of the device's.

template <uint32_t N>
requires(N <= detail::registerLanes<int32_t>) struct alignas(4 * N) SimdMask<N> {
  using Vector = typename detail::Register<int32_t, N>::Mask;
  Vector v;

  SimdMask() = default;
  HD explicit SimdMask(bool all) { v = Vector{} - static_cast<int32_t>(all); }
  HD static SimdMask of(Vector v) {
    SimdMask r;
    r.v = v;
    return r;
  }
  HD uint32_t bits() const {
    if constexpr (N == 1) {
      return v;
    } else {
#if defined(__SSE2__) && !COPSE_DEVICE_CODE
      using Floats = typename detail::Register<float, N>::Type;
      if constexpr (N == 4) return static_cast<uint32_t>(__builtin_ia32_movmskps(Floats(v)));
#endif
#if defined(__AVX2__) && !COPSE_DEVICE_CODE
      if constexpr (N == 8) return static_cast<uint32_t>(__builtin_ia32_movmskps256(Floats(v)));
#endif
      uint32_t bits = 0;
      for (uint32_t i = 0; i < N; ++i) bits |= static_cast<uint32_t>(v[i] & 1) << i;
      return bits;
    }
  }
  HD friend SimdMask operator&(SimdMask a, SimdMask b) { return of(a.v & b.v); }
  HD friend SimdMask operator|(SimdMask a, SimdMask b) { return of(a.v | b.v); }
};

template <class T, uint32_t N>
requires(N <= detail::registerLanes<T>) struct alignas(N * sizeof(T)) Simd<T, N> {
  using Half = Simd<T, N / 2>;
  using Mask = SimdMask<N>;
  using Vector = typename detail::Register<T, N>::Type;
  Vector v;

  Simd() = default;
  HD explicit Simd(T all) { v = all - Vector{}; }  // Minus 0, which leaves -0 as it is.
  HD Simd(T a, T b, T c, T d) requires(N == 4 && sizeof(T) == 4) { v = Vector{a, b, c, d}; }
  HD Simd(Half l, Half u) requires(N > 4) { v = joined(l.v, u.v); }
  HD static Simd of(Vector v) {
    Simd r;
    r.v = v;
    return r;
  }
  HD static Simd load(const T* from) {
    Simd r;
    if constexpr (N == 1)
      r.v = *from;
    else
      std::memcpy(&r.v, from, sizeof r.v);
    return r;
  }
  HD static Simd loadAligned(const T* from) {
    return load(static_cast<const T*>(__builtin_assume_aligned(from, N == 1 ? sizeof(T) : 16)));
  }
  HD void store(T* to) const {
    if constexpr (N == 1)
      *to = v;
    else
      std::memcpy(to, &v, sizeof v);
  }
  HD Half lower() const {
    if constexpr (N == 4)
      return Half::of(__builtin_shufflevector(v, v, 0, 1));
    else if constexpr (N == 8)
      return Half::of(__builtin_shufflevector(v, v, 0, 1, 2, 3));
    else
      return Half::of(__builtin_shufflevector(v, v, 0, 1, 2, 3, 4, 5, 6, 7));
  }
  HD Half upper() const {
    if constexpr (N == 4)
      return Half::of(__builtin_shufflevector(v, v, 2, 3));
    else if constexpr (N == 8)
      return Half::of(__builtin_shufflevector(v, v, 4, 5, 6, 7));
    else
      return Half::of(__builtin_shufflevector(v, v, 8, 9, 10, 11, 12, 13, 14, 15));
  }
  HD T operator[]([[maybe_unused]] uint32_t lane) const {
    if constexpr (N == 1)
      return v;
    else
      return v[lane];
  }

  template <int L0, int L1, int L2, int L3>
  HD Simd shuffle(Simd b) const {
    if constexpr (N == 4)
      return of(__builtin_shufflevector(v, b.v, L0, L1, L2, L3));
    else if constexpr (N == 8)
      return of(__builtin_shufflevector(v, b.v, at<L0, 0>, at<L1, 0>, at<L2, 0>, at<L3, 0>,  //
                                        at<L0, 4>, at<L1, 4>, at<L2, 4>, at<L3, 4>));
    else
      return of(__builtin_shufflevector(v, b.v, at<L0, 0>, at<L1, 0>, at<L2, 0>, at<L3, 0>,  //
                                        at<L0, 4>, at<L1, 4>, at<L2, 4>, at<L3, 4>,          //
                                        at<L0, 8>, at<L1, 8>, at<L2, 8>, at<L3, 8>,          //
                                        at<L0, 12>, at<L1, 12>, at<L2, 12>, at<L3, 12>));
  }
  template <int L0, int L1, int L2, int L3>
  HD Simd shuffle() const {
    return shuffle<L0, L1, L2, L3>(*this);
  }
  template <int first, int second>
  HD Simd halves(Simd b) const {
    constexpr int l = first * 4, u = second * 4;
    if constexpr (N == 4) {
      return shuffle<l / 2, l / 2 + 1, u / 2, u / 2 + 1>(b);
    } else if constexpr (N == 8) {
      return of(__builtin_shufflevector(v, b.v, l, l + 1, l + 2, l + 3, u, u + 1, u + 2, u + 3));
    } else {
      const Half from[4] = {lower(), upper(), b.lower(), b.upper()};
      return {from[first], from[second]};
    }
  }
  template <int first, int second>
  HD Simd halves() const {
    return halves<first, second>(*this);
  }

  HD friend Simd operator+(Simd a, Simd b) { return of(a.v + b.v); }
  HD friend Simd operator-(Simd a, Simd b) { return of(a.v - b.v); }
  HD friend Simd operator*(Simd a, Simd b) { return of(a.v * b.v); }
  HD friend Simd operator-(Simd a) { return of(-a.v); }
  HD friend Simd operator&(Simd a, Simd b) { return of(a.v & b.v); }
  HD friend Simd operator|(Simd a, Simd b) { return of(a.v | b.v); }
  HD friend Mask operator<(Simd a, Simd b) { return Mask::of(a.v < b.v); }
  HD friend Mask operator<=(Simd a, Simd b) { return Mask::of(a.v <= b.v); }
  HD friend Mask operator==(Simd a, Simd b) { return Mask::of(a.v == b.v); }
  HD friend Simd minOf(Simd a, Simd b) { return of(a.v < b.v ? a.v : b.v); }
  HD friend Simd maxOf(Simd a, Simd b) { return of(a.v > b.v ? a.v : b.v); }
  HD friend Simd maxNum(Simd a, Simd b) {
#if COPSE_DEVICE_CODE
    return of(fmaxf(a.v, b.v));
#else
    return maxOf(a, b);
#endif
  }
  HD friend Simd select(Mask m, Simd yes, Simd no) { return of(m.v ? yes.v : no.v); }
  HD friend T minLane(Simd a) {
    if constexpr (N == 1) {
      return a.v;
    } else if constexpr (N == 4) {
      a = minOf(a, a.template shuffle<2, 3, 0, 1>());
      return minOf(a, a.template shuffle<1, 0, 3, 2>())[0];
    } else {
      return minLane(minOf(a.lower(), a.upper()));
    }
  }

 private:
  /// Where a lane as shuffle() names it stands in two vectors, for the four lanes from `first` on.
  template <int L, int first>
  static constexpr int at = (L < 4 ? L : static_cast<int>(N) + L - 4) + first;

  template <class V>
  HD static Vector joined(const V& lower, const V& upper) {
#if defined(__AVX2__) && !COPSE_DEVICE_CODE && !defined(__clang__)
    if constexpr (sizeof(Vector) == 32) {  // For __builtin_shufflevector, g++ 12 copies both first.
      using Four = typename detail::Register<float, 4>::Type;
      return Vector(__builtin_ia32_vinsertf128_ps256(__builtin_ia32_ps256_ps(Four(lower)), Four(upper), 1));
    }
#endif
    if constexpr (N == 8)
      return __builtin_shufflevector(lower, upper, 0, 1, 2, 3, 4, 5, 6, 7);
    else
      return __builtin_shufflevector(lower, upper, 0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15);
  }
};

using F32x4 = Simd<float, 4>;
using F32x8 = Simd<float, 8>;
using F32x16 = Simd<float, 16>;
using F64x8 = Simd<double, 8>;
using I32x4 = Simd<int32_t, 4>;
using I32x8 = Simd<int32_t, 8>;
using U32x4 = Simd<uint32_t, 4>;
using U32x8 = Simd<uint32_t, 8>;

/// A lane's choice where a template's lane is one float.
HD inline float select(bool m, float yes, float no) { return m ? yes : no; }

/// The bits of every lane.
template <uint32_t N>
HD inline Simd<uint32_t, N> bitsOf(const Simd<float, N>& a) {
  Simd<uint32_t, N> r;
  if constexpr (N > detail::registerLanes<float>)
    r = {bitsOf(a.lower()), bitsOf(a.upper())};
  else
    std::memcpy(&r.v, &a.v, sizeof r.v);  // From the vectors themselves, for which g++ finds the register.
  return r;
}

/// Every lane as a double.
template <uint32_t N>
HD inline Simd<double, N> toDouble(const Simd<float, N>& a) {
  if constexpr (N > detail::registerLanes<double>)
    return {toDouble(a.lower()), toDouble(a.upper())};
  else if constexpr (N == 1)
    return Simd<double, 1>(a.v);
  else
    return Simd<double, N>::of(__builtin_convertvector(a.v, typename Simd<double, N>::Vector));
}

}  // namespace copse::inline COPSE_ISA
