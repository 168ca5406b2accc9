// fork, exec, and unnamed temporary files for the program's output.
#include "tests/support/program.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>
#include <iterator>
#include <sstream>
#include <stdexcept>

namespace copse::test {

namespace {

int unnamedFile() {
  char name[] = "/tmp/copse-test-output-XXXXXX";
  const int file = ::mkstemp(name);
  if (file < 0) throw std::runtime_error("no temporary file");
  ::unlink(name);
  return file;
}

std::string contents(int file) {
  std::string text;
  char buffer[4096];
  ::lseek(file, 0, SEEK_SET);
  for (ssize_t n; (n = ::read(file, buffer, sizeof buffer)) > 0;) text.append(buffer, static_cast<std::size_t>(n));
  return text;
}

}  // namespace

Running::Running(const std::string& folder, const std::vector<std::string>& arguments, const std::vector<Limit>& limits)
    : outFile_(unnamedFile()), errFile_(unnamedFile()) {
  std::vector<char*> list{const_cast<char*>("copse")};
  for (const std::string& argument : arguments) list.push_back(const_cast<char*>(argument.c_str()));
  list.push_back(nullptr);
  process_ = ::fork();
  if (process_ != 0) return;
  const int nothing = ::open("/dev/null", O_RDONLY);
  ::dup2(nothing, 0);
  ::dup2(outFile_, 1);
  ::dup2(errFile_, 2);
  for (const Limit& limit : limits) {
    const rlimit both{static_cast<rlim_t>(limit.value), static_cast<rlim_t>(limit.value)};
    ::setrlimit(static_cast<__rlimit_resource_t>(limit.resource), &both);
  }
  if (::chdir(folder.c_str()) == 0) ::execv(COPSE_PROGRAM, list.data());
  ::_exit(127);
}

Running::~Running() {
  if (!ended_) {
    ::kill(process_, SIGKILL);
    ::waitpid(process_, &waited_, 0);
  }
  ::close(outFile_);
  ::close(errFile_);
}

void Running::signal(int number) const { ::kill(process_, number); }

bool Running::hasEnded() {
  if (!ended_) ended_ = ::wait4(process_, &waited_, WNOHANG, &used_) == process_;
  return ended_;
}

double Running::processorSeconds() const {
  std::ifstream file("/proc/" + std::to_string(process_) + "/stat");
  std::string text((std::istreambuf_iterator<char>(file)), {});
  text.erase(0, text.rfind(')') + 1);  // The name before it may contain anything.
  std::istringstream fields(text);
  std::string skipped;
  for (int i = 0; i < 11; ++i) fields >> skipped;
  double user = 0, system = 0;
  fields >> user >> system;
  return (user + system) / static_cast<double>(::sysconf(_SC_CLK_TCK));
}

double Running::peakBytes() const {
  std::ifstream file("/proc/" + std::to_string(process_) + "/status");
  double kib = 0;
  for (std::string word; file >> word;)
    if (word == "VmHWM:") file >> kib;
  return 1024 * kib;
}

Ran Running::wait() {
  if (!ended_) ::wait4(process_, &waited_, 0, &used_);
  ended_ = true;
  const int status = WIFEXITED(waited_) ? WEXITSTATUS(waited_) : 128 + WTERMSIG(waited_);
  return {status, contents(outFile_), contents(errFile_), 1024.0 * static_cast<double>(used_.ru_maxrss)};
}

Ran runCopse(const std::string& folder, const std::vector<std::string>& arguments, const std::vector<Limit>& limits) {
  return Running(folder, arguments, limits).wait();
}

}  // namespace copse::test
