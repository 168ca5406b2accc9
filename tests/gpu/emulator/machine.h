// The machine that translated kernels run on: one fiber per thread, warps and blocks of fibers, several blocks at a
// time. Fibers switch at collectives, at barriers and, at random, at atomics.
#pragma once

#include <cstdint>
#include <cstring>
#include <string_view>
#include <type_traits>

#include "instructions.h"

namespace emulator {

/// What a thread sees of itself.
struct Thread {
  uint32_t tid[3], ntid[3], ctaid[3], nctaid[3], laneid;
  uint64_t workspace;      ///< For cooperative groups: two words in which a grid barrier counts.
  uint64_t shared;         ///< Address of the block's shared memory: below 4 GiB, so that 32 bits hold it.
  uint32_t dynamicShared;  ///< Offset of the part whose size the launch gives.
};

/// An instruction at which threads meet, and how often they did.
struct Point {
  const char* kernel;
  const char* source;  ///< FILE:LINE of the program.
  const char* what;
  uint64_t meetings = 0, threads = 0;
};

/// A kernel as translated. `offsets` and `sizes` are those of its parameters in a block of `parameterBytes`.
struct Kernel {
  const char* name;
  void (*run)(Thread&, const uint8_t* parameters);
  uint32_t parameterBytes, staticShared, maxThreads, parameterCount;
  const uint32_t *offsets, *sizes;
};

/// Makes a translated module known before main().
struct Registration {
  Registration(const Kernel* kernels, size_t kernelCount, Point* points, size_t pointCount);
};

enum class Shuffle { up, down, bfly, idx };
/// shfl.sync: `clamp` is its third operand, with the segments' mask; false in `within` where a lane keeps its own
/// value.
uint32_t shuffle(Shuffle mode, uint32_t value, uint32_t source, uint32_t clamp, uint32_t members, bool& within, Point&);
uint32_t ballot(bool vote, uint32_t members, Point&);
void warpBarrier(uint32_t members, Point&);
/// A block's barrier; true where any thread came with `vote`.
bool blockBarrier(bool vote, Point&);
/// Lets others run: always, or at one in a given number of calls.
void yield();
void maybeYield();
/// Nanoseconds: the emulated device's clock.
uint64_t clock64();
/// Reports what is wrong and where, and ends the launch; the device is lost as after a kernel's fault.
[[noreturn]] void trap(std::string_view what);

/// Whether a block's weak loads go through an L1 that keeps its sectors of 32 bytes until an acquire.
extern const bool staleCaches;
bool isCached(uint64_t address);
uint32_t cachedWord(uint64_t address);
/// Counts a load of bytes that have changed since: the kernel lacks an acquire.
void staleRead();
/// The L1 sees the block's own stores; an atomic, which goes to the L2, evicts the sector.
void storedWord(uint64_t address);
void forget(uint64_t address);
/// An acquire of the device's scope: the block's L1 forgets everything.
void acquire();

/// Checks that an address is aligned for an access of this size; a GPU faults otherwise.
template <uint32_t bytes>
uint64_t aligned(uint64_t address) {
  if (address % bytes != 0) trap("a misaligned address");
  return address;
}

template <class T>
T load(uint64_t address) {
  T value;
  std::memcpy(&value, reinterpret_cast<const void*>(address), sizeof value);
  return value;
}
template <class T>
void store(uint64_t address, T value) {
  std::memcpy(reinterpret_cast<void*>(address), &value, sizeof value);
}

/// Global memory, by ld and st without ordering.
template <class T>
T loadWeak(uint64_t address) {
  if (!staleCaches || !isCached(address)) return load<T>(address);
  constexpr uint32_t words = sizeof(T) < 4 ? 1 : sizeof(T) / 4;
  uint32_t cached[words];
  for (uint32_t i = 0; i < words; ++i) cached[i] = cachedWord((address & ~3ull) + 4 * i);
  T value;
  std::memcpy(&value, reinterpret_cast<const char*>(cached) + (address & 3), sizeof value);
  const T now = load<T>(address);
  if (std::memcmp(&value, &now, sizeof value) != 0) staleRead();
  return value;
}
template <class T>
void storeWeak(uint64_t address, T value) {
  store(address, value);
  if (!staleCaches || !isCached(address)) return;
  for (uint64_t word = address & ~3ull; word < address + sizeof(T); word += 4) storedWord(word);
}

/// Read, compute, write: nothing interrupts, since fibers switch only at calls.
template <class T, class Compute>
T atomic(uint64_t address, bool acquires, const Compute& compute) {
  maybeYield();
  const T old = load<T>(aligned<sizeof(T)>(address));
  store<T>(address, compute(old));
  if (staleCaches && isCached(address)) forget(address);
  if (acquires) acquire();
  maybeYield();
  return old;
}

}  // namespace emulator
