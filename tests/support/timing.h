// Shared by the programs that measure.
#pragma once

#include <algorithm>
#include <chrono>
#include <functional>
#include <vector>

namespace copse::test {

inline double millisecondsOf(const std::function<void()>& work) {
  const auto start = std::chrono::steady_clock::now();
  work();
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

/// 0 for none.
inline double minimum(const std::vector<double>& values) {
  return values.empty() ? 0 : *std::min_element(values.begin(), values.end());
}

}  // namespace copse::test
