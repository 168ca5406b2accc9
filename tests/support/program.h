// The built program, run as its users run it: arguments in; exit status, output and files out.
#pragma once

#include <sys/types.h>

#include <string>
#include <vector>

namespace copse::test {

/// The exit status, or 128 + the signal that ended it, and what it wrote.
struct Ran {
  int status = -1;
  std::string out, err;
};

/// A run that goes on; ended by wait(), or killed when it goes out of scope.
class Running {
 public:
  /// Runs `copse ARGUMENTS…` in `folder`. No file may grow over `fileLimit` bytes; 0 is no limit.
  Running(const std::string& folder, const std::vector<std::string>& arguments, long fileLimit = 0);
  ~Running();
  Running(const Running&) = delete;
  Running& operator=(const Running&) = delete;

  void signal(int number) const;
  bool hasEnded();
  /// What its threads have used of the processors so far.
  double processorSeconds() const;
  Ran wait();

 private:
  pid_t process_ = -1;
  int outFile_ = -1, errFile_ = -1;
  int waited_ = 0;
  bool ended_ = false;
};

Ran runCopse(const std::string& folder, const std::vector<std::string>& arguments, long fileLimit = 0);

}  // namespace copse::test
