// The kernels, and how they are timed.
#include "tests/gpu/ceilings.h"

#include <algorithm>
#include <string>

#include "builder/base/error.h"
#include "builder/parallel/buffer.h"
#include "builder/parallel/device_facts.h"
#include "builder/parallel/launch.h"
#include "builder/parallel/timed.h"

namespace copse {

namespace {

/// As the builders' kernels read and write boxes and nodes: 16 bytes per thread, coalesced.
struct CopyWords {
  const uint4* from;
  uint4* to;
  HD void operator()(uint32_t i) const { to[i] = from[i]; }
};

/// Independent multiply-adds in registers: per thread `chains` times `unrolled` per round. Each takes one of the 128
/// lanes of a multiprocessor for one cycle.
struct MultiplyAdd {
  static constexpr uint32_t chains = 8, unrolled = 16, perCycle = 128;

  uint32_t rounds;
  float factor, summand;
  float* sums;       ///< Per thread, so that nothing can be optimised away.
  uint64_t* cycles;  ///< Per warp, from its first instruction to its last.

  HD static uint64_t clock() {
#if COPSE_DEVICE_CODE
    return static_cast<uint64_t>(clock64());
#else
    return 0;
#endif
  }

  HD void operator()(uint32_t i) const {
    const uint64_t began = clock();
    float values[chains];
    for (uint32_t c = 0; c < chains; ++c) values[c] = static_cast<float>(i + c);
    for (uint32_t round = 0; round < rounds; ++round) {
      for (uint32_t step = 0; step < unrolled; ++step)
        for (uint32_t c = 0; c < chains; ++c) values[c] = fmaf(values[c], factor, summand);
    }
    float sum = 0;
    for (uint32_t c = 0; c < chains; ++c) sum += values[c];
    sums[i] = sum;
    if (i % 32 == 0) cycles[i / 32] = clock() - began;
  }
};

double propertyOf(const Device& device, const std::string& name) {
  for (const auto& [property, value] : propertiesOf(device))
    if (property == name) return value;
  throw DeviceError("the device does not report its " + name);
}

/// Bytes read and written per second: the best of several copies.
template <class Copy>
double copySpeed(const Device& device, std::size_t bytes, Copy copy) {
  constexpr int repetitions = 10;
  double best = 0;
  for (int i = 0; i < repetitions; ++i) {
    std::vector<PhaseTime> phases;
    const double ms = timed(device, phases, [&](const Device& recording) {
      Phase phase(recording, "copy");
      copy(recording);
    });
    best = std::max(best, 2.0 * static_cast<double>(bytes) / (ms * 1e-3));
  }
  return best;
}

struct Load {
  double ms = 0, clock = 0, multiplyAdds = 0;  ///< The last two per second.
};

Load underLoad(const Device& device, uint32_t threads, uint32_t rounds) {
  Buffer<float> sums(device, threads);
  Buffer<uint64_t> cycles(device, threads / 32);
  std::vector<PhaseTime> phases;
  Load load;
  load.ms = timed(device, phases, [&](const Device& recording) {
    launch(recording, "multiply and add", threads, MultiplyAdd{rounds, 0.999f, 0.001f, sums.data(), cycles.data()});
  });
  const std::vector<uint64_t> taken = cycles.toHost();
  load.clock = static_cast<double>(*std::max_element(taken.begin(), taken.end())) / (load.ms * 1e-3);
  load.multiplyAdds =
      static_cast<double>(threads) * rounds * MultiplyAdd::chains * MultiplyAdd::unrolled / (load.ms * 1e-3);
  return load;
}

/// Long enough for the clock to settle where power and heat let it.
Load underLongLoad(const Device& device, uint32_t threads, double ms) {
  uint32_t rounds = 64;
  Load load = underLoad(device, threads, rounds);
  while (load.ms < ms && rounds < 1u << 30) {
    const double needed = rounds * std::clamp(1.1 * ms / load.ms, 1.5, 100.0);
    rounds = static_cast<uint32_t>(std::min(needed, static_cast<double>(1u << 30)));
    load = underLoad(device, threads, rounds);
  }
  return load;
}

}  // namespace

Ceilings measureCeilings(const Device& device, std::size_t copiedBytes, double ms) {
  Ceilings found;
  {
    const std::size_t words = copiedBytes / sizeof(uint4), bytes = words * sizeof(uint4);
    Buffer<uint4> from(device, words), to(device, words);
    from.fill(1);
    found.copy = copySpeed(device, bytes, [&](const Device& recording) {
      const auto stream = static_cast<cudaStream_t>(recording.stream);
      if (cudaMemcpyAsync(to.data(), from.data(), bytes, cudaMemcpyDeviceToDevice, stream) != cudaSuccess)
        throw DeviceError("cudaMemcpyAsync failed");
    });
    found.copyByKernel = copySpeed(device, bytes, [&](const Device& recording) {
      launch(recording, "copy", static_cast<uint32_t>(words), CopyWords{from.data(), to.data()});
    });
  }
  const double multiprocessors = propertyOf(device, "multiprocessors");
  const auto threads = static_cast<uint32_t>(multiprocessors * propertyOf(device, "threads_per_multiprocessor"));
  const Load load = underLongLoad(device, threads, ms);
  found.loadMs = load.ms;
  found.clock = load.clock;
  found.instructions = load.clock * multiprocessors * MultiplyAdd::perCycle;
  found.multiplyAdds = load.multiplyAdds;
  return found;
}

}  // namespace copse
