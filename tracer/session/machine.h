// Where and with what a figure was measured: the machine, the compiler and its flags, and the memory of this process.
#pragma once

#include <cstdint>
#include <string>

#include "builder/parallel/device.h"

namespace copse {

/// "" and 0 where the system does not say.
struct Machine {
  std::string cpu;
  int processors = 0;        ///< Those that this process may use.
  uint64_t memoryBytes = 0;  ///< The machine's physical memory.
  std::string system;        ///< "Debian GNU/Linux 12 (bookworm), Linux 6.1.0"
  std::string driver;        ///< The driver of `device`; "" on the CPU.
};
Machine machineOf(const Device& device);

struct Compiler {
  std::string name, version;
  std::string flags;  ///< For C++ files, as CMake passed them.
  std::string cuda;   ///< The toolkit's version; "" without CUDA.
};
Compiler compiler();

/// The peak memory of this process in bytes, since startProcessPeak() or, where the system cannot reset it, since the
/// process began.
uint64_t processPeakBytes();
void startProcessPeak();

}  // namespace copse
