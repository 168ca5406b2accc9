// Read from /proc, /etc/os-release and the compiler's own macros.
#include "tracer/session/machine.h"

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/utsname.h>
#include <unistd.h>

#include <fstream>

#include "builder/parallel/device_facts.h"

namespace copse {

namespace {

/// What follows `key` on the first line of `file` that starts with it, without `quote`s around it.
std::string lineOf(const char* file, const std::string& key) {
  std::ifstream stream(file);
  for (std::string line; std::getline(stream, line);) {
    if (line.rfind(key, 0) != 0) continue;
    std::string value = line.substr(key.size());
    value.erase(0, value.find_first_not_of(" \t:\""));
    value.erase(value.find_last_not_of(" \t\"") + 1);
    return value;
  }
  return "";
}

}  // namespace

Machine machineOf(const Device& device) {
  Machine machine;
  machine.cpu = lineOf("/proc/cpuinfo", "model name");
  machine.processors = processorCount();
  machine.memoryBytes =
      static_cast<uint64_t>(::sysconf(_SC_PHYS_PAGES)) * static_cast<uint64_t>(::sysconf(_SC_PAGESIZE));
  machine.system = lineOf("/etc/os-release", "PRETTY_NAME=");
  utsname names{};
  if (::uname(&names) == 0)
    machine.system += (machine.system.empty() ? "" : ", ") + std::string(names.sysname) + " " + names.release;
  machine.driver = driverOf(device);
  return machine;
}

Compiler compiler() {
#if defined(__clang__)
  return {"clang", __clang_version__, COPSE_FLAGS, cudaToolkit()};
#elif defined(__GNUC__)
  return {"gcc", __VERSION__, COPSE_FLAGS, cudaToolkit()};
#else
  return {"unknown", "", COPSE_FLAGS, cudaToolkit()};
#endif
}

uint64_t processPeakBytes() {
  const std::string text = lineOf("/proc/self/status", "VmHWM");
  if (!text.empty()) return 1024 * std::strtoull(text.c_str(), nullptr, 10);
  rusage used{};
  ::getrusage(RUSAGE_SELF, &used);
  return 1024 * static_cast<uint64_t>(used.ru_maxrss);
}

void startProcessPeak() {
  // "5" resets the peak to the memory in use; kernels and containers that refuse it leave the peak as it is.
  const int file = ::open("/proc/self/clear_refs", O_WRONLY | O_CLOEXEC);
  if (file < 0) return;
  [[maybe_unused]] const ssize_t written = ::write(file, "5", 1);
  ::close(file);
}

}  // namespace copse
