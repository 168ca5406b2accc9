// The 32 fibers of one thread that stand for a warp's lanes on the CPU. Private to builder/parallel.
// Lanes run in order: each runs to its next collective, then hands over to the next lane; when lane 31 arrives all
// have, and lane 0 goes on. So one collective costs 32 switches, and every lane must bring the same event as lane 0.
#pragma once

#include <array>
#include <boost/context/detail/fcontext.hpp>
#include <cstdint>
#include <exception>
#include <string>

#include "builder/parallel/warp.h"

namespace copse::detail {

class FiberWarp {
 public:
  enum class Event : uint32_t { sync, ballot, shfl, leave };
  using Call = void (*)(const void* kernel, Warp& warp, uint32_t index);

  /// One warp's work: the kernel and where its shared memory is.
  struct Job {
    const char* name;
    const void* kernel;
    Call call;
    uint32_t index;
    void* shared;
  };

  FiberWarp();
  ~FiberWarp();
  FiberWarp(const FiberWarp&) = delete;
  FiberWarp& operator=(const FiberWarp&) = delete;

  /// Runs all 32 lanes to their end. What a lane threw, or a DeviceError where lanes part company; null where all went
  /// well.
  std::exception_ptr run(const Job& job);

  /// Shared memory of exactly `bytes`, so that AddressSanitizer sees an access past its end.
  void* shared(uint32_t bytes);

  void sync(uint32_t lane);
  uint32_t ballot(uint32_t lane, bool predicate);
  void shuffle(uint32_t lane, const void* value, uint32_t bytes, uint32_t from, void* result);

 private:
  struct Fiber {
    FiberWarp* warp = nullptr;
    boost::context::detail::fcontext_t context = nullptr;
    const void* stack = nullptr;  ///< Lowest address, and how many bytes above it.
    std::size_t stackBytes = 0;
    void* threadSanitizer = nullptr;
    void* fakeStack = nullptr;  ///< AddressSanitizer's.
  };
  /// What lanes bring to one collective. Two take turns: a lane may be at the next one while others still read this
  /// one.
  struct Round {
    Event event = Event::leave;
    uint32_t bytes = 0;
    uint32_t mask = 0;
    alignas(16) unsigned char values[Warp::size * Warp::maxShuffleBytes];
  };
  struct Unwind {};                               ///< Thrown in each lane to take down a warp that failed.
  static constexpr uint32_t thread = Warp::size;  ///< The fiber that is the thread itself.

  [[noreturn]] static void enter(boost::context::detail::transfer_t from);
  [[noreturn]] void live(uint32_t lane);
  void switchTo(uint32_t from, uint32_t to);
  void arrived(const boost::context::detail::transfer_t& transfer, uint32_t self);
  Round& arrive(uint32_t lane, Event event, uint32_t bytes);
  void meet(uint32_t lane);
  void leave(uint32_t lane);
  static std::string describe(Event event, uint32_t bytes);
  void fail(const std::string& what);

  std::array<Fiber, Warp::size + 1> fibers_;
  std::array<Round, 2> rounds_;
  std::array<uint32_t, Warp::size> turn_{};  ///< Collectives that each lane has been through.
  uint32_t entering_ = 0;                    ///< The lane that is started for the first time.
  uint32_t left_ = 0;                        ///< Lanes that have returned from the kernel, one bit each.
  bool unwinding_ = false;
  std::exception_ptr failure_;
  Job job_{};
  char start_ = 0, end_ = 0;  ///< Addresses at which ThreadSanitizer is told of the start's and the end's order.
  void* shared_ = nullptr;
  uint32_t sharedBytes_ = 0;
  void* stacks_ = nullptr;
};

}  // namespace copse::detail
