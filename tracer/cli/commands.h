// The sub-commands: each adds its options to the program and gives back what runs it and returns the exit status.
#pragma once

#include <functional>

namespace CLI {
class App;
}

namespace copse::cli {

/// Exit statuses, as scripts know them.
enum Status { done = 0, failedCheck = 1, badInput = 2, deviceFailed = 3, interrupted = 130 };

using Command = std::function<int()>;

Command addRender(CLI::App& program);
Command addBuild(CLI::App& program);
Command addBench(CLI::App& program);
Command addCompare(CLI::App& program);
Command addInfo(CLI::App& program);
Command addList(CLI::App& program);
Command addGenerate(CLI::App& program);
Command addReport(CLI::App& program);

}  // namespace copse::cli
