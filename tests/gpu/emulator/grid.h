// What the runtime asks of the machine, and of the emulated device's memory.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "machine.h"

namespace emulator {

/// COPSE_EMULATOR_NAME of the environment as a number.
int setting(const char* name, int otherwise);

struct Launch {
  const Kernel* kernel;
  uint32_t grid[3], block[3];
  uint32_t dynamicShared;
  bool cooperative;
  std::vector<uint8_t> parameters;
};

/// The kernel of a name, or null.
const Kernel* findKernel(const std::string& name);
/// Runs all blocks of a launch; false where it was ended by a fault.
bool run(const Launch& launch);
/// The limits of a block: threads, and bytes of shared memory.
constexpr uint32_t maxThreads = 1024, maxShared = 227 * 1024;

/// Device memory, and the host's that is pinned. A block ends at a page that cannot be touched; it is filled with 0xcb,
/// and what lies between its page's begin and itself is checked when it is freed and when the host waits.
void* allocate(size_t bytes, bool ofHost);
/// Bytes of a block that begins at an address.
std::optional<size_t> sizeAt(const void* block);
/// Aborts with a message where bytes beside the block were written.
void checkBlock(const void* block);
void checkAllBlocks();
void release(void* block);
/// Whether a range begins in a block; a range that passes its end is an error that is told.
struct Place {
  bool found, ofHost;
};
Place placeOf(const void* address, size_t bytes);
/// In words, for messages: "12 bytes behind a block of 400 bytes".
std::string describe(uint64_t address);

/// Writes what was counted, at the end of the program, to the file that COPSE_EMULATOR_STATISTICS names.
void count(const char* call);

}  // namespace emulator
