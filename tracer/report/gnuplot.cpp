// Each script runs in a folder of its own and its drawing is then moved in place, so that none is left half-written.
#include "tracer/report/gnuplot.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <signal.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "builder/base/error.h"
#include "builder/base/whole_file.h"
#include "tracer/report/html.h"

extern char** environ;

namespace copse::report {

namespace fs = std::filesystem;

namespace {

constexpr double secondsAllowed = 20;

std::string findGnuplot() {
  const char* path = std::getenv("PATH");
  std::string folders = path ? path : "";
  for (std::size_t start = 0; start <= folders.size();) {
    const std::size_t end = std::min(folders.find(':', start), folders.size());
    const fs::path candidate = fs::path(folders.substr(start, end - start)) / "gnuplot";
    if (end > start && ::access(candidate.c_str(), X_OK) == 0 && fs::is_regular_file(candidate))
      return candidate.string();
    start = end + 1;
  }
  return "";
}

std::string contents(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::error_code error;
    const fs::path folder = fs::temp_directory_path(error);
    std::string name = ((error ? fs::path("/tmp") : folder) / "copse-figures-XXXXXX").string();
    if (!::mkdtemp(name.data())) throw InputError("cannot create a temporary folder for the figures");
    path_ = name;
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  const fs::path& path() const { return path_; }

 private:
  fs::path path_;
};

/// What went wrong, or "". What gnuplot says goes to `log`; nothing of ours is its input.
std::string runGnuplot(const std::string& program, const fs::path& folder, const std::string& script) {
  const std::string log = (folder / "log").string();
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_addchdir_np(&actions, folder.c_str());
  posix_spawn_file_actions_addopen(&actions, 0, "/dev/null", O_RDONLY, 0);
  posix_spawn_file_actions_addopen(&actions, 1, "/dev/null", O_WRONLY, 0);
  posix_spawn_file_actions_addopen(&actions, 2, log.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  // -d: no start-up files, so that the same figures come out for everybody.
  std::string name = "gnuplot", plain = "-d", file = script;
  char* const arguments[] = {name.data(), plain.data(), file.data(), nullptr};
  pid_t process = -1;
  const int failed = ::posix_spawn(&process, program.c_str(), &actions, nullptr, arguments, environ);
  posix_spawn_file_actions_destroy(&actions);
  if (failed) return fmt::format("cannot start {}", program);

  const auto start = std::chrono::steady_clock::now();
  int status = 0;
  while (::waitpid(process, &status, WNOHANG) == 0) {
    if (std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count() > secondsAllowed) {
      ::kill(process, SIGKILL);
      ::waitpid(process, &status, 0);
      return fmt::format("gnuplot took more than {:g} s over {} and was stopped", secondsAllowed, script);
    }
    ::usleep(2000);
  }
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return "";
  std::string said = contents(log);
  while (!said.empty() && said.back() == '\n') said.pop_back();
  const std::size_t last = said.rfind('\n');
  return fmt::format("gnuplot failed on {}: {}", script, last == std::string::npos ? said : said.substr(last + 1));
}

void replaceAll(std::string& text, const std::string& from, const std::string& to) {
  for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size())
    text.replace(at, from.size(), to);
}

void removeElement(std::string& text, const std::string& name) {
  const std::size_t start = text.find("<" + name + ">"), end = text.find("</" + name + ">");
  if (start != std::string::npos && end != std::string::npos) text.erase(start, end + name.size() + 3 - start);
}

}  // namespace

std::string inlined(const std::string& svg, const Panel& panel) {
  const std::size_t start = svg.find("<svg"), body = start == std::string::npos ? start : svg.find('>', start);
  const std::size_t box = svg.find("viewBox=\"");
  if (body == std::string::npos || box == std::string::npos || box > body) return "";
  const std::string size = svg.substr(box, svg.find('"', box + 9) + 1 - box);
  std::string rest = svg.substr(body + 1);
  removeElement(rest, "title");
  removeElement(rest, "desc");
  // Several drawings in one page: each refers to its own parts.
  const std::string own = panel.name + "-";
  for (const char* before : {"id='", "id=\"", "href='#", "href=\"#", "url(#"}) replaceAll(rest, before, before + own);
  return fmt::format("<svg {} role=\"img\" aria-label=\"{}\">{}", size, escape(panel.alt), rest);
}

std::string drawAll(std::vector<Figure>& figures, const std::string& folder) {
  if (figures.empty()) return "";
  const fs::path into = fs::path(folder) / "figures";
  std::error_code failed;
  fs::create_directories(into, failed);
  if (failed) throw InputError(fmt::format("{}: {}", into.string(), failed.message()));
  const std::string program = findGnuplot();
  TemporaryFolder work;
  std::string problem;
  for (Figure& figure : figures)
    for (Panel& panel : figure.panels) {
      const std::string script = panel.name + ".gp", drawing = panel.name + ".svg";
      writeWholeFile((into / script).string(), panel.script);
      writeWholeFile((into / (panel.name + ".csv")).string(), panel.csv);
      fs::remove(into / drawing, failed);  // It may be an earlier report's, of other data.
      if (program.empty()) continue;
      writeWholeFile((work.path() / script).string(), panel.script);
      if (const std::string said = runGnuplot(program, work.path(), script); !said.empty()) {
        problem = said;
        continue;
      }
      const std::string svg = contents(work.path() / drawing);
      panel.svg = inlined(svg, panel);
      if (panel.svg.empty())
        problem = "gnuplot drew nothing for " + script;
      else
        writeWholeFile((into / drawing).string(), svg);
    }
  if (program.empty())
    return "no figures, as gnuplot is not installed: install it (Debian: gnuplot-nox) and run copse report again; "
           "their data and scripts are under figures/.";
  return problem;
}

}  // namespace copse::report
