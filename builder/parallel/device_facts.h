// What a device says about itself and about its memory: for records, not for decisions.
#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "builder/parallel/device.h"

namespace copse {

/// Bytes that buffers hold now: the device's pool on CUDA, 0 where it has none; every Buffer of the
/// program on the CPU.
uint64_t bytesInUse(const Device& device);

/// The maximum of bytesInUse since the last startPeak. What a method keeps in containers of its own on the
/// host is not in it.
void startPeak(const Device& device);
uint64_t peakBytes(const Device& device);

/// "580.65.06, CUDA 13.0" for a CUDA device; "" on the CPU and where the driver does not say.
std::string driverOf(const Device& device);

/// What a CUDA device says of itself, by name: its multiprocessors, memory, caches and clocks, in the units that the
/// names end in. Empty on the CPU; a property that the driver does not know is left out.
std::vector<std::pair<std::string, double>> propertiesOf(const Device& device);

/// The toolkit that this program was compiled with, such as "13.0"; "" where it was compiled without one.
std::string cudaToolkit();

}  // namespace copse
