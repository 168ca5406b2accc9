// A run of neighbouring rays on one CPU thread: in turn, or where they are coherent, and the format has a step for
// that, one after another.
#pragma once

#include <type_traits>

#include "tracer/accel/in_turn.h"

namespace copse::inline COPSE_ISA {

/// Whether neighbouring rays are mostly coherent, as the camera's are: the signs of their directions tell.
inline bool coherent(const Ray* rays, uint32_t begin, uint32_t end) {
  const auto octant = [&](uint32_t i) {
    const vec3 d = rays[i].direction;
    return (d.x < 0 ? 1 : 0) | (d.y < 0 ? 2 : 0) | (d.z < 0 ? 4 : 0);
  };
  uint32_t changes = 0;
  for (uint32_t i = begin + 1; i < end; ++i) changes += octant(i) != octant(i - 1);
  return changes <= (end - begin) / 8;
}

template <class Format>
inline void closestOfRun(const typename Format::View& view, const Ray* rays, uint32_t begin, uint32_t end, Hit* hits) {
  using StepInARow = typename StepsOf<Format>::InARow;
  if constexpr (!std::is_void_v<StepInARow>)
    if (coherent(rays, begin, end)) {
      for (uint32_t i = begin; i < end; ++i) hits[i] = traverse<StepInARow, false>(view, rays[i]);
      return;
    }
  traverseInTurn<typename StepsOf<Format>::InTurn, false>(view, rays, begin, end,
                                                          [=](uint32_t i, const Hit& hit) { hits[i] = hit; });
}

template <class Format>
inline void anyOfRun(const typename Format::View& view, const Ray* rays, uint32_t begin, uint32_t end,
                     uint32_t* occluded) {
  traverseInTurn<typename StepsOf<Format>::InTurn, true>(
      view, rays, begin, end, [=](uint32_t i, const Hit& hit) { occluded[i] = hit.triangle != Hit::none; });
}

}  // namespace copse::inline COPSE_ISA
