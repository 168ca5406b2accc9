// Fibers as lanes: Boost.Context's bare switch between 32 stacks that are kept from launch to launch, told to the
// sanitizers. A collective costs 32 switches of some 5 ns.
#include "builder/parallel/fiber_warp.h"

#include <fmt/format.h>
#include <sys/mman.h>

#include <atomic>
#include <memory>
#include <mutex>
#include <new>
#include <utility>
#include <vector>

#include "builder/base/error.h"
#include "builder/parallel/device.h"
#include "builder/parallel/sanitizers.h"

namespace copse::detail {

using boost::context::detail::fcontext_t;
using boost::context::detail::jump_fcontext;
using boost::context::detail::make_fcontext;
using boost::context::detail::transfer_t;

namespace {

constexpr std::size_t page = 4096;
/// Address space of one lane's stack, the guard page at its end included; pages that are not touched cost nothing.
constexpr std::size_t stackStride = 256 * 1024;
/// Tops of stacks that differ by a power of two would all fall into one set of the cache.
constexpr std::size_t stackColour = 17 * 64;

using Word [[gnu::may_alias]] = uint32_t;

/// Word by word and volatile: memcpy would be ThreadSanitizer's, which takes the hand-over for a race.
COPSE_UNWATCHED void copyWords(void* to, const void* from, uint32_t bytes) {
  for (uint32_t i = 0; i < bytes / sizeof(Word); ++i)
    static_cast<volatile Word*>(to)[i] = static_cast<const volatile Word*>(from)[i];
}

}  // namespace

FiberWarp::FiberWarp() {
  stacks_ = mmap(nullptr, Warp::size * stackStride, PROT_READ | PROT_WRITE,
                 MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE | MAP_STACK, -1, 0);
  if (stacks_ == MAP_FAILED) throw DeviceError(fmt::format("out of memory: the stacks of {} lanes", Warp::size));
  for (Fiber& fiber : fibers_) fiber.warp = this;
  for (uint32_t lane = 0; lane < Warp::size; ++lane) {
    Fiber& fiber = fibers_[lane];
    char* lowest = static_cast<char*>(stacks_) + lane * stackStride;
    mprotect(lowest, page, PROT_NONE);
    fiber.stack = lowest + page;
    fiber.stackBytes = stackStride - page - lane * stackColour;
    fiber.context = make_fcontext(lowest + page + fiber.stackBytes, fiber.stackBytes, &FiberWarp::enter);
    fiber.threadSanitizer = createThreadSanitizerFiber();
  }
}

FiberWarp::~FiberWarp() {
  for (uint32_t lane = 0; lane < Warp::size; ++lane) destroyThreadSanitizerFiber(fibers_[lane].threadSanitizer);
  munmap(stacks_, Warp::size * stackStride);
  shared(0);
}

void* FiberWarp::shared(uint32_t bytes) {
  if (bytes != sharedBytes_) {
    ::operator delete(shared_, std::align_val_t(16));
    shared_ = nullptr;
    sharedBytes_ = 0;
    if (bytes) shared_ = ::operator new(bytes, std::align_val_t(16));
    sharedBytes_ = bytes;
  }
  return shared_;
}

std::exception_ptr FiberWarp::run(const Job& job) {
  job_ = job;
  left_ = 0;
  unwinding_ = false;
  failure_ = nullptr;
  turn_.fill(0);
  fibers_[thread].threadSanitizer = currentThreadSanitizerFiber();
  releaseOrder(&start_);
  switchTo(thread, 0);
  acquireOrder(&end_);
  return std::exchange(failure_, nullptr);
}

/// Leaves fiber `from` for `to`, and returns when someone switches back.
COPSE_UNWATCHED void FiberWarp::switchTo(uint32_t from, uint32_t to) {
  Fiber& self = fibers_[from];
  Fiber& next = fibers_[to];
  entering_ = to;
#if defined(COPSE_ASAN)
  __sanitizer_start_switch_fiber(&self.fakeStack, next.stack, next.stackBytes);
#endif
  switchThreadSanitizerFiber(next.threadSanitizer);
  arrived(jump_fcontext(next.context, &self), from);
}

/// The first thing done on a fiber's own stack after a switch to it.
COPSE_UNWATCHED void FiberWarp::arrived(const transfer_t& transfer, [[maybe_unused]] uint32_t self) {
  Fiber* before = static_cast<Fiber*>(transfer.data);
  before->context = transfer.fctx;
#if defined(COPSE_ASAN)
  __sanitizer_finish_switch_fiber(fibers_[self].fakeStack, &before->stack, &before->stackBytes);
#endif
}

COPSE_UNWATCHED void FiberWarp::enter(transfer_t from) {
  FiberWarp* warp = static_cast<Fiber*>(from.data)->warp;
  const uint32_t lane = warp->entering_;
  warp->arrived(from, lane);
  warp->live(lane);
}

/// A lane's life: the kernel once for each warp that its thread runs.
COPSE_UNWATCHED void FiberWarp::live(uint32_t lane) {
  for (;;) {
    if (!unwinding_) {
      acquireOrder(&start_);
      try {
        Warp warp(lane, job_.shared, this);
        job_.call(job_.kernel, warp, job_.index);
        arrive(lane, Event::leave, 0);
      } catch (const Unwind&) {
      } catch (...) {
        if (!failure_) failure_ = std::current_exception();
        unwinding_ = true;
      }
      releaseOrder(&end_);
    }
    leave(lane);
  }
}

/// Hands over to the lane that has not left yet and comes next, or to the thread.
COPSE_UNWATCHED void FiberWarp::leave(uint32_t lane) {
  left_ |= 1u << lane;
  uint32_t to = thread;
  for (uint32_t step = 1; step < Warp::size && to == thread; ++step)
    if (const uint32_t next = (lane + step) % Warp::size; !(left_ >> next & 1)) to = next;
  switchTo(lane, to);
}

std::string FiberWarp::describe(Event event, uint32_t bytes) {
  switch (event) {
    case Event::sync:
      return "is at a sync";
    case Event::ballot:
      return "is at a ballot";
    case Event::shfl:
      return fmt::format("is at a shfl of {} bytes", bytes);
    case Event::leave:
      break;
  }
  return "has left the kernel";
}

COPSE_UNWATCHED void FiberWarp::fail(const std::string& what) {
  failure_ = std::make_exception_ptr(DeviceError(fmt::format("launch '{}', warp {}: {}", job_.name, job_.index, what)));
  unwinding_ = true;
  throw Unwind{};
}

/// Lane 0 opens the round; the others must come to the same event.
COPSE_UNWATCHED FiberWarp::Round& FiberWarp::arrive(uint32_t lane, Event event, uint32_t bytes) {
  if (unwinding_) throw Unwind{};
  Round& round = rounds_[turn_[lane]++ % 2];
  if (lane == 0) {
    round.event = event;
    round.bytes = bytes;
    round.mask = 0;
  } else if (round.event != event || round.bytes != bytes) {
    fail(fmt::format("lane {} {} while lane 0 {}", lane, describe(event, bytes), describe(round.event, round.bytes)));
  }
  return round;
}

/// Lets the lanes after this one come to the collective as well.
COPSE_UNWATCHED void FiberWarp::meet(uint32_t lane) {
  switchTo(lane, (lane + 1) % Warp::size);
  if (unwinding_) throw Unwind{};
}

COPSE_UNWATCHED void FiberWarp::sync(uint32_t lane) {
  Round& round = arrive(lane, Event::sync, 0);
  releaseOrder(&round);
  meet(lane);
  acquireOrder(&round);
}

COPSE_UNWATCHED uint32_t FiberWarp::ballot(uint32_t lane, bool predicate) {
  Round& round = arrive(lane, Event::ballot, 0);
  round.mask |= static_cast<uint32_t>(predicate) << lane;
  meet(lane);
  return round.mask;
}

COPSE_UNWATCHED void FiberWarp::shuffle(uint32_t lane, const void* value, uint32_t bytes, uint32_t from, void* result) {
  Round& round = arrive(lane, Event::shfl, bytes);
  copyWords(round.values + lane * bytes, value, bytes);
  meet(lane);
  copyWords(result, round.values + from * bytes, bytes);
}

void fiberSync(FiberWarp* warp, uint32_t lane) { warp->sync(lane); }
uint32_t fiberBallot(FiberWarp* warp, uint32_t lane, bool predicate) { return warp->ballot(lane, predicate); }
void fiberShuffle(FiberWarp* warp, uint32_t lane, const void* value, uint32_t bytes, uint32_t from, void* result) {
  warp->shuffle(lane, value, bytes, from, result);
}

namespace {

/// Sets of fibers that no thread uses at the moment. They outlive threads: OpenMP ends and starts those as it likes.
class FiberPool {
 public:
  static FiberPool& get() {
    static FiberPool pool;
    return pool;
  }
  std::unique_ptr<FiberWarp> take() {
    const std::lock_guard lock(mutex_);
    if (idle_.empty()) return std::make_unique<FiberWarp>();
    std::unique_ptr<FiberWarp> fibers = std::move(idle_.back());
    idle_.pop_back();
    return fibers;
  }
  void give(std::unique_ptr<FiberWarp> fibers) {
    const std::lock_guard lock(mutex_);
    idle_.push_back(std::move(fibers));
  }

 private:
  std::mutex mutex_;
  std::vector<std::unique_ptr<FiberWarp>> idle_;
};

/// The exception of the lowest index that failed.
class Failure {
 public:
  bool below(uint32_t index) const { return index_.load(std::memory_order_relaxed) < index; }
  void set(uint32_t index, std::exception_ptr thrown) {
    const std::lock_guard lock(mutex_);
    if (index >= index_) return;
    index_ = index;
    thrown_ = std::move(thrown);
  }
  void rethrow() const {
    if (thrown_) std::rethrow_exception(thrown_);
  }

 private:
  std::mutex mutex_;
  std::atomic<uint32_t> index_ = UINT32_MAX;
  std::exception_ptr thrown_;
};

}  // namespace

void runWarpsOnFibers(const Device& device, const char* name, uint32_t warps, uint32_t sharedBytes, const void* kernel,
                      void (*call)(const void* kernel, Warp& warp, uint32_t index)) {
  Failure failure;
#pragma omp parallel num_threads(device.threads) if (warps > 1)
  {
    std::unique_ptr<FiberWarp> fibers;
#pragma omp for schedule(dynamic, 1)
    for (uint32_t i = 0; i < warps; ++i) {
      if (failure.below(i)) continue;
      try {
        if (!fibers) fibers = FiberPool::get().take();
        if (const auto thrown = fibers->run({name, kernel, call, i, fibers->shared(sharedBytes)}))
          failure.set(i, thrown);
      } catch (...) {
        failure.set(i, std::current_exception());
      }
    }
    if (fibers) FiberPool::get().give(std::move(fibers));
  }
  failure.rethrow();
}

}  // namespace copse::detail
