// The device's memory: one reserved range that is never reused, so that access to a freed block always faults.
#include <sys/mman.h>

#include <cstdio>
#include <cstdlib>
#include <map>

#include "grid.h"

namespace emulator {

namespace {

constexpr size_t page = 4096, granule = 256, reserved = size_t(1) << 40;
/// Larger blocks keep the zeros of fresh pages: filling them would commit memory that is never touched.
constexpr size_t mostFilled = size_t(64) << 20;
constexpr uint8_t slack = 0xfd, poison = 0xcb;

struct Block {
  size_t bytes;
  bool ofHost;
};

size_t roundUp(size_t bytes, size_t to) { return (bytes + to - 1) / to * to; }

uint8_t* arena() {
  static uint8_t* const begin = [] {
    void* range = mmap(nullptr, reserved, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE, -1, 0);
    if (range == MAP_FAILED) std::perror("emulator: reserving device memory"), std::abort();
    return static_cast<uint8_t*>(range);
  }();
  return begin;
}

std::map<const uint8_t*, Block>& blocks() {
  static auto* const all = new std::map<const uint8_t*, Block>;
  return *all;
}

uint8_t* pagesOf(const uint8_t* block) { return arena() + (block - arena()) / page * page; }
uint8_t* endOf(const uint8_t* block, size_t bytes) { return const_cast<uint8_t*>(block) + roundUp(bytes, granule); }

/// The last block that begins at an address or before it.
auto blockBefore(const void* address) {
  auto after = blocks().upper_bound(static_cast<const uint8_t*>(address));
  return after == blocks().begin() ? blocks().end() : std::prev(after);
}

}  // namespace

bool isCached(uint64_t address) { return address - reinterpret_cast<uint64_t>(arena()) < reserved; }

void* allocate(size_t bytes, bool ofHost) {
  static size_t used = page;
  const size_t rounded = roundUp(std::max<size_t>(bytes, 1), granule), pages = roundUp(rounded, page);
  if (used + pages + page > reserved) return nullptr;
  uint8_t* const begin = arena() + used;
  if (mprotect(begin, pages, PROT_READ | PROT_WRITE) != 0) return nullptr;
  used += pages + page;
  uint8_t* const block = begin + (pages - rounded);
  std::memset(begin, slack, block - begin);
  if (rounded <= mostFilled) {
    std::memset(block, poison, bytes);
    std::memset(block + bytes, slack, rounded - bytes);
  }
  blocks()[block] = {bytes, ofHost};
  return block;
}

std::optional<size_t> sizeAt(const void* block) {
  const auto found = blocks().find(static_cast<const uint8_t*>(block));
  return found == blocks().end() ? std::nullopt : std::optional(found->second.bytes);
}

void checkBlock(const void* address) {
  const auto* block = static_cast<const uint8_t*>(address);
  const size_t bytes = blocks().at(block).bytes;
  const auto checkBytes = [&](const uint8_t* begin, const uint8_t* end) {
    for (const uint8_t* at = begin; at < end; ++at)
      if (*at != slack) {
        std::fprintf(stderr, "emulator: written %s\n", describe(reinterpret_cast<uint64_t>(at)).c_str());
        std::abort();
      }
  };
  checkBytes(pagesOf(block), block);
  if (roundUp(bytes, granule) <= mostFilled) checkBytes(block + bytes, endOf(block, bytes));
}

void checkAllBlocks() {
  for (const auto& [block, of] : blocks())
    if (!of.ofHost) checkBlock(block);
}

void release(void* address) {
  const auto* block = static_cast<const uint8_t*>(address);
  checkBlock(block);
  uint8_t* const begin = pagesOf(block);
  const size_t pages = endOf(block, std::max<size_t>(blocks().at(block).bytes, 1)) - begin;
  blocks().erase(block);
  mmap(begin, pages, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE | MAP_FIXED, -1, 0);
}

Place placeOf(const void* address, size_t bytes) {
  const auto found = blockBefore(address);
  const auto* first = static_cast<const uint8_t*>(address);
  if (found == blocks().end() || first >= found->first + found->second.bytes) return {false, false};
  if (first + bytes > found->first + found->second.bytes) {
    std::fprintf(stderr, "emulator: a copy of %zu bytes passes the end of a block of %zu\n", bytes,
                 found->second.bytes);
    std::abort();
  }
  return {true, found->second.ofHost};
}

std::string describe(uint64_t address) {
  char text[160];
  const auto* at = reinterpret_cast<const uint8_t*>(address);
  const auto before = blockBefore(at);
  const auto after = blocks().upper_bound(at);
  if (before != blocks().end() && static_cast<size_t>(at - before->first) < before->second.bytes + page)
    std::snprintf(text, sizeof text, "%td bytes behind the begin of a block of %zu", at - before->first,
                  before->second.bytes);
  else if (after != blocks().end() && static_cast<size_t>(after->first - at) < page)
    std::snprintf(text, sizeof text, "%td bytes before a block of %zu", after->first - at, after->second.bytes);
  else
    std::snprintf(text, sizeof text, "at 0x%llx, in no block: one that was freed, or none ever",
                  static_cast<unsigned long long>(address));
  return text;
}

}  // namespace emulator
