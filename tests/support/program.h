// The built program, run as its users run it: arguments in; exit status, output and files out.
#pragma once

#include <sys/resource.h>
#include <sys/types.h>

#include <string>
#include <vector>

namespace copse::test {

/// The exit status, or 128 + the signal that ended it, its output, and its peak memory.
struct Ran {
  int status = -1;
  std::string out, err;
  double peakBytes = 0;
};

/// One of setrlimit's, such as {RLIMIT_FSIZE, 20000}.
struct Limit {
  int resource;
  unsigned long long value;
};

/// A run in progress; ended by wait(), or killed when it goes out of scope.
class Running {
 public:
  /// Runs `copse ARGUMENTS…` in `folder`.
  Running(const std::string& folder, const std::vector<std::string>& arguments, const std::vector<Limit>& limits = {});
  ~Running();
  Running(const Running&) = delete;
  Running& operator=(const Running&) = delete;

  void signal(int number) const;
  bool hasEnded();
  /// The processor time of its threads so far.
  double processorSeconds() const;
  /// Its peak memory so far; 0 once it has ended.
  double peakBytes() const;
  Ran wait();

 private:
  pid_t process_ = -1;
  int outFile_ = -1, errFile_ = -1;
  int waited_ = 0;
  rusage used_{};
  bool ended_ = false;
};

Ran runCopse(const std::string& folder, const std::vector<std::string>& arguments,
             const std::vector<Limit>& limits = {});

}  // namespace copse::test
