// The interface of the machine and of the emulated device's memory to the runtime.
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

/// The kernel of that name, or null.
const Kernel* findKernel(const std::string& name);
/// Runs all blocks of a launch; false if a fault ended it.
bool run(const Launch& launch);
/// The limits of a block: threads, and bytes of shared memory.
constexpr uint32_t maxThreads = 1024, maxShared = 227 * 1024;

/// Device memory and pinned host memory. A block ends at an inaccessible page; it is filled with 0xcb, and the bytes
/// from the start of its page to its own are checked when it is freed and when the host waits.
void* allocate(size_t bytes, bool ofHost);
/// Bytes of a block that begins at an address.
std::optional<size_t> sizeAt(const void* block);
/// Aborts with a message if bytes outside the block were written.
void checkBlock(const void* block);
void checkAllBlocks();
void release(void* block);
/// Whether a range begins in a block; a range that passes its end is reported as an error.
struct Place {
  bool found, ofHost;
};
Place placeOf(const void* address, size_t bytes);
/// In words, for messages: "12 bytes behind a block of 400 bytes".
std::string describe(uint64_t address);

/// At the end of the program, writes the counts to the file that COPSE_EMULATOR_STATISTICS names.
void count(const char* call);

}  // namespace emulator
