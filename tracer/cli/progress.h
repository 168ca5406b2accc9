// What a terminal shows while work goes on, and Ctrl-C. Nothing is shown where standard error is not a terminal.
#pragma once

#include <atomic>
#include <chrono>
#include <functional>
#include <string>

namespace copse::cli {

/// One line on the terminal: a label, and a bar with the time left once progress is reported. Erased at the end.
class Progress {
 public:
  Progress(std::string label, bool quiet);
  ~Progress();
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;

  /// `done` from 0 to 1.
  void report(double done);

 private:
  using Clock = std::chrono::steady_clock;
  std::string label_;
  bool shown_;
  Clock::time_point start_ = Clock::now(), drawn_{};
};

/// From the call on, the first SIGINT or SIGTERM raises the flag, so that what is done so far can be written; the
/// second ends the program as endOnSignal does.
const std::atomic<bool>& stopOnSignal();

/// From the call on, SIGINT or SIGTERM ends the program at once with 130 and leaves no temporary file.
void endOnSignal();

}  // namespace copse::cli
