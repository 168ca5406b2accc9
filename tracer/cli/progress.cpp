// A bar on standard error, redrawn at most ten times a second, and the two signals that stop a render.
#include "tracer/cli/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdio>

#include "builder/base/whole_file.h"
#include "tracer/cli/commands.h"
#include "tracer/cli/print.h"

namespace copse::cli {

namespace {

std::atomic<bool> stop{false};
static_assert(std::atomic<bool>::is_always_lock_free, "the flag is raised in a signal handler");

bool onTerminal = false;

extern "C" void endNow(int) {
  removeTemporaryFiles();
  ::_exit(interrupted);
}

extern "C" void onSignal(int) {
  stop.store(true);
  constexpr char text[] = "\r\033[Kstopping; interrupt again to stop at once\n";
  if (onTerminal && ::write(2, text, sizeof text - 1) < 0) onTerminal = false;
  endOnSignal();
}

std::string minutes(double seconds) {
  const long whole = static_cast<long>(seconds + 0.5);
  return whole < 3600 ? fmt::format("{}:{:02}", whole / 60, whole % 60)
                      : fmt::format("{}:{:02}:{:02}", whole / 3600, whole / 60 % 60, whole % 60);
}

}  // namespace

Progress::Progress(std::string label, bool quiet) : label_(std::move(label)), shown_(!quiet && ::isatty(2)) {
  if (!shown_) return;
  say("\r\033[K{} ", label_);
  std::fflush(stderr);
}

Progress::~Progress() {
  if (!shown_) return;
  std::fputs("\r\033[K", stderr);
  std::fflush(stderr);
}

void Progress::report(double done) {
  const Clock::time_point now = Clock::now();
  const double elapsed = std::chrono::duration<double>(now - start_).count();
  // The bar appears after a second; until then the label is enough.
  if (!shown_ || elapsed < 1 || now - drawn_ < std::chrono::milliseconds(100)) return;
  drawn_ = now;
  done = std::clamp(done, 0.0, 1.0);
  constexpr int width = 32;
  const int full = static_cast<int>(done * width);
  const std::string left = done > 0.005 ? minutes(elapsed / done - elapsed) + " left" : "";
  say("\r\033[K{} [{:#<{}}{:-<{}}] {:3.0f} %  {}", label_, "", full, "", width - full, done * 100, left);
  std::fflush(stderr);
}

void endOnSignal() {
  std::signal(SIGINT, endNow);
  std::signal(SIGTERM, endNow);
}

const std::atomic<bool>& stopOnSignal() {
  onTerminal = ::isatty(2);
  std::signal(SIGINT, onSignal);
  std::signal(SIGTERM, onSignal);
  return stop;
}

}  // namespace copse::cli
