// What PTX instructions compute: plain functions, named after the instruction with its modifiers. "PTX" is
// NVIDIA's "Parallel Thread Execution ISA", version 9.0. No instruction here contracts; those whose names say so flush
// subnormal numbers, and a GPU's approximations are correctly rounded here, so that last bits may differ from a card's.
#pragma once

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <type_traits>

namespace emulator {

template <class T>
using BitsOf = std::conditional_t<
    sizeof(T) == 8, uint64_t,
    std::conditional_t<sizeof(T) == 4, uint32_t, std::conditional_t<sizeof(T) == 2, uint16_t, uint8_t>>>;

/// A register's value as an operand of type T, which is not wider.
template <class T, class Register>
T as(Register value) {
  static_assert(sizeof(T) <= sizeof(Register) && std::is_same_v<T, bool> == std::is_same_v<Register, bool>);
  if constexpr (std::is_same_v<T, Register>)
    return value;
  else
    return std::bit_cast<T>(static_cast<BitsOf<T>>(std::bit_cast<BitsOf<Register>>(value)));
}

/// A result into a register, which may be wider: signed types extend their sign.
template <class Register, class T>
Register to(T value) {
  if constexpr (std::is_same_v<T, Register>)
    return value;
  else if constexpr (std::is_integral_v<T> && std::is_integral_v<Register>)
    return static_cast<Register>(value);
  else
    return std::bit_cast<Register>(static_cast<BitsOf<Register>>(std::bit_cast<BitsOf<T>>(value)));
}

/// Integers wrap around.
template <class T>
using Wrapping = std::conditional_t<std::is_integral_v<T>, BitsOf<T>, T>;
template <class T>
using Twice =
    std::conditional_t<sizeof(T) == 8, std::conditional_t<std::is_signed_v<T>, __int128, unsigned __int128>,
                       std::conditional_t<sizeof(T) == 4, std::conditional_t<std::is_signed_v<T>, int64_t, uint64_t>,
                                          std::conditional_t<std::is_signed_v<T>, int32_t, uint32_t>>>;

template <class T>
T add(T a, T b) {
  return static_cast<T>(static_cast<Wrapping<T>>(a) + static_cast<Wrapping<T>>(b));
}
template <class T>
T sub(T a, T b) {
  return static_cast<T>(static_cast<Wrapping<T>>(a) - static_cast<Wrapping<T>>(b));
}
template <class T>
T mul(T a, T b) {
  static_assert(std::is_floating_point_v<T>);
  return a * b;
}
template <class T>
T mul_lo(T a, T b) {
  return static_cast<T>(static_cast<Twice<T>>(a) * static_cast<Twice<T>>(b));
}
template <class T>
T mul_hi(T a, T b) {
  return static_cast<T>((static_cast<Twice<T>>(a) * static_cast<Twice<T>>(b)) >> (8 * sizeof(T)));
}
template <class T>
Twice<T> mul_wide(T a, T b) {
  return static_cast<Twice<T>>(a) * static_cast<Twice<T>>(b);
}
template <class T>
T mad_lo(T a, T b, T c) {
  return add(mul_lo(a, b), c);
}
template <class T>
T mad_hi(T a, T b, T c) {
  return add(mul_hi(a, b), c);
}
template <class T>
Twice<T> mad_wide(T a, T b, Twice<T> c) {
  return add(mul_wide(a, b), c);
}
template <class T>
T fma(T a, T b, T c) {
  return std::fma(a, b, c);
}
/// An integer divided by zero gives what the hardware does: all bits, and the dividend as the remainder.
template <class T>
T div(T a, T b) {
  if constexpr (std::is_integral_v<T>) {
    if (b == 0) return static_cast<T>(-1);
    if (std::is_signed_v<T> && b == static_cast<T>(-1)) return sub<T>(0, a);
  }
  return a / b;
}
template <class T>
T rem(T a, T b) {
  if (b == 0) return a;
  if (std::is_signed_v<T> && b == static_cast<T>(-1)) return 0;
  return a % b;
}
template <class T>
T neg(T a) {
  if constexpr (std::is_integral_v<T>)
    return sub<T>(0, a);
  else
    return -a;
}
template <class T>
T abs(T a) {
  if constexpr (std::is_integral_v<T>)
    return a < 0 ? neg(a) : a;
  else
    return std::fabs(a);
}
/// A number before NaN, and -0 before +0; two NaNs give the canonical one.
template <class T>
T min(T a, T b) {
  if constexpr (std::is_floating_point_v<T>) {
    if (a != a && b != b) return std::bit_cast<T>(static_cast<BitsOf<T>>(sizeof(T) == 4 ? 0x7fffffff : ~0ull >> 1));
    if (a != a) return b;
    if (b != b) return a;
    if (a == b) return std::signbit(a) ? a : b;
  }
  return b < a ? b : a;
}
template <class T>
T max(T a, T b) {
  if constexpr (std::is_floating_point_v<T>) {
    if (a != a || b != b) return min(a, b);
    if (a == b) return std::signbit(a) ? b : a;
  }
  return a < b ? b : a;
}
template <class T>
T sqrt(T a) {
  return std::sqrt(a);
}
template <class T>
T rcp(T a) {
  return 1 / a;
}
template <class T>
T flushed(T a) {
  return std::fpclassify(a) == FP_SUBNORMAL ? std::copysign(T(0), a) : a;
}
template <class T>
T rsqrt_approx_ftz(T a) {
  return static_cast<T>(1 / std::sqrt(static_cast<double>(flushed(a))));
}
template <class T>
T ex2_approx_ftz(T a) {
  return flushed(static_cast<T>(std::exp2(static_cast<double>(flushed(a)))));
}
/// The sign of the first, the rest of the second.
template <class T>
T copysign(T a, T b) {
  return std::copysign(b, a);
}

template <class T>
T bit_and(T a, T b) {
  return static_cast<T>(a & b);
}
template <class T>
T bit_or(T a, T b) {
  return static_cast<T>(a | b);
}
template <class T>
T bit_xor(T a, T b) {
  return static_cast<T>(a ^ b);
}
template <class T>
T bit_not(T a) {
  if constexpr (std::is_same_v<T, bool>)
    return !a;
  else
    return static_cast<T>(~a);
}
/// Shifts by the width and more give zeros, or signs.
template <class T>
T shl(T a, uint32_t by) {
  return by >= 8 * sizeof(T) ? T(0) : static_cast<T>(a << by);
}
template <class T>
T shr(T a, uint32_t by) {
  if (by >= 8 * sizeof(T)) return a < 0 ? static_cast<T>(-1) : T(0);
  return static_cast<T>(a >> by);
}
template <class T>
uint32_t popc(T a) {
  return std::popcount(a);
}
template <class T>
uint32_t clz(T a) {
  return std::countl_zero(a);
}
template <class T>
T brev(T a) {
  T reversed = 0;
  for (uint32_t bit = 0; bit < 8 * sizeof(T); ++bit) reversed |= (a >> bit & T(1)) << (8 * sizeof(T) - 1 - bit);
  return reversed;
}
/// The highest bit that is set, or all bits where none is.
template <class T>
uint32_t bfind(T a) {
  static_assert(std::is_unsigned_v<T>);
  return a == 0 ? ~0u : 8 * sizeof(T) - 1 - std::countl_zero(a);
}
template <class T>
uint32_t bfind_shiftamt(T a) {
  static_assert(std::is_unsigned_v<T>);
  return a == 0 ? ~0u : std::countl_zero(a);
}
template <class T>
T bitsBelow(uint32_t count) {
  return count >= 8 * sizeof(T) ? static_cast<T>(~T(0)) : static_cast<T>((T(1) << count) - 1);
}
template <class T>
T bfi(T field, T into, uint32_t position, uint32_t length) {
  const T mask = shl(bitsBelow<T>(length & 0xff), position & 0xff);
  return static_cast<T>((into & ~mask) | (shl(field, position & 0xff) & mask));
}
template <class T>
T bfe(T a, uint32_t position, uint32_t length) {
  static_assert(std::is_unsigned_v<T>);
  return static_cast<T>(shr(a, position & 0xff) & bitsBelow<T>(length & 0xff));
}
template <class T>
uint32_t prmt(T a, T b, T selectors) {
  const uint64_t bytes = static_cast<uint64_t>(b) << 32 | a;
  uint32_t result = 0;
  for (uint32_t i = 0; i < 4; ++i) {
    const uint32_t selector = selectors >> (4 * i) & 0xf;
    uint32_t byte = bytes >> (8 * (selector & 7)) & 0xff;
    if (selector & 8) byte = byte & 0x80 ? 0xff : 0;
    result |= byte << (8 * i);
  }
  return result;
}
template <class T>
T lop3(T a, T b, T c, uint32_t table) {
  T result = 0;
  for (uint32_t row = 0; row < 8; ++row)
    if (table >> row & 1) result |= (row & 4 ? a : ~a) & (row & 2 ? b : ~b) & (row & 1 ? c : ~c);
  return result;
}
/// The third operand of a funnel shift is clamped to 32, or taken modulo 32.
inline uint32_t funnel(uint32_t low, uint32_t high, uint32_t by) {
  return static_cast<uint32_t>((static_cast<uint64_t>(high) << 32 | low) >> by);
}
template <class T>
T shf_r_clamp(T low, T high, uint32_t by) {
  return funnel(low, high, std::min(by, 32u));
}
template <class T>
T shf_r_wrap(T low, T high, uint32_t by) {
  return funnel(low, high, by & 31);
}
template <class T>
T shf_l_clamp(T low, T high, uint32_t by) {
  return by >= 32 ? low : funnel(low, high, 32 - by);
}
template <class T>
T shf_l_wrap(T low, T high, uint32_t by) {
  return funnel(low, high, 32 - (by & 31));
}
template <class T>
T selp(T a, T b, bool first) {
  return first ? a : b;
}

/// Comparisons: false with NaN, except those that end with u and nan itself.
template <class T>
bool unordered(T a, T b) {
  return a != a || b != b;
}
template <class T>
bool set_eq(T a, T b) {
  return a == b;
}
template <class T>
bool set_ne(T a, T b) {
  return !unordered(a, b) && a != b;
}
template <class T>
bool set_lt(T a, T b) {
  return a < b;
}
template <class T>
bool set_le(T a, T b) {
  return a <= b;
}
template <class T>
bool set_gt(T a, T b) {
  return a > b;
}
template <class T>
bool set_ge(T a, T b) {
  return a >= b;
}
template <class T>
bool set_equ(T a, T b) {
  return unordered(a, b) || a == b;
}
template <class T>
bool set_neu(T a, T b) {
  return a != b;
}
template <class T>
bool set_ltu(T a, T b) {
  return !(a >= b);
}
template <class T>
bool set_leu(T a, T b) {
  return !(a > b);
}
template <class T>
bool set_gtu(T a, T b) {
  return !(a <= b);
}
template <class T>
bool set_geu(T a, T b) {
  return !(a < b);
}
template <class T>
bool set_num(T a, T b) {
  return !unordered(a, b);
}
template <class T>
bool set_nan(T a, T b) {
  return unordered(a, b);
}

/// Rounding to integers: to nearest even, to zero, down, up.
template <class T>
T rni(T a) {
  return std::nearbyint(a);
}
template <class T>
T rzi(T a) {
  return std::trunc(a);
}
template <class T>
T rmi(T a) {
  return std::floor(a);
}
template <class T>
T rpi(T a) {
  return std::ceil(a);
}

/// Conversions. A float, rounded already, to an integer: clamped; NaN is 0, of or to 64 bits the highest bit alone.
template <class To, class From>
To cvt(From a) {
  if constexpr (std::is_floating_point_v<From> && std::is_integral_v<To>) {
    constexpr bool wide = sizeof(To) == 8 || sizeof(From) == 8;
    if (a != a) return wide ? static_cast<To>(BitsOf<To>(1) << (8 * sizeof(To) - 1)) : To(0);
    if (a <= static_cast<From>(std::numeric_limits<To>::min())) return std::numeric_limits<To>::min();
    if (a >= static_cast<From>(std::numeric_limits<To>::max())) return std::numeric_limits<To>::max();
  }
  return static_cast<To>(a);
}
template <class T>
T saturate(T a) {
  return a != a ? T(0) : min(max(a, T(0)), T(1));
}

}  // namespace emulator
