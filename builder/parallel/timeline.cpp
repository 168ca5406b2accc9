// Named phases: pairs of device events on CUDA, pairs of clock readings on the CPU. NVTX ranges on CUDA, so that the
// same names show in Nsight.
#include "builder/parallel/timeline.h"

#include <chrono>
#include <utility>

#if COPSE_CUDA
#include <nvtx3/nvToolsExt.h>

#include "builder/parallel/cuda_check.h"
#endif

namespace copse {

using Clock = std::chrono::steady_clock;

#if COPSE_CUDA
namespace {

/// A point in the work of a CUDA stream. `record` does not throw, since phases end in destructors: a stream that has
/// failed says so at the next synchronisation.
class Mark {
 public:
  Mark() { detail::checkCuda(cudaEventCreate(&event_), "cudaEventCreate"); }
  ~Mark() {
    if (event_) cudaEventDestroy(event_);
  }
  Mark(Mark&& other) noexcept : event_(std::exchange(other.event_, nullptr)) {}
  Mark& operator=(Mark&& other) noexcept {
    std::swap(event_, other.event_);
    return *this;
  }
  void swap(Mark& other) noexcept { std::swap(event_, other.event_); }

  void record(const Device& device) noexcept { cudaEventRecord(event_, detail::streamOf(device)); }
  double msUntil(const Mark& later) const {
    float ms = 0;
    detail::checkCuda(cudaEventSynchronize(later.event_), "cudaEventSynchronize");
    detail::checkCuda(cudaEventElapsedTime(&ms, event_, later.event_), "cudaEventElapsedTime");
    return ms;
  }

 private:
  cudaEvent_t event_ = nullptr;
};

struct PhaseMarks {
  std::size_t row = 0;
  Mark begin, end;
};

/// Phases whose times are not asked of the device yet; above it they are, so that a long run keeps few events.
constexpr std::size_t mostPending = 4096;
/// Pairs of events that a timeline starts with: making one takes the host longer than recording it, and a build has no
/// more phases. One of k-means has a phase a launch, some 120 of them.
constexpr std::size_t firstMarks = 192;

}  // namespace
#endif

struct Timeline::Events {
  Device device;
  int depth = 0;
  std::vector<PhaseTime> rows;
  std::size_t open = 0;  ///< The row of the open phase.
  bool any = false;
  Clock::time_point start, first, last;
#if COPSE_CUDA
  std::vector<PhaseMarks> pending, spare;
  std::vector<Mark> span;  ///< The first begin and the last end of those that are not pending any more; or none.

  void prepareOnDevice() {
    detail::bind(device);
    spare = std::vector<PhaseMarks>(firstMarks);
    pending.reserve(firstMarks);
  }
  void beginOnDevice() {
    detail::bind(device);
    if (pending.size() >= mostPending) resolve();
    if (spare.empty()) spare.emplace_back();
    pending.push_back(std::move(spare.back()));
    spare.pop_back();
    pending.back().row = open;
    pending.back().begin.record(device);
  }
  void endOnDevice() noexcept { pending.back().end.record(device); }
  std::size_t ended() const { return pending.size() - (depth > 0 && !pending.empty()); }
  /// Adds up the phases that have ended; one that is open waits for the next time.
  void resolve() {
    const std::size_t count = ended();
    if (count == 0) return;
    for (std::size_t i = 0; i < count; ++i) rows[pending[i].row].ms += pending[i].begin.msUntil(pending[i].end);
    if (span.empty()) {
      span = std::vector<Mark>(2);
      span[0].swap(pending[0].begin);
    }
    span[1].swap(pending[count - 1].end);
    for (std::size_t i = 0; i < count; ++i) spare.push_back(std::move(pending[i]));
    pending.erase(pending.begin(), pending.begin() + static_cast<std::ptrdiff_t>(count));
  }
#endif
};

Timeline::Timeline(const Device& device) : events_(std::make_unique<Events>()) {
  events_->device = device;
#if COPSE_CUDA
  if (device.isCuda()) events_->prepareOnDevice();
#endif
}
Timeline::~Timeline() = default;

void Timeline::begin(const char* name) {
  Events& e = *events_;
  if (e.depth > 0) {
    ++e.depth;
    return;
  }
  e.open = 0;
  while (e.open < e.rows.size() && e.rows[e.open].name != name) ++e.open;
  if (e.open == e.rows.size()) e.rows.push_back({name, 0, 0});
#if COPSE_CUDA
  if (e.device.isCuda()) e.beginOnDevice();
#endif
  e.start = Clock::now();
  if (!e.any) e.first = e.start;
  e.any = true;
  e.depth = 1;
}

void Timeline::end() {
  Events& e = *events_;
  if (--e.depth) return;
#if COPSE_CUDA
  if (e.device.isCuda()) return e.endOnDevice();
#endif
  e.last = Clock::now();
  e.rows[e.open].ms += std::chrono::duration<double, std::milli>(e.last - e.start).count();
}

void Timeline::countLaunch() {
  if (events_->depth) ++events_->rows[events_->open].launches;
}

std::vector<PhaseTime> Timeline::phases() {
#if COPSE_CUDA
  if (events_->device.isCuda()) {
    synchronise(events_->device);
    events_->resolve();
  }
#endif
  return events_->rows;
}

double Timeline::spanMs() {
  if (!events_->any) return 0;
#if COPSE_CUDA
  if (events_->device.isCuda()) {
    synchronise(events_->device);
    events_->resolve();
    return events_->span.empty() ? 0 : events_->span[0].msUntil(events_->span[1]);
  }
#endif
  return std::chrono::duration<double, std::milli>(events_->last - events_->first).count();
}

Phase::Phase(const Device& device, const char* name) : timeline_(device.timeline), onCuda_(device.isCuda()) {
  if (timeline_) timeline_->begin(name);
#if COPSE_CUDA
  if (onCuda_) nvtxRangePushA(name);
#endif
}
Phase::~Phase() {
#if COPSE_CUDA
  if (onCuda_) nvtxRangePop();
#endif
  if (timeline_) timeline_->end();
}

}  // namespace copse
