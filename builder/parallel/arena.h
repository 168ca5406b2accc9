// Many arrays out of few allocations: what a loop needs anew each time round, or keeps of each. On CUDA an allocation
// takes the host a microsecond or two, and its release as much again.
#pragma once

#include <algorithm>
#include <cstddef>
#include <type_traits>
#include <vector>

#include "builder/parallel/buffer.h"

namespace copse {

/// Arrays live as long as the arena, or until clear(). One that does not fit makes the arena take another block.
class Arena {
 public:
  /// Blocks have `blockBytes` at least, and a few pages.
  Arena(const Device& device, std::size_t blockBytes)
      : device_(device), blockBytes_(std::max(blockBytes, std::size_t{1} << 16)) {}

  /// `count` elements, uninitialised, aligned to 256 bytes; not null for none either.
  template <class T>
  T* take(std::size_t count) {
    static_assert(std::is_trivially_copyable_v<T> && alignof(T) <= alignment);
    return static_cast<T*>(static_cast<void*>(takeBytes(bytesOf<T>(count))));
  }

  /// All arrays are gone: what is launched from now on may have their memory. The next `bytes` are of one block.
  void clear(std::size_t bytes) {
    while (blocks_.size() > 1) blocks_.erase(blocks_.begin());
    if (!blocks_.empty() && blocks_.back().size() < bytes) blocks_.clear();
    used_ = 0;
    blockBytes_ = std::max(blockBytes_, bytes);
  }

  /// What `count` elements take of a block.
  template <class T>
  static std::size_t bytesOf(std::size_t count) {
    return rounded(detail::bytesOf(count, sizeof(T)));
  }

 private:
  using Block = Buffer<unsigned char>;
  static constexpr std::size_t alignment = 256;

  static std::size_t rounded(std::size_t bytes) {
    return std::max(alignment, (bytes + alignment - 1) / alignment * alignment);
  }
  unsigned char* takeBytes(std::size_t bytes) {
    if (blocks_.empty() || blocks_.back().size() - used_ < bytes) {
      blocks_.emplace_back(device_, std::max(bytes, blockBytes_));
      used_ = 0;
    }
    unsigned char* const memory = blocks_.back().data() + used_;
    used_ += bytes;
    return memory;
  }

  Device device_;
  std::size_t blockBytes_;
  std::vector<Block> blocks_;
  std::size_t used_ = 0;  ///< In the last block.
};

}  // namespace copse
