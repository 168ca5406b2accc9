// An exchange of lanes that is chosen once and done many times, without a branch.
#pragma once

#include "builder/math/simd.h"

namespace copse::inline COPSE_ISA {

/// Exchanges the lower and the upper two of every four lanes, or leaves them.
class PairSwap {
 public:
  PairSwap() = default;
#if defined(__AVX2__) && !COPSE_DEVICE_CODE
  HD explicit PairSwap(bool swap) : lanes_(lanesOf(swap), lanesOf(swap)) {}
  HD F32x8 operator()(const F32x8& a) const { return F32x8::of(__builtin_ia32_vpermilvarps256(a.v, lanes_.v)); }
  HD F32x4 operator()(F32x4 a) const { return F32x4::of(__builtin_ia32_vpermilvarps(a.v, lanes_.lower().v)); }

 private:
  HD static I32x4 lanesOf(bool swap) { return swap ? I32x4(2, 3, 0, 1) : I32x4(0, 1, 2, 3); }

  I32x8 lanes_;  ///< Which of its four each lane takes.
#else
  HD explicit PairSwap(bool swap) : swap_(swap) {}
  HD F32x8 operator()(const F32x8& a) const { return select(swap_, a.shuffle<2, 3, 0, 1>(), a); }
  HD F32x4 operator()(F32x4 a) const { return select(swap_.lower(), a.shuffle<2, 3, 0, 1>(), a); }

 private:
  SimdMask<8> swap_;
#endif
};

}  // namespace copse::inline COPSE_ISA
