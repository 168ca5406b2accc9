// Catch2's main with one more option: which devices the tests run on. If given, the last line says how many test cases
// ran there, and lines before it name those that did not: a run for a GPU must not pass on the CPU only.
#define CATCH_CONFIG_RUNNER
#include "tests/support/catch.h"
#if COPSE_CATCH == 3
#include <catch2/catch_session.hpp>
#include <catch2/catch_test_case_info.hpp>
#include <catch2/reporters/catch_reporter_event_listener.hpp>
#include <catch2/reporters/catch_reporter_registrars.hpp>
#endif

#include "builder/base/error.h"
#include "tests/support/devices.h"

namespace copse::test {

static std::string chosen = "auto";
static bool asked = false;  ///< By the running test case.

std::vector<Device> devices() {
  asked = true;
  if (chosen == "cuda") return {openDevice("cuda")};
  std::vector<Device> all = listDevices();
  if (chosen == "cpu") all.resize(1);
  return all;
}

Device chosenDevice() {
  asked = true;
  return openDevice(chosen);
}

std::string deviceOption() {
  asked = true;
  return chosen;
}

namespace {

#if COPSE_CATCH == 3
namespace options = Catch::Clara;
constexpr auto noTestsIsWrong = Catch::WarnAbout::UnmatchedTestSpec;
using Listener = Catch::EventListenerBase;
const Catch::TestCaseInfo& infoOf(const Catch::TestCaseStats& ended) { return *ended.testInfo; }
#else
namespace options = Catch::clara;
constexpr auto noTestsIsWrong = Catch::WarnAbout::NoTests;
using Listener = Catch::TestEventListenerBase;
const Catch::TestCaseInfo& infoOf(const Catch::TestCaseStats& ended) { return ended.testInfo; }
#endif

struct Account : Listener {
  using Listener::Listener;

  static inline std::size_t cases = 0, onDevice = 0, assertions = 0, failed = 0;
  static inline std::vector<std::string> elsewhere;

  void testCaseStarting(const Catch::TestCaseInfo&) override { asked = false; }
  void testCaseEnded(const Catch::TestCaseStats& ended) override {
    ++cases;
    if (asked)
      ++onDevice;
    else
      elsewhere.push_back(infoOf(ended).name);
  }
  void testRunEnded(const Catch::TestRunStats& ended) override {
    assertions = ended.totals.assertions.total();
    failed = ended.totals.testCases.failed;
  }
  static void print() {
    for (const std::string& name : elsewhere) std::printf("not on %s: %s\n", chosen.c_str(), name.c_str());
    std::printf("on %s: %zu of %zu test cases, %zu assertions in all, %zu test cases failed\n", chosen.c_str(),
                onDevice, cases, assertions, failed);
  }
};
CATCH_REGISTER_LISTENER(Account)

}  // namespace
}  // namespace copse::test

int main(int argc, char** argv) {
  using namespace copse::test;
  Catch::Session session;
  session.cli(session.cli() | options::Opt(chosen, "auto|cuda|cpu")["--device"](
                                  "devices to test on: auto is the CPU and CUDA where it is there"));
  if (const int status = session.applyCommandLine(argc, argv)) return status;
  // ctest calls each test by its name, and CMake cuts names at semicolons: a name that matches nothing must fail.
  session.configData().warnings = noTestsIsWrong;
  const int failed = session.run();
  if (chosen != "auto") Account::print();
  // Catch2's status is the number of failed checks, which must not be taken for another status.
  return failed == 0 ? 0 : 1;
}
