// copse report: a folder of results as a page, or two folders side by side.
#include "tracer/report/report.h"

#include <CLI/CLI.hpp>
#include <memory>

#include "tracer/cli/commands.h"
#include "tracer/cli/print.h"
#include "tracer/cli/progress.h"

namespace copse::cli {

namespace {

struct Options {
  std::string a, b, output = "out/report-compare";
};

int run(const Options& options) {
  endOnSignal();
  const ReportFiles files =
      options.b.empty() ? writeReport(options.a) : writeComparison(options.a, options.b, options.output);
  if (!files.note.empty()) say("note: {}\n", files.note);
  print("{}\n", files.page);
  return done;
}

}  // namespace

Command addReport(CLI::App& program) {
  CLI::App* command = program.add_subcommand("report", "Results of `copse bench` as one page, or two results compared");
  auto options = std::make_shared<Options>();
  command->add_option("DIR", options->a, "Folder with results.json; the page is written there")->required();
  command->add_option("DIR2", options->b, "A second folder, set beside the first: its values over the first's");
  command->add_option("-o", options->output, "Folder for the comparison of two")->capture_default_str();
  return [options] { return run(*options); };
}

}  // namespace copse::cli
