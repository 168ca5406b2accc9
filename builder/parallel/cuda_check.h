// Turns a failed CUDA call into a DeviceError. Private to builder/parallel.
#pragma once

#if COPSE_CUDA
#include <cuda_runtime_api.h>

#include "builder/parallel/device.h"

namespace copse::detail {

/// Throws DeviceError naming `call` and, since errors of kernels arrive late, the last launch.
void checkCuda(cudaError_t status, const char* call);

/// Makes `device` the one that this thread's CUDA calls go to.
void bind(const Device& device);

inline cudaStream_t streamOf(const Device& device) { return static_cast<cudaStream_t>(device.stream); }

}  // namespace copse::detail
#endif
