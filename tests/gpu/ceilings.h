// The measured maximum rates of a GPU, for "least" in docs/gpu-kernels.md: the bytes per second of a copy within its
// memory, and the instructions per second of its multiprocessors at the clock that they keep while all are busy.
#pragma once

#include <cstddef>

#include "builder/parallel/device.h"

namespace copse {

/// All per second except times.
struct Ceilings {
  double copy = 0, copyByKernel = 0;  ///< Bytes that are read and written, by the driver's copy and by a kernel.
  double loadMs = 0, clock = 0;       ///< How long all lanes were kept busy, and a multiprocessor's cycles.
  double instructions = 0;            ///< Lane instructions that could issue in these cycles.
  double multiplyAdds = 0;            ///< Those that did: slightly fewer, or the clock was misread.
};

/// `device` is CUDA's. Copies `copiedBytes` and keeps all lanes busy for at least `ms`, in which the clock settles
/// where power and heat let it. Throws DeviceError.
Ceilings measureCeilings(const Device& device, std::size_t copiedBytes, double ms);

}  // namespace copse
