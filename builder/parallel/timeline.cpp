// Named phases: pairs of device events on CUDA, pairs of clock readings on the CPU.
#include "builder/parallel/timeline.h"

#include <chrono>

namespace copse {

using Clock = std::chrono::steady_clock;

struct Timeline::Events {
  Device device;
  int depth = 0;
  std::vector<PhaseTime> rows;
  std::size_t open = 0;
  Clock::time_point start, first, last;
  bool any = false;
};

Timeline::Timeline(const Device& device) : events_(std::make_unique<Events>()) { events_->device = device; }
Timeline::~Timeline() = default;

void Timeline::begin(const char* name) {
  Events& e = *events_;
  if (e.depth++) return;
  e.open = 0;
  while (e.open < e.rows.size() && e.rows[e.open].name != name) ++e.open;
  if (e.open == e.rows.size()) e.rows.push_back({name, 0, 0});
  e.start = Clock::now();
  if (!e.any) e.first = e.start;
  e.any = true;
}

void Timeline::end() {
  Events& e = *events_;
  if (--e.depth) return;
  e.last = Clock::now();
  e.rows[e.open].ms += std::chrono::duration<double, std::milli>(e.last - e.start).count();
}

void Timeline::countLaunch() {
  if (events_->depth) ++events_->rows[events_->open].launches;
}

std::vector<PhaseTime> Timeline::phases() { return events_->rows; }

double Timeline::spanMs() {
  return events_->any ? std::chrono::duration<double, std::milli>(events_->last - events_->first).count() : 0;
}

Phase::Phase(const Device& device, const char* name) : timeline_(device.timeline) {
  if (timeline_) timeline_->begin(name);
}
Phase::~Phase() {
  if (timeline_) timeline_->end();
}

}  // namespace copse
