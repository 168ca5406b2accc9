// Where threads meet: shuffles, votes and barriers of a warp, and barriers of a block. The last to arrive completes the
// meeting and goes on without a switch.
#include "fibers.h"

namespace emulator {

namespace {

/// For each lane of a meeting that exists.
template <class Visit>
void forMembers(const Fiber& self, const Visit& visit) {
  for (uint32_t which = 0; which < self.lanesOfWarp; ++which)
    if (self.members >> which & 1) visit(which, *self.warp[which]);
}

/// True where `self` is the last of its meeting. Lanes mostly come in order, so the last is asked first.
bool allHaveCome(const Fiber& self) {
  for (uint32_t which = self.lanesOfWarp; which-- > 0;) {
    if (!(self.members >> which & 1)) continue;
    const Fiber& other = *self.warp[which];
    if (other.wait == Wait::left) trap("a lane of the mask has left");
    if (other.wait != self.wait || other.members != self.members || other.mode != self.mode) return false;
  }
  return true;
}

void shuffleAll(Fiber& self) {
  forMembers(self, [&](uint32_t which, Fiber& to) {
    const int segment = to.clamp >> 8 & 0x1f, clamp = to.clamp & 0x1f, by = to.source & 0x1f;
    const int here = static_cast<int>(which), last = (here & segment) | (clamp & ~segment);
    int from = 0;
    switch (to.mode) {
      case Shuffle::up:
        from = here - by;
        break;
      case Shuffle::down:
        from = here + by;
        break;
      case Shuffle::bfly:
        from = here ^ by;
        break;
      case Shuffle::idx:
        from = (here & segment) | (by & ~segment);
        break;
    }
    to.within = to.mode == Shuffle::up ? from >= last : from <= last;
    if (!to.within) from = here;
    const Fiber* source = lane(self, from);
    if (!(self.members >> from & 1) || !source) trap("a shuffle from a lane outside the mask");
    to.result = source->value;
  });
}

/// Waits for all of the mask; the last to arrive completes the meeting and goes on.
void meet(Wait what, uint32_t members, Point& point) {
  Fiber& self = *state().running;
  self.wait = what;
  self.members = members;
  self.point = &point;
  if (what != Wait::shuffle) self.mode = Shuffle::idx;
  if (!(members >> self.thread.laneid & 1)) trap("a lane is not in its own mask");
  if (!allHaveCome(self)) return toScheduler();
  if (what == Wait::shuffle) shuffleAll(self);
  uint32_t votes = 0, count = 0;
  bool onePoint = true;
  forMembers(self, [&](uint32_t which, const Fiber& other) {
    votes |= static_cast<uint32_t>(other.vote) << which;
    onePoint &= other.point == &point;
    ++count;
  });
  forMembers(self, [&](uint32_t, Fiber& other) {
    if (what == Wait::vote) other.result = votes;
    other.wait = Wait::nothing;
  });
  ++point.meetings;
  point.threads += count;
  state().counting->meetingsAtTwoPoints += !onePoint;
}

}  // namespace

void openBarrier(Block& block) {
  if (block.alive == 0 || block.atBarrier < block.alive) return;
  bool any = false;
  for (const Fiber* thread : block.threads) any |= thread->wait == Wait::blockBarrier && thread->vote;
  for (Fiber* thread : block.threads)
    if (thread->wait == Wait::blockBarrier) {
      thread->wait = Wait::nothing;
      thread->vote = any;
    }
  block.atBarrier = 0;
}

uint32_t shuffle(Shuffle mode, uint32_t value, uint32_t source, uint32_t clamp, uint32_t members, bool& within,
                 Point& point) {
  Fiber& self = *state().running;
  self.mode = mode;
  self.value = value;
  self.source = source;
  self.clamp = clamp;
  meet(Wait::shuffle, members, point);
  within = self.within;
  return self.result;
}

uint32_t ballot(bool vote, uint32_t members, Point& point) {
  Fiber& self = *state().running;
  self.vote = vote;
  meet(Wait::vote, members, point);
  return self.result;
}

void warpBarrier(uint32_t members, Point& point) { meet(Wait::warpBarrier, members, point); }

bool blockBarrier(bool vote, Point& point) {
  Fiber& self = *state().running;
  Block& block = *self.block;
  self.vote = vote;
  self.point = &point;
  self.wait = Wait::blockBarrier;
  ++block.atBarrier;
  if (block.atBarrier == block.alive) {
    ++point.meetings;
    point.threads += block.alive;
    openBarrier(block);
  } else {
    toScheduler();
  }
  return self.vote;
}

}  // namespace emulator
