// builder/math/simd.h: every operation at every width against one number at a time. This file is compiled twice, for
// the processor at hand and for any x86-64 (COPSE_TEST_BASELINE), where the wide vectors are halves.
#include "builder/math/simd.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>
#include <type_traits>
#include <utility>
#include <vector>

#include "builder/math/pair_swap.h"
#include "builder/math/sort8.h"
#include "tests/support/catch.h"

#if defined(COPSE_TEST_BASELINE)
#define COPSE_TEST_NAME(text) text ", for any x86-64"
#if defined(__AVX__)
#error "this copy of the test is to be compiled without wide registers"
#endif
#else
#define COPSE_TEST_NAME(text) text
#endif

using namespace copse;

namespace {

constexpr uint32_t most = 16;

template <class T>
struct Lanes {
  alignas(64) T v[most] = {};
};

bool sameBits(float a, float b) { return (std::isnan(a) && std::isnan(b)) || std::memcmp(&a, &b, sizeof a) == 0; }
bool sameBits(double a, double b) { return (std::isnan(a) && std::isnan(b)) || std::memcmp(&a, &b, sizeof a) == 0; }
template <class T>
bool sameBits(T a, T b) {
  return a == b;
}

/// Whether lane i of `vector` is expected(i), read by store() and by [].
template <class T, uint32_t N, class Expected>
bool lanesAre(const Simd<T, N>& vector, const Expected& expected) {
  T stored[N];
  vector.store(stored);
  for (uint32_t i = 0; i < N; ++i)
    if (!sameBits(stored[i], static_cast<T>(expected(i))) || !sameBits(vector[i], stored[i])) return false;
  return true;
}
template <uint32_t N, class Expected>
bool bitsAre(const SimdMask<N>& mask, const Expected& expected) {
  uint32_t bits = 0;
  for (uint32_t i = 0; i < N; ++i) bits |= (expected(i) ? 1u : 0u) << i;
  return mask.bits() == bits;
}

/// Numbers among which every pair of the awkward ones meets in some lane, for some `shift`.
template <class T>
std::vector<T> awkward() {
  if constexpr (std::is_floating_point_v<T>) {
    const T infinity = std::numeric_limits<T>::infinity();
    return {T(0),
            T(-0.0),
            T(1),
            T(-1),
            T(0.1),
            infinity,
            -infinity,
            std::numeric_limits<T>::quiet_NaN(),
            std::numeric_limits<T>::max(),
            std::numeric_limits<T>::denorm_min(),
            T(3),
            T(-7.25),
            T(1e-30)};
  } else {
    return {T(0),           T(1),  T(2),       T(7),          T(0x7fffffff), T(0x80000000u),
            T(0xffffffffu), T(-5), T(1000003), T(0x55555555), T(3)};
  }
}

/// Calls check(a, b, i) for vectors a and b with every pair of awkward numbers somewhere.
template <class T, class Check>
void forAwkwardPairs(const Check& check) {
  const std::vector<T> values = awkward<T>();
  for (uint32_t shift = 0; shift < values.size(); ++shift)
    for (uint32_t start = 0; start < values.size(); ++start) {
      Lanes<T> a, b;
      for (uint32_t i = 0; i < most; ++i) {
        a.v[i] = values[(start + i) % values.size()];
        b.v[i] = values[(start + i + shift) % values.size()];
      }
      check(a, b);
    }
}

/// Sums and products that overflow are undefined for signed integers: those are of small numbers.
template <class T>
T wrapped(T a) {
  return std::is_same_v<T, int32_t> ? static_cast<T>(static_cast<int64_t>(a) % 1000) : a;
}

template <class T, uint32_t N>
void checkMaking() {
  Lanes<T> numbers;
  for (uint32_t i = 0; i < most; ++i) numbers.v[i] = static_cast<T>(100 + i);
  using V = Simd<T, N>;
  static_assert(sizeof(V) == N * sizeof(T) && alignof(V) == N * sizeof(T), "whatever the instruction set");
  const V v = V::load(numbers.v);
  CHECK(lanesAre(v, [](uint32_t i) { return 100 + i; }));
  CHECK(lanesAre(V::loadAligned(numbers.v), [](uint32_t i) { return 100 + i; }));
  for (const T value : awkward<T>()) CHECK(lanesAre(V(value), [&](uint32_t) { return value; }));
  if constexpr (N == 4 && sizeof(T) == 4) CHECK(lanesAre(V(T(5), T(6), T(7), T(8)), [](uint32_t i) { return 5 + i; }));
  if constexpr (N > 4) {
    CHECK(lanesAre(v.lower(), [](uint32_t i) { return 100 + i; }));
    CHECK(lanesAre(v.upper(), [](uint32_t i) { return 100 + N / 2 + i; }));
    CHECK(lanesAre(V(v.upper(), v.lower()), [](uint32_t i) { return 100 + (i + N / 2) % N; }));
  }
  std::vector<T> shifted(N + 1);  // At an address that is divisible by nothing.
  std::memcpy(shifted.data() + 1, numbers.v, sizeof v);
  CHECK(lanesAre(V::load(shifted.data() + 1), [](uint32_t i) { return 100 + i; }));
}

template <class T, uint32_t N>
void checkArithmetic() {
  forAwkwardPairs<T>([](const Lanes<T>& first, const Lanes<T>& second) {
    using V = Simd<T, N>;
    Lanes<T> x, y;
    for (uint32_t i = 0; i < most; ++i) x.v[i] = wrapped(first.v[i]), y.v[i] = wrapped(second.v[i]);
    const V a = V::load(x.v), b = V::load(y.v);
    REQUIRE(lanesAre(a + b, [&](uint32_t i) { return x.v[i] + y.v[i]; }));
    REQUIRE(lanesAre(a - b, [&](uint32_t i) { return x.v[i] - y.v[i]; }));
    REQUIRE(lanesAre(a * b, [&](uint32_t i) { return x.v[i] * y.v[i]; }));
    REQUIRE(lanesAre(-a, [&](uint32_t i) { return -x.v[i]; }));
  });
}

/// `a > b ? a : b` and its like, where one of two NaNs, or of 0 and -0, is not as good as the other.
template <class T, uint32_t N>
void checkComparisons() {
  forAwkwardPairs<T>([](const Lanes<T>& x, const Lanes<T>& y) {
    using V = Simd<T, N>;
    const V a = V::load(x.v), b = V::load(y.v);
    REQUIRE(bitsAre(a < b, [&](uint32_t i) { return x.v[i] < y.v[i]; }));
    REQUIRE(bitsAre(a <= b, [&](uint32_t i) { return x.v[i] <= y.v[i]; }));
    REQUIRE(bitsAre(a == b, [&](uint32_t i) { return x.v[i] == y.v[i]; }));
    REQUIRE(bitsAre((a < b) | (a == b), [&](uint32_t i) { return x.v[i] <= y.v[i]; }));
    REQUIRE(bitsAre((a <= b) & (b <= a), [&](uint32_t i) { return x.v[i] == y.v[i]; }));
    REQUIRE(lanesAre(select(a < b, a, b), [&](uint32_t i) { return x.v[i] < y.v[i] ? x.v[i] : y.v[i]; }));
    REQUIRE(lanesAre(minOf(a, b), [&](uint32_t i) { return x.v[i] < y.v[i] ? x.v[i] : y.v[i]; }));
    REQUIRE(lanesAre(maxOf(a, b), [&](uint32_t i) { return x.v[i] > y.v[i] ? x.v[i] : y.v[i]; }));
  });
  CHECK(SimdMask<N>(true).bits() == (1u << N) - 1);
  CHECK(SimdMask<N>(false).bits() == 0);
  static_assert(sizeof(SimdMask<N>) == 4 * N && alignof(SimdMask<N>) == 4 * N);
}

template <class T, uint32_t N>
void checkMoves() {
  Lanes<T> x, y;
  for (uint32_t i = 0; i < most; ++i) x.v[i] = static_cast<T>(i), y.v[i] = static_cast<T>(100 + i);
  using V = Simd<T, N>;
  const V a = V::load(x.v), b = V::load(y.v);
  const auto moved = [&](const V& v, const int(&from)[4]) {
    return lanesAre(v, [&](uint32_t i) { return from[i % 4] % 4 + i / 4 * 4 + (from[i % 4] < 4 ? 0 : 100); });
  };
  CHECK(moved(a.template shuffle<2, 3, 0, 1>(), {2, 3, 0, 1}));
  CHECK(moved(a.template shuffle<1, 2, 0, 3>(), {1, 2, 0, 3}));
  CHECK(moved(a.template shuffle<3, 3, 3, 0>(), {3, 3, 3, 0}));
  CHECK(moved(a.template shuffle<0, 5, 2, 7>(b), {0, 5, 2, 7}));
  CHECK(moved(a.template shuffle<0, 4, 1, 5>(b), {0, 4, 1, 5}));
  CHECK(moved(a.template shuffle<6, 2, 7, 3>(b), {6, 2, 7, 3}));
  const auto inHalves = [&](const V& v, uint32_t lower, uint32_t upper) {
    return lanesAre(v, [&](uint32_t i) {
      const uint32_t half = i < N / 2 ? lower : upper;
      return i % (N / 2) + half % 2 * (N / 2) + (half < 2 ? 0 : 100);
    });
  };
  CHECK(inHalves(a.template halves<1, 0>(), 1, 0));
  CHECK(inHalves(a.template halves<0, 0>(), 0, 0));
  CHECK(inHalves(a.template halves<0, 3>(b), 0, 3));
  CHECK(inHalves(a.template halves<2, 1>(b), 2, 1));
}

template <uint32_t N>
void checkFloats() {
  using V = Simd<float, N>;
  forAwkwardPairs<float>([](const Lanes<float>& x, const Lanes<float>& y) {
    const V a = V::load(x.v), b = V::load(y.v);
    REQUIRE(lanesAre(toDouble(a), [&](uint32_t i) { return static_cast<double>(x.v[i]); }));
    const auto bits = bitsOf(a);
    for (uint32_t i = 0; i < N; ++i) {
      uint32_t expected;
      std::memcpy(&expected, &x.v[i], sizeof expected);
      REQUIRE(bits[i] == expected);
      if (std::isnan(y.v[i])) continue;
      REQUIRE(maxNum(a, b)[i] == (std::isnan(x.v[i]) || x.v[i] < y.v[i] ? y.v[i] : x.v[i]));
    }
  });
  for (uint32_t at = 0; at < N; ++at) {
    Lanes<float> x;
    for (uint32_t i = 0; i < most; ++i) x.v[i] = i == at ? -3.5f : static_cast<float>(i);
    CHECK(minLane(V::load(x.v)) == -3.5f);
  }
  Lanes<float> shifted;
  for (uint32_t i = 0; i < most; ++i) shifted.v[i] = static_cast<float>(i);
  for (const bool swap : {false, true})
    if constexpr (N <= 8)
      CHECK(lanesAre(PairSwap(swap)(V::load(shifted.v)), [&](uint32_t i) { return swap ? i ^ 2 : i; }));
}

template <class T, uint32_t N>
void checkBits() {
  using V = Simd<T, N>;
  forAwkwardPairs<T>([](const Lanes<T>& x, const Lanes<T>& y) {
    REQUIRE(lanesAre(V::load(x.v) & V::load(y.v), [&](uint32_t i) { return x.v[i] & y.v[i]; }));
    REQUIRE(lanesAre(V::load(x.v) | V::load(y.v), [&](uint32_t i) { return x.v[i] | y.v[i]; }));
  });
}

template <class T, uint32_t N>
void checkFourBytes() {
  checkMaking<T, N>();
  checkArithmetic<T, N>();
  checkComparisons<T, N>();
  checkMoves<T, N>();
}

template <uint32_t N>
void checkWidth() {
  checkFourBytes<float, N>();
  checkFourBytes<int32_t, N>();
  checkFourBytes<uint32_t, N>();
  checkFloats<N>();
  checkBits<int32_t, N>();
  checkBits<uint32_t, N>();
  checkMaking<double, N>();
  checkArithmetic<double, N>();
}

}  // namespace

TEST_CASE(COPSE_TEST_NAME("Vectors of 4 numbers compute as single ones do")) { checkWidth<4>(); }
TEST_CASE(COPSE_TEST_NAME("Vectors of 8 numbers compute as single ones do")) { checkWidth<8>(); }
TEST_CASE(COPSE_TEST_NAME("Vectors of 16 numbers compute as single ones do")) { checkWidth<16>(); }

TEST_CASE(COPSE_TEST_NAME("Eight numbers are sorted as any sort does it, with their words")) {
  std::mt19937 draw(1);
  for (int round = 0; round < 5000; ++round) {
    alignas(32) float keys[8];
    uint32_t words[8];
    uint64_t sorted[8];
    std::vector<std::pair<uint32_t, uint32_t>> plain;  // Key and index.
    const uint32_t chosen = round < 256 ? uint32_t(round) : draw() & 255;
    for (uint32_t k = 0; k < 8; ++k) {
      keys[k] = draw() % 3 ? float(draw() % 5) : float(draw()) * 1e-3f;
      words[k] = draw();
      uint32_t bits;
      std::memcpy(&bits, &keys[k], sizeof bits);
      if (chosen >> k & 1) plain.push_back({bits & ~7u, k});
    }
    std::sort(plain.rbegin(), plain.rend());
    storeDescending(F32x8::load(keys), chosen, words, sorted);
    for (std::size_t k = 0; k < plain.size(); ++k) {
      REQUIRE(sorted[k] >> 32 == plain[k].first);
      REQUIRE(uint32_t(sorted[k]) == words[plain[k].second]);
    }
  }
}

TEST_CASE(COPSE_TEST_NAME("The instruction set is in the names of what depends on it")) {
#if defined(COPSE_TEST_BASELINE)
  CHECK(std::is_same_v<F32x8, copse::baseline::Simd<float, 8>>);
  CHECK(detail::registerLanes<float> == 4);
#else
  CHECK(std::is_same_v<F32x8, copse::COPSE_ISA::Simd<float, 8>>);
#endif
}
