// The sub-commands: each adds its options to the program and returns a function that runs it and returns the exit
// status.
#pragma once

#include <functional>

#include "tracer/cli/command_line.h"

namespace copse::cli {

/// Exit statuses, as scripts know them.
enum Status { done = 0, failedCheck = 1, badInput = 2, deviceFailed = 3, interrupted = 130 };

using Command = std::function<int()>;

Command addRender(CommandLine& program);
Command addBuild(CommandLine& program);
Command addBench(CommandLine& program);
Command addCompare(CommandLine& program);
Command addInfo(CommandLine& program);
Command addList(CommandLine& program);
Command addGenerate(CommandLine& program);
Command addReport(CommandLine& program);

}  // namespace copse::cli
