// Fibers as threads: the scheduler, faults, and counters.
#include "machine.h"

#include <cxxabi.h>
#include <signal.h>
#include <sys/mman.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <string>

#include "fibers.h"

namespace emulator {

using boost::context::detail::fcontext_t;
using boost::context::detail::jump_fcontext;
using boost::context::detail::make_fcontext;
using boost::context::detail::transfer_t;

int setting(const char* name, int otherwise) {
  const char* text = std::getenv((std::string("COPSE_EMULATOR_") + name).c_str());
  return text ? std::atoi(text) : otherwise;
}

const bool staleCaches = setting("STALE", 0) != 0;

/// Modules register themselves in an unspecified order, so the first access creates it.
State& state() {
  static State* only;
  if (!only) only = new State;
  return *only;
}

void toScheduler() { state().scheduler = jump_fcontext(state().scheduler, nullptr).fctx; }

namespace {

constexpr size_t stackBytes = 128 * 1024, page = 4096, sharedArena = 256 * 1024;
const int seed = setting("SEED", 0);
const uint64_t blocksAtATime = setting("BLOCKS", 2);
const uint64_t switchAtOneOf = setting("SWITCH", 16);
/// This many rounds in which every thread that ran only yielded, or in which no thread ended, are taken for an infinite
/// loop.
constexpr uint64_t mostIdleRounds = 2'000'000, mostRounds = 50'000'000;

uint32_t random() {
  static uint64_t x = 0x9e3779b97f4a7c15ull * (seed + 1);
  x ^= x << 13;
  x ^= x >> 7;
  x ^= x << 17;
  return static_cast<uint32_t>(x >> 32);
}

std::string readable(const char* name) {
  int status;
  const std::unique_ptr<char, void (*)(void*)> text(abi::__cxa_demangle(name, nullptr, nullptr, &status), std::free);
  return status == 0 ? text.get() : name;
}

void* mapped(size_t bytes, int flags) {
  void* memory =
      mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS | MAP_NORESERVE | flags, -1, 0);
  if (memory == MAP_FAILED) std::perror("emulator: mmap"), std::abort();
  return memory;
}

void suspend(Fiber& self, Wait wait) {
  self.wait = wait;
  toScheduler();
}

void tell(std::string_view what) {
  const Fiber* self = state().running;
  std::fprintf(stderr, "emulator: %.*s, in %s", static_cast<int>(what.size()), what.data(),
               readable(state().launch->kernel->name).c_str());
  if (self)
    std::fprintf(stderr, ", block %u %u %u, thread %u %u %u", self->thread.ctaid[0], self->thread.ctaid[1],
                 self->thread.ctaid[2], self->thread.tid[0], self->thread.tid[1], self->thread.tid[2]);
  std::fprintf(stderr, "\n");
}

void leave(Fiber& self) {
  for (uint32_t which = 0; which < 32; ++which) {
    const Fiber* other = lane(self, which);
    const bool meets = other && other->wait >= Wait::shuffle && other->wait <= Wait::warpBarrier;
    if (meets && other->members >> self.thread.laneid & 1) trap("a lane leaves while others of the mask wait for it");
  }
  self.wait = Wait::left;
  --self.block->alive;
  openBarrier(*self.block);
}

void enter(transfer_t from) {
  state().scheduler = from.fctx;
  Fiber& self = *static_cast<Fiber*>(from.data);
  state().launch->kernel->run(self.thread, state().launch->parameters.data());
  leave(self);
  toScheduler();
  std::abort();
}

Fiber* freeFiber() {
  auto& free = state().freeFibers;
  if (free.empty()) {
    auto* fiber = new Fiber;
    fiber->stack = static_cast<uint8_t*>(mapped(stackBytes, 0));
    mprotect(fiber->stack, page, PROT_NONE);
    free.push_back(fiber);
  }
  Fiber* fiber = free.back();
  free.pop_back();
  return fiber;
}

/// Shared memory is where 32 bits reach it, before an inaccessible page.
uint8_t* freeArena() {
  auto& free = state().freeArenas;
  if (free.empty()) {
    auto* arena = static_cast<uint8_t*>(mapped(sharedArena + page, MAP_32BIT));
    mprotect(arena + sharedArena, page, PROT_NONE);
    free.push_back(arena);
  }
  uint8_t* arena = free.back();
  free.pop_back();
  return arena;
}

Block* makeBlock(const Launch& launch, uint64_t index, uint64_t* workspace) {
  auto* block = new Block;
  const uint32_t *grid = launch.grid, *size = launch.block;
  block->alive = size[0] * size[1] * size[2];
  block->arena = freeArena();
  const uint32_t sharedBytes = (launch.kernel->staticShared + launch.dynamicShared + 127) / 128 * 128;
  uint8_t* const shared = block->arena + sharedArena - sharedBytes;
  std::memset(shared, 0xcd, sharedBytes);
  for (uint32_t i = 0; i < block->alive; ++i) {
    Fiber* fiber = freeFiber();
    fiber->block = block;
    fiber->wait = Wait::nothing;
    fiber->point = nullptr;
    fiber->vote = false;
    fiber->thread = {{i % size[0], i / size[0] % size[1], i / size[0] / size[1]},
                     {size[0], size[1], size[2]},
                     {static_cast<uint32_t>(index % grid[0]), static_cast<uint32_t>(index / grid[0] % grid[1]),
                      static_cast<uint32_t>(index / grid[0] / grid[1])},
                     {grid[0], grid[1], grid[2]},
                     i % 32,
                     launch.cooperative ? reinterpret_cast<uint64_t>(workspace) : 0,
                     reinterpret_cast<uint64_t>(shared),
                     launch.kernel->staticShared};
    fiber->context = make_fcontext(fiber->stack + stackBytes, stackBytes - page, enter);
    block->threads.push_back(fiber);
  }
  for (uint32_t i = 0; i < block->alive; ++i) {
    block->threads[i]->warp = &block->threads[i / 32 * 32];
    block->threads[i]->lanesOfWarp = std::min(32u, block->alive - i / 32 * 32);
  }
  return block;
}

void destroy(Block* block) {
  for (Fiber* fiber : block->threads) state().freeFibers.push_back(fiber);
  state().freeArenas.push_back(block->arena);
  delete block;
}

/// One turn of every thread that can run, in an order given by the seed; returns whether any did more than yield,
/// whether any ran at all, and whether any ended.
struct Turn {
  bool progress = false, any = false, left = false;
};
Turn runBlock(Block& block) {
  Turn turn;
  const size_t count = block.threads.size(), shift = seed ? random() % count : 0;
  for (size_t i = 0; i < count && !state().failed; ++i) {
    Fiber& fiber = *block.threads[(i + shift) % count];
    if (!fiber.ready()) continue;
    turn.any = true;
    if (seed && random() % 4 == 0) continue;
    state().running = &fiber;
    fiber.wait = Wait::nothing;
    fiber.context = jump_fcontext(fiber.context, &fiber).fctx;
    state().running = nullptr;
    turn.progress |= fiber.wait != Wait::yielded;
    turn.left |= fiber.wait == Wait::left;
  }
  return turn;
}

void tellWhoWaits(const std::vector<Block*>& blocks) {
  std::map<std::string, uint64_t> waiting;
  for (const Block* block : blocks)
    for (const Fiber* fiber : block->threads)
      if (fiber->wait != Wait::left && fiber->point)
        ++waiting[std::string(fiber->point->source) + ", " + fiber->point->what];
  for (const auto& [where, threads] : waiting)
    std::fprintf(stderr, "emulator:   %llu threads wait at %s\n", static_cast<unsigned long long>(threads),
                 where.c_str());
}

void runBlocks(const Launch& launch) {
  static uint64_t workspace[16];
  std::memset(workspace, 0, sizeof workspace);
  const uint64_t blocks = uint64_t(launch.grid[0]) * launch.grid[1] * launch.grid[2];
  const uint64_t atATime = launch.cooperative ? blocks : blocksAtATime;
  std::vector<Block*> live;
  uint64_t next = 0, idle = 0, rounds = 0;
  while ((next < blocks || !live.empty()) && !state().failed) {
    while (live.size() < atATime && next < blocks) live.push_back(makeBlock(launch, next++, workspace));
    Turn turn;
    for (size_t i = 0; i < live.size() && !state().failed; ++i) {
      const Turn ofBlock = runBlock(*live[i]);
      turn.any |= ofBlock.any;
      turn.progress |= ofBlock.progress;
      turn.left |= ofBlock.left;
      if (live[i]->alive > 0 || state().failed) continue;
      destroy(live[i]);
      live.erase(live.begin() + i--);
    }
    idle = turn.progress ? 0 : idle + 1;
    rounds = turn.left ? 0 : rounds + 1;
    if (state().failed || (turn.any && idle < mostIdleRounds && rounds < mostRounds)) continue;
    if (live.empty()) continue;
    tell(turn.any ? "a loop without end" : "deadlock");
    tellWhoWaits(live);
    state().failed = true;
  }
  for (Block* block : live) destroy(block);
}

/// A kernel's fault goes to the scheduler; one of the host is left to the host.
void onFault(int signal, siginfo_t* info, void*) {
  if (!state().running) {
    ::signal(signal, SIG_DFL);
    return;
  }
  trap("a touch " + describe(reinterpret_cast<uint64_t>(info->si_addr)));
}

/// Handles faults during a launch: those of the host have their own handler.
class FaultHandler {
 public:
  FaultHandler() {
    static void* const memory = mapped(stackBytes, 0);
    const stack_t stack = {memory, 0, stackBytes};
    sigaltstack(&stack, &stack_);
    struct sigaction action = {};
    action.sa_sigaction = onFault;
    action.sa_flags = SA_SIGINFO | SA_ONSTACK | SA_NODEFER;
    for (int i = 0; i < 2; ++i) sigaction(signals[i], &action, &actions_[i]);
  }
  ~FaultHandler() {
    for (int i = 0; i < 2; ++i) sigaction(signals[i], &actions_[i], nullptr);
    sigaltstack(&stack_, nullptr);
  }
  FaultHandler(const FaultHandler&) = delete;
  FaultHandler& operator=(const FaultHandler&) = delete;

 private:
  static constexpr int signals[2] = {SIGSEGV, SIGBUS};
  stack_t stack_;
  struct sigaction actions_[2];
};

void writeStatistics(std::FILE* out) {
  const auto line = [&](const char* what, uint64_t a, uint64_t b, double seconds, const std::string& name) {
    std::fprintf(out, "%s\t%llu\t%llu\t%.3f\t%s\n", what, static_cast<unsigned long long>(a),
                 static_cast<unsigned long long>(b), seconds, name.c_str());
  };
  for (const auto& [call, times] : state().calls) line("call", times, 0, 0, call);
  for (const auto& [name, count] : state().counts) {
    line("kernel", count.launches, count.threads, count.seconds, readable(name.c_str()));
    if (count.staleReads) line("stale", count.staleReads, 0, 0, readable(name.c_str()));
    if (count.meetingsAtTwoPoints) line("two points", count.meetingsAtTwoPoints, 0, 0, readable(name.c_str()));
  }
  for (const auto& [points, count] : state().points)
    for (const Point* point = points; point < points + count; ++point)
      if (point->meetings)
        line("meeting", point->meetings, point->threads, 0,
             std::string(point->source) + "\t" + point->what + "\t" + readable(point->kernel));
}

/// Writes the counts; a program that read stale words has failed, whatever its own result.
struct AtEnd {
  ~AtEnd() {
    if (const char* path = std::getenv("COPSE_EMULATOR_STATISTICS"))
      if (std::FILE* out = std::fopen(path, "a")) {
        writeStatistics(out);
        std::fclose(out);
      }
    bool stale = false;
    for (const auto& [name, count] : state().counts) {
      if (count.staleReads == 0) continue;
      std::fprintf(stderr, "emulator: %llu stale reads in %s\n", static_cast<unsigned long long>(count.staleReads),
                   readable(name.c_str()).c_str());
      stale = true;
    }
    if (!stale) return;
    std::fflush(nullptr);
    _exit(1);
  }
} atEnd;

}  // namespace

Registration::Registration(const Kernel* kernels, size_t kernelCount, Point* points, size_t pointCount) {
  for (size_t i = 0; i < kernelCount; ++i) state().kernels[kernels[i].name] = kernels[i];
  state().points.emplace_back(points, pointCount);
}

const Kernel* findKernel(const std::string& name) {
  const auto found = state().kernels.find(name);
  return found == state().kernels.end() ? nullptr : &found->second;
}

void count(const char* call) { ++state().calls[call]; }

bool run(const Launch& launch) {
  const FaultHandler handler;
  const auto begin = std::chrono::steady_clock::now();
  state().launch = &launch;
  state().counting = &state().counts[launch.kernel->name];
  state().failed = false;
  runBlocks(launch);
  KernelCount& counted = *state().counting;
  ++counted.launches;
  counted.threads +=
      uint64_t(launch.grid[0]) * launch.grid[1] * launch.grid[2] * launch.block[0] * launch.block[1] * launch.block[2];
  counted.seconds += std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return !state().failed;
}

void yield() { suspend(*state().running, Wait::yielded); }

void maybeYield() {
  if (switchAtOneOf && random() % switchAtOneOf == 0) yield();
}

uint64_t clock64() { return std::chrono::steady_clock::now().time_since_epoch() / std::chrono::nanoseconds(1); }

void trap(std::string_view what) {
  tell(what);
  state().failed = true;
  toScheduler();
  std::abort();
}

uint32_t cachedWord(uint64_t address) {
  const auto [entry, added] = state().running->block->l1.try_emplace(address / 32);
  if (added) entry->second = load<std::array<uint32_t, 8>>(address / 32 * 32);
  return entry->second[address / 4 % 8];
}

void staleRead() { ++state().counting->staleReads; }

void storedWord(uint64_t address) {
  auto& l1 = state().running->block->l1;
  if (const auto entry = l1.find(address / 32); entry != l1.end())
    entry->second[address / 4 % 8] = load<uint32_t>(address);
}

void acquire() {
  if (staleCaches) state().running->block->l1.clear();
}

void forget(uint64_t address) { state().running->block->l1.erase(address / 32); }

}  // namespace emulator
