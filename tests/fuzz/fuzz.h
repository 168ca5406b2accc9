// What all fuzzers hold a reader to: whatever the bytes, it returns or throws InputError that says where, within five
// seconds of one core and a gigabyte. libFuzzer and the sanitizers see to memory; tests/fuzz/run has the limits.
#pragma once

#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <exception>
#include <string>
#include <string_view>

#include "builder/base/error.h"
#include "tests/support/files.h"

namespace copse::fuzz {

/// Under TMPDIR, which tests/fuzz/run puts in memory.
inline const test::Folder& folder() {
  static const test::Folder one;
  return one;
}

/// Writes a file into folder() and returns its path.
inline std::string write(const std::string& name, std::string_view bytes) {
  const std::string file = folder() / name;
  test::putBytes(file, bytes);
  return file;
}

inline std::string sceneData(const std::string& name) {
  return test::bytesOf(COPSE_SOURCE_DIR "/tests/data/scene/" + name);
}

inline std::string_view text(const uint8_t* data, std::size_t size) {
  return {reinterpret_cast<const char*>(data), size};
}

[[noreturn]] inline void finding(const std::string& what) {
  std::fprintf(stderr, "finding: %s\n", what.c_str());
  std::abort();
}

/// Processor time in seconds: what else runs on the machine does not count.
inline double processorTime() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// Calls `reader`; every other way out than those above is a finding.
template <class Reader>
void attempt(const Reader& reader) {
  const double begin = processorTime();
  try {
    reader();
  } catch (const InputError& error) {
    if (std::string_view(error.what()).find(':') == std::string_view::npos)
      finding(std::string("an error without a place: ") + error.what());
  } catch (const std::exception& error) {
    finding(std::string("an exception that is no InputError: ") + error.what());
  }
  if (const double took = processorTime() - begin; took > 5) finding(std::to_string(took) + " s of processor time");
}

}  // namespace copse::fuzz
