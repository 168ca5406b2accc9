// Catch2's main with one more option: which devices the tests run on.
#define CATCH_CONFIG_RUNNER
#include <catch2/catch.hpp>

#include "builder/parallel/error.h"
#include "tests/support/devices.h"

namespace copse::test {
static std::string chosen = "auto";

std::vector<Device> devices() {
  if (chosen == "cuda") return {openDevice("cuda")};
  std::vector<Device> all = listDevices();
  if (chosen == "cpu") all.resize(1);
  return all;
}
}  // namespace copse::test

int main(int argc, char** argv) {
  Catch::Session session;
  using namespace Catch::clara;
  session.cli(session.cli() | Opt(copse::test::chosen, "auto|cuda|cpu")["--device"](
                                  "devices to test on: auto is the CPU and CUDA where it is there"));
  if (const int status = session.applyCommandLine(argc, argv)) return status;
  // ctest calls each test by its name, and CMake cuts a name at a semicolon: that must not pass for a test.
  session.configData().warnings = Catch::WarnAbout::NoTests;
  // Catch's status is the number of failed checks, which nobody should take for anything else.
  return session.run() == 0 ? 0 : 1;
}
