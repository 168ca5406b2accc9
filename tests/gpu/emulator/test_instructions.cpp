// What the emulator computes for an instruction against PTX's manual, where the C++ operator differs.
#include <cmath>
#include <cstdint>
#include <limits>

#include "tests/gpu/emulator/instructions.h"
#include "tests/support/catch.h"

using namespace emulator;

namespace {
constexpr float infinity = std::numeric_limits<float>::infinity();
constexpr float notANumber = std::numeric_limits<float>::quiet_NaN();
}  // namespace

TEST_CASE("emulated shifts by the width and more give zeros or sign bits") {
  CHECK(shl<uint32_t>(1, 31) == 0x80000000u);
  CHECK(shl<uint32_t>(1, 32) == 0);
  CHECK(shl<uint64_t>(1, 64) == 0);
  CHECK(shr<uint32_t>(~0u, 40) == 0);
  CHECK(shr<int32_t>(-8, 1) == -4);
  CHECK(shr<int32_t>(-8, 99) == -1);
  CHECK(shf_r_wrap<uint32_t>(0x11223344, 0xaabbccdd, 40) == 0xdd112233u);
  CHECK(shf_r_clamp<uint32_t>(0x11223344, 0xaabbccdd, 40) == 0xaabbccddu);
  CHECK(shf_l_wrap<uint32_t>(0x11223344, 0xaabbccdd, 8) == 0xbbccdd11u);
  CHECK(shf_l_clamp<uint32_t>(0x11223344, 0xaabbccdd, 32) == 0x11223344u);
}

TEST_CASE("emulated integers wrap around, and division by zero gives all bits") {
  CHECK(add<int32_t>(0x7fffffff, 1) == std::numeric_limits<int32_t>::min());
  CHECK(mul_lo<uint32_t>(0x10001, 0x10001) == 0x20001);
  CHECK(mul_hi<uint32_t>(~0u, ~0u) == 0xfffffffeu);
  CHECK(mul_hi<int32_t>(-1, 1) == -1);
  CHECK(mul_wide<int32_t>(-3, 5) == int64_t{-15});
  CHECK(mad_wide<uint32_t>(~0u, 2, 3) == 2 * uint64_t{~0u} + 3);
  CHECK(div<uint32_t>(7, 0) == ~0u);
  CHECK(rem<uint32_t>(7, 0) == 7);
  CHECK(div<int32_t>(std::numeric_limits<int32_t>::min(), -1) == std::numeric_limits<int32_t>::min());
}

TEST_CASE("emulated minima prefer numbers to NaN, and -0 to +0") {
  CHECK(min<float>(notANumber, 3) == 3);
  CHECK(max<float>(3, notANumber) == 3);
  CHECK(std::isnan(min<float>(notANumber, notANumber)));
  CHECK(std::signbit(min<float>(0.0f, -0.0f)));
  CHECK_FALSE(std::signbit(max<float>(-0.0f, 0.0f)));
  CHECK(std::bit_cast<uint32_t>(max<float>(notANumber, notANumber)) == 0x7fffffffu);
  CHECK(min<int32_t>(-1, 1) == -1);
  CHECK(max<uint32_t>(~0u, 1) == ~0u);
}

TEST_CASE("emulated comparisons with NaN are false, those that end with u true") {
  CHECK_FALSE(set_eq(notANumber, notANumber));
  CHECK_FALSE(set_ne(notANumber, 1.0f));
  CHECK_FALSE(set_lt(notANumber, 1.0f));
  CHECK(set_equ(notANumber, 1.0f));
  CHECK(set_neu(notANumber, notANumber));
  CHECK(set_ltu(notANumber, 1.0f));
  CHECK(set_geu(1.0f, notANumber));
  CHECK_FALSE(set_gtu(1.0f, 2.0f));
  CHECK(set_nan(1.0f, notANumber));
  CHECK_FALSE(set_num(1.0f, notANumber));
}

TEST_CASE("emulated conversions clamp, and NaN becomes 0 or the highest bit") {
  CHECK(cvt<int32_t>(1e20f) == std::numeric_limits<int32_t>::max());
  CHECK(cvt<int32_t>(-infinity) == std::numeric_limits<int32_t>::min());
  CHECK(cvt<uint32_t>(-1.0f) == 0);
  CHECK(cvt<int32_t>(notANumber) == 0);
  CHECK(cvt<uint64_t>(static_cast<double>(notANumber)) == 1ull << 63);
  CHECK(cvt<uint32_t>(static_cast<double>(notANumber)) == 0x80000000u);
  CHECK(cvt<int32_t>(rni(2.5f)) == 2);
  CHECK(cvt<int32_t>(rmi(-0.5f)) == -1);
  CHECK(cvt<int32_t>(rpi(0.5f)) == 1);
  CHECK(saturate(notANumber) == 0);
  CHECK(saturate(7.0f) == 1);
}

TEST_CASE("emulated registers keep the bits of a type, and a narrow result extends by its sign") {
  CHECK(as<float>(uint32_t{0x3f800000}) == 1.0f);
  CHECK(as<int8_t>(uint16_t{0xff80}) == -128);
  CHECK(to<uint32_t>(int8_t{-1}) == ~0u);
  CHECK(to<uint32_t>(uint8_t{0xff}) == 0xffu);
  CHECK(to<uint32_t>(1.0f) == 0x3f800000u);
}

TEST_CASE("emulated fields of bits") {
  CHECK(bfi<uint32_t>(0xff, 0, 4, 8) == 0xff0u);
  CHECK(bfi<uint64_t>(1, ~0ull, 32, 32) == 0x1ffffffffull);
  CHECK(bfe<uint32_t>(0xabcd, 4, 8) == 0xbcu);
  CHECK(bfe<uint64_t>(~0ull, 0, 64) == ~0ull);
  CHECK(bfind<uint32_t>(0) == ~0u);
  CHECK(bfind<uint32_t>(0x80) == 7);
  CHECK(bfind_shiftamt<uint32_t>(1) == 31);
  CHECK(clz<uint64_t>(0) == 64);
  CHECK(brev<uint32_t>(1) == 0x80000000u);
  CHECK(prmt<uint32_t>(0x33221100, 0x77665544, 0x7410) == 0x77441100u);
  CHECK(prmt<uint32_t>(0x00000080, 0, 0x8888) == 0xffffffffu);
  CHECK(lop3<uint32_t>(0xf0, 0xcc, 0xaa, 0xe8) == ((0xf0u & 0xcc) | (0xf0 & 0xaa) | (0xcc & 0xaa)));
}

TEST_CASE("emulated approximations flush subnormal numbers") {
  CHECK(rsqrt_approx_ftz(4.0f) == 0.5f);
  CHECK(rsqrt_approx_ftz(1e-40f) == infinity);
  CHECK(ex2_approx_ftz(3.0f) == 8.0f);
  CHECK(ex2_approx_ftz(-130.0f) == 0.0f);
}
