// copse report: a folder of results as a page, or two folders side by side.
#include "tracer/report/report.h"

#include <memory>

#include "builder/base/error.h"
#include "tracer/cli/commands.h"
#include "tracer/cli/options.h"
#include "tracer/cli/print.h"
#include "tracer/cli/progress.h"

namespace copse::cli {

namespace {

struct Options {
  std::string a, b, output;
};

int run(const Options& options) {
  endOnSignal();
  const bool two = !options.b.empty();
  if (!two && !options.output.empty())
    throw InputError("-o needs two folders to compare; the page of one is written beside its results");
  const std::string output = options.output.empty() ? "out/report-compare" : options.output;
  const ReportFiles files = two ? writeComparison(options.a, options.b, output) : writeReport(options.a);
  if (!files.note.empty()) say("note: {}\n", files.note);
  print("{}\n", files.page);
  return done;
}

}  // namespace

Command addReport(CommandLine& program) {
  CommandLine command = program.addCommand("report", "Make one page of the results of `copse bench`, or compare two");
  auto options = std::make_shared<Options>();
  command.option("DIR", options->a, "Folder with results.json; the page is written there").required();
  command.option("DIR2", options->b, "A second folder to compare: its values over the first's");
  command.option("-o", options->output, "Folder for the comparison of two; out/report-compare by default").notEmpty();
  return [options] { return run(*options); };
}

}  // namespace copse::cli
