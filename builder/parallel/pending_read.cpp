// On CUDA a copy to page-locked memory and an event behind it. Both are dear to make and are kept for the next read.
#include "builder/parallel/pending_read.h"

#include <cstring>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

#include "builder/parallel/memory_traffic.h"

#if COPSE_CUDA
#include "builder/parallel/cuda_check.h"
#endif

namespace copse {

struct PendingRead::Slot {
  alignas(16) unsigned char bytes[maxBytes] = {};
  unsigned char* memory = bytes;
#if COPSE_CUDA
  int ordinal = -1;  ///< The device whose event it is; none for the CPU.
  cudaEvent_t event = nullptr;
#endif
};

namespace {

using Slot = PendingRead::Slot;

/// Slots that nobody uses. They are never freed: at the program's end CUDA may be gone before them.
struct Idle {
  std::mutex mutex;
  std::vector<Slot*> slots;

  static Idle& get() {
    static auto* const idle = new Idle;
    return *idle;
  }
};

bool isFor(const Slot& slot, const Device& device) {
#if COPSE_CUDA
  return slot.ordinal == (device.isCuda() ? device.ordinal : -1);
#else
  return (void)slot, !device.isCuda();
#endif
}

Slot* makeSlot([[maybe_unused]] const Device& device) {
  auto slot = std::make_unique<Slot>();
#if COPSE_CUDA
  if (device.isCuda()) {
    detail::bind(device);
    void* memory = nullptr;
    detail::checkCuda(cudaHostAlloc(&memory, PendingRead::maxBytes, cudaHostAllocPortable), "cudaHostAlloc");
    slot->memory = static_cast<unsigned char*>(memory);
    slot->ordinal = device.ordinal;
    detail::checkCuda(cudaEventCreateWithFlags(&slot->event, cudaEventDisableTiming), "cudaEventCreateWithFlags");
  }
#endif
  return slot.release();
}

Slot* takeSlot(const Device& device) {
  {
    Idle& idle = Idle::get();
    const std::lock_guard lock(idle.mutex);
    for (Slot*& slot : idle.slots)
      if (isFor(*slot, device)) {
        std::swap(slot, idle.slots.back());
        Slot* const taken = idle.slots.back();
        idle.slots.pop_back();
        return taken;
      }
  }
  return makeSlot(device);
}

}  // namespace

PendingRead::PendingRead(const Device& device) : device_(device), slot_(takeSlot(device)) {}

PendingRead::~PendingRead() {
#if COPSE_CUDA
  if (isPending_ && device_.isCuda()) cudaEventSynchronize(slot_->event);
#endif
  Idle& idle = Idle::get();
  const std::lock_guard lock(idle.mutex);
  idle.slots.push_back(slot_);
}

void PendingRead::startBytes(const void* from, std::size_t bytes) {
  isPending_ = true;
  detail::countTransfer();
#if COPSE_CUDA
  if (device_.isCuda()) {
    detail::bind(device_);
    detail::checkCuda(cudaMemcpyAsync(slot_->memory, from, bytes, cudaMemcpyDeviceToHost, detail::streamOf(device_)),
                      "cudaMemcpyAsync");
    detail::checkCuda(cudaEventRecord(slot_->event, detail::streamOf(device_)), "cudaEventRecord");
    return;
  }
#endif
  std::memcpy(slot_->memory, from, bytes);
}

const void* PendingRead::waitForBytes() {
  detail::countWait();
#if COPSE_CUDA
  if (device_.isCuda()) detail::checkCuda(cudaEventSynchronize(slot_->event), "cudaEventSynchronize");
#endif
  isPending_ = false;
  return slot_->memory;
}

}  // namespace copse
