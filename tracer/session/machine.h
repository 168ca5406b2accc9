// What a figure was measured on and with: the machine, the compiler and its flags, and the memory of this process.
#pragma once

#include <cstdint>
#include <string>

#include "builder/parallel/device.h"

namespace copse {

/// "" and 0 where the system does not say.
struct Machine {
  std::string cpu;
  int processors = 0;        ///< That this process may use.
  uint64_t memoryBytes = 0;  ///< Of the whole machine.
  std::string system;        ///< "Debian GNU/Linux 12 (bookworm), Linux 6.1.0"
  std::string driver;        ///< Of `device`; "" on the CPU.
};
Machine machineOf(const Device& device);

struct Compiler {
  std::string name, version;
  std::string flags;  ///< Of C++ files, as CMake gave them.
  std::string cuda;   ///< The toolkit's version; "" without CUDA.
};
Compiler compiler();

/// The most memory that this process has held since startProcessPeak(), or since it began where the system cannot
/// start again. In bytes.
uint64_t processPeakBytes();
void startProcessPeak();

}  // namespace copse
