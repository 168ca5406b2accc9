// Named phases: device events on CUDA, clock readings on the CPU. NVTX ranges on CUDA, so that the same names show in
// Nsight. An event costs the stream about a microsecond, and a build has up to a hundred phases one behind the other:
// where nothing lies between two, the end of one is the begin of the next.
#include "builder/parallel/timeline.h"

#include <chrono>
#include <utility>

#if COPSE_CUDA
#include <nvtx3/nvToolsExt.h>

#include "builder/parallel/cuda_check.h"
#include "builder/parallel/memory_traffic.h"
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
  ~Mark() { cudaEventDestroy(event_); }
  Mark(const Mark&) = delete;
  Mark& operator=(const Mark&) = delete;

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
using SharedMark = std::shared_ptr<Mark>;

struct PhaseMarks {
  std::size_t row = 0;
  SharedMark begin, end;
};

/// Phases whose times are not asked of the device yet; above it they are, so that a long run keeps few events.
constexpr std::size_t maxPending = 4096;
/// Events that a timeline starts with: making one takes the host longer than recording it, and a build has no more.
constexpr std::size_t firstMarks = 192;
/// The host's time between two phases that counts as the second's. More of it is a gap, which is neither's.
constexpr auto seam = std::chrono::microseconds(5);

}  // namespace
#endif

struct Timeline::Events {
  Device device;
  int depth = 0;
  std::vector<PhaseTime> rows;
  std::size_t open = 0;  ///< The row of the open phase.
  bool any = false;
  Clock::time_point start, first, last;
  int recorded = 0;  ///< Events.
#if COPSE_CUDA
  std::vector<PhaseMarks> pending;
  std::vector<SharedMark> spare;
  SharedMark lastEnd;             ///< The end of the phase before, if any.
  MemoryTraffic lastTraffic{};    ///< When that ended.
  SharedMark spanBegin, spanEnd;  ///< For the phases no longer pending; or none.

  void prepareOnDevice() {
    detail::bind(device);
    while (spare.size() < firstMarks) spare.push_back(std::make_shared<Mark>());
    pending.reserve(firstMarks);
  }
  SharedMark take() {
    if (spare.empty()) return std::make_shared<Mark>();
    SharedMark mark = std::move(spare.back());
    spare.pop_back();
    return mark;
  }
  /// For the next who takes one, unless another phase still has it.
  void give(SharedMark mark) {
    if (mark && mark.use_count() == 1) spare.push_back(std::move(mark));
  }
  void record(Mark& mark) noexcept {
    mark.record(device);
    ++recorded;
  }

  /// Nothing was put on the stream since the phase before, and the host did not tarry.
  bool followsAtOnce() const {
    const MemoryTraffic now = memoryTraffic();
    return lastEnd && now.waits == lastTraffic.waits && now.transfers == lastTraffic.transfers && start - last <= seam;
  }
  void beginOnDevice() {
    detail::bind(device);
    if (pending.size() >= maxPending) resolve();
    const bool joins = followsAtOnce();
    pending.push_back({open, joins ? lastEnd : take(), take()});
    if (!joins) record(*pending.back().begin);
  }
  void endOnDevice() noexcept {
    record(*pending.back().end);
    lastEnd = pending.back().end;
    lastTraffic = memoryTraffic();
  }
  std::size_t ended() const { return pending.size() - (depth > 0 && !pending.empty()); }
  /// Adds up the phases that have ended; one that is open waits for the next time.
  void resolve() {
    const std::size_t count = ended();
    if (count == 0) return;
    for (std::size_t i = 0; i < count; ++i) rows[pending[i].row].ms += pending[i].begin->msUntil(*pending[i].end);
    if (!spanBegin) spanBegin = pending[0].begin;
    give(std::exchange(spanEnd, pending[count - 1].end));
    for (std::size_t i = 0; i < count; ++i) {
      give(std::move(pending[i].begin));
      give(std::move(pending[i].end));
    }
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

void Timeline::begin(PhaseName name) {
  Events& e = *events_;
  if (e.depth > 0) {
    ++e.depth;
    return;
  }
  e.open = 0;
  while (e.open < e.rows.size() && e.rows[e.open].name != name.text) ++e.open;
  if (e.open == e.rows.size()) e.rows.push_back({name.text, 0, 0, name.group});
  e.start = Clock::now();
#if COPSE_CUDA
  if (e.device.isCuda()) e.beginOnDevice();
#endif
  if (!e.any) e.first = e.start;
  e.any = true;
  e.depth = 1;
}

void Timeline::end() {
  Events& e = *events_;
  if (--e.depth) return;
  e.last = Clock::now();
#if COPSE_CUDA
  if (e.device.isCuda()) return e.endOnDevice();
#endif
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
    return events_->spanBegin ? events_->spanBegin->msUntil(*events_->spanEnd) : 0;
  }
#endif
  return std::chrono::duration<double, std::milli>(events_->last - events_->first).count();
}

int Timeline::eventsRecorded() const { return events_->recorded; }

Phase::Phase(const Device& device, PhaseName name) : timeline_(device.timeline), onCuda_(device.isCuda()) {
  if (timeline_) timeline_->begin(name);
#if COPSE_CUDA
  if (onCuda_) nvtxRangePushA(name.text);
#endif
}
Phase::~Phase() {
#if COPSE_CUDA
  if (onCuda_) nvtxRangePop();
#endif
  if (timeline_) timeline_->end();
}

}  // namespace copse
