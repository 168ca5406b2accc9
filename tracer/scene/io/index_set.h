// A set of small integers with its next member at hand: bits, and above them bits that say which words have any.
#pragma once

#include <bit>
#include <cstdint>
#include <vector>

namespace copse {

class IndexSet {
 public:
  static constexpr uint32_t none = ~0u;

  /// All of 0 … n - 1.
  explicit IndexSet(uint32_t n) {
    for (uint32_t bits = n; levels_.empty() || bits > 1; bits = (bits + 63) / 64) {
      levels_.emplace_back((bits + 63) / 64, ~uint64_t{0});
      if (bits % 64) levels_.back().back() = (uint64_t{1} << bits % 64) - 1;
    }
  }

  void insert(uint32_t i) {
    for (auto& level : levels_) level[i / 64] |= uint64_t{1} << i % 64, i /= 64;
  }

  void erase(uint32_t i) {
    for (auto& level : levels_) {
      level[i / 64] &= ~(uint64_t{1} << i % 64);
      if (level[i / 64]) return;
      i /= 64;
    }
  }

  /// The smallest member that is not below i, or none. O(log n) to the base of 64.
  uint32_t from(uint32_t i) const {
    for (std::size_t up = 0; up < levels_.size(); ++up, i = i / 64 + 1) {
      if (i / 64 >= levels_[up].size()) return none;
      const uint64_t word = levels_[up][i / 64] >> i % 64;
      if (!word) continue;
      i += static_cast<uint32_t>(std::countr_zero(word));
      while (up-- > 0) i = i * 64 + static_cast<uint32_t>(std::countr_zero(levels_[up][i]));
      return i;
    }
    return none;
  }

 private:
  std::vector<std::vector<uint64_t>> levels_;  ///< From the members up to one word.
};

}  // namespace copse
