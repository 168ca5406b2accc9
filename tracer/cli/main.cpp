// The program: sub-commands, one file each, and the one place that maps errors to the exit status.
#include <fcntl.h>
#include <fmt/format.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <new>
#include <utility>
#include <vector>

#include "builder/base/error.h"
#include "builder/base/version.h"
#include "tracer/cli/commands.h"

namespace copse::cli {
namespace {

int fail(int status, const std::string& what) {
  std::fflush(stdout);
  for (const char* part : {"error: ", what.c_str(), "\n"}) std::fputs(part, stderr);
  return status;
}

/// The next file opened would take the number of a closed standard stream, and messages would end up in an image.
void fillStandardStreams() {
  for (int stream = 0; stream < 3; ++stream)
    if (::fcntl(stream, F_GETFD) < 0 && ::open("/dev/null", O_RDONLY) != stream) std::_Exit(badInput);
}

/// Results that cannot be written are a failure: `copse info scene > /full/disk`.
int finish(int status) {
  if (std::fflush(stdout) != 0 || std::ferror(stdout))
    return fail(status == done ? badInput : status, "cannot write to standard output");
  return status;
}

int run(int argc, char** argv) {
  Program program("Copse renders a scene with a BVH builder of your choice and reports times and costs.", "copse");
  program.setVersion(fmt::format("copse {} ({})", version(), commit()));
  program.requireCommand();
  const std::pair<const char*, Command> commands[] = {
      {"render", addRender(program)}, {"build", addBuild(program)},       {"bench", addBench(program)},
      {"report", addReport(program)}, {"compare", addCompare(program)},   {"info", addInfo(program)},
      {"list", addList(program)},     {"generate", addGenerate(program)},
  };

  if (argc < 2) return fail(badInput, "no command\n" + program.help());
  std::string names;
  bool known = argv[1][0] == '-';
  for (const auto& [name, command] : commands) {
    known = known || argv[1] == std::string(name);
    names += fmt::format("{}{}", names.empty() ? "" : ", ", name);
  }
  if (!known) return fail(badInput, fmt::format("unknown command '{}' (available: {})", argv[1], names));
  if (const auto status = program.parse(argc, argv)) return *status;
  for (const auto& [name, command] : commands)
    if (program.asksFor(name)) return command();
  return badInput;
}

}  // namespace
}  // namespace copse::cli

int main(int argc, char** argv) {
  using namespace copse::cli;
  fillStandardStreams();
  std::signal(SIGPIPE, SIG_IGN);  // A closed pipe of messages must not cost the image.
  std::signal(SIGXFSZ,
              SIG_IGN);  // A file over the size limit is then an error of write(), which is reported after cleaning up.
  try {
    return finish(run(argc, argv));
  } catch (const copse::InputError& error) {
    return fail(badInput, error.what());
  } catch (const copse::DeviceError& error) {
    return fail(deviceFailed, error.what());
  } catch (const copse::ValidationError& error) {
    return fail(failedCheck, error.what());
  } catch (const std::bad_alloc&) {
    return fail(deviceFailed, "out of memory");
  } catch (const std::exception& error) {
    return fail(deviceFailed, fmt::format("unexpected error: {}", error.what()));
  }
}
