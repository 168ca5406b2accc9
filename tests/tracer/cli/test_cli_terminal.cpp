// Output on a terminal: a bar while work goes on, none in a file, and an image after Ctrl-C.
#include <poll.h>
#include <pty.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <nlohmann/json.hpp>

#include "tests/support/catch.h"
#include "tests/support/files.h"
#include "tests/support/program.h"
#include "tests/support/small_scene.h"
#include "tracer/image/image_io.h"

using namespace copse;
using namespace copse::test;

namespace {

/// The program as the foreground process of a terminal of its own.
class OnTerminal {
 public:
  OnTerminal(const std::string& folder, const std::vector<std::string>& arguments) {
    std::vector<char*> list{const_cast<char*>("copse")};
    for (const std::string& argument : arguments) list.push_back(const_cast<char*>(argument.c_str()));
    list.push_back(nullptr);
    process_ = ::forkpty(&screen_, nullptr, nullptr, nullptr);
    if (process_ != 0) return;
    if (::chdir(folder.c_str()) == 0) ::execv(COPSE_PROGRAM, list.data());
    ::_exit(127);
  }
  ~OnTerminal() {
    if (process_ > 0 && !ended_) {
      ::kill(process_, SIGKILL);
      ::waitpid(process_, nullptr, 0);
    }
    if (screen_ >= 0) ::close(screen_);
  }
  OnTerminal(const OnTerminal&) = delete;
  OnTerminal& operator=(const OnTerminal&) = delete;

  void type(const std::string& keys) { REQUIRE(::write(screen_, keys.data(), keys.size()) > 0); }

  /// Reads until `part` is on the screen; false where the program ended, or a minute passed, without it.
  bool shows(const std::string& part) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::minutes(1);
    while (text_.find(part) == std::string::npos) {
      if (std::chrono::steady_clock::now() > end || !read()) return false;
    }
    return true;
  }
  /// The whole output on the screen, control sequences included, and the exit status.
  Ran wait() {
    while (read()) {
    }
    int status = 0;
    ::waitpid(process_, &status, 0);
    ended_ = true;
    return {WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status), text_, "", 0};
  }

 private:
  /// False at the end: Linux gives EIO once no process holds the terminal.
  bool read() {
    pollfd ready{screen_, POLLIN, 0};
    if (::poll(&ready, 1, 1000) == 0) return true;
    char buffer[4096];
    const ssize_t count = ::read(screen_, buffer, sizeof buffer);
    if (count > 0) text_.append(buffer, static_cast<std::size_t>(count));
    return count > 0;
  }

  int screen_ = -1;
  pid_t process_ = -1;
  std::string text_;
  bool ended_ = false;
};

std::vector<std::string> rendering(const std::string& spp) {
  return {"render", "small.toml", "-o", "x.exr", "--size", "64x64", "--spp", spp, "--device", "cpu", "--threads", "2"};
}

constexpr const char* eraseLine = "\r\033[K";

}  // namespace

TEST_CASE("on a terminal a bar shows progress and the time left, in a file there is none", "[medium]") {
  Folder folder;
  putSmallScene(folder);
  {
    OnTerminal terminal(folder / "", rendering("30000"));
    CHECK(terminal.shows(std::string(eraseLine) + "rendering front [---"));
    CHECK(terminal.shows(" %  "));
    CHECK(terminal.shows(" left"));
  }  // Ended before the other begins, which would take twice as long beside it.

  Running running(folder / "", rendering("30000"));
  for (int i = 0; i < 600 && running.processorSeconds() < 2.5 && !running.hasEnded(); ++i) ::usleep(100000);
  running.signal(SIGINT);
  const Ran ran = running.wait();
  CHECK(ran.status == 130);
  CHECK_THAT(ran.err, !Contains("\r") && !Contains("\033") && !Contains("[-"));
  CHECK_THAT(ran.out, !Contains("\r") && !Contains("\033") && !Contains("[-"));
}

TEST_CASE("on a terminal the bar is erased at the end, and --quiet shows none") {
  Folder folder;
  putSmallScene(folder);
  const Ran ran = OnTerminal(folder / "", rendering("4")).wait();
  CHECK(ran.status == 0);
  const std::size_t last = ran.out.rfind(eraseLine);
  REQUIRE(last != std::string::npos);
  CHECK_THAT(ran.out.substr(last), Contains("time to image") && !Contains("rendering"));
  std::vector<std::string> quiet = rendering("4");
  quiet.push_back("--quiet");
  CHECK(OnTerminal(folder / "", quiet).wait().out.empty());
}

TEST_CASE("Ctrl-C on a terminal leaves the image so far, says so, and gives 130", "[medium]") {
  Folder folder;
  putSmallScene(folder);
  OnTerminal terminal(folder / "", rendering("30000"));
  REQUIRE(terminal.shows(" left"));
  terminal.type("\x03");
  const Ran ran = terminal.wait();
  INFO(ran.out);
  CHECK(ran.status == 130);
  CHECK_THAT(ran.out, Contains("stopping; interrupt again to stop at once") && Contains("interrupted: x.exr holds "));
  std::map<std::string, std::string> attributes;
  const Image image = readExr(folder / "x.exr", &attributes);
  CHECK(image.width == 64);
  const double samples = nlohmann::json::parse(attributes.at("copse"))["image"]["samples_done"];
  CHECK(samples > 0);
  CHECK(samples < 30000);
}
