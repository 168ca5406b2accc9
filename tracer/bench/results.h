// The folder that an experiment leaves behind: results.jsonl while it goes on, results.json, results.csv and
// experiment.json for those who read it. Files but the journal are written whole or not at all.
#pragma once

#include <string>
#include <vector>

#include "tracer/bench/experiment.h"
#include "tracer/bench/journal.h"

namespace copse {

/// True if DIR holds an experiment, started or finished.
bool holdsExperiment(const std::string& folder);

/// The progress of an experiment, as in experiment.json.
struct Progressed {
  std::size_t planned = 0, done = 0, failed = 0;
  std::string started;   ///< "": the time of the call.
  std::string finished;  ///< "" while runs are left.
};

void writeExperimentJson(const std::string& folder, const Experiment& experiment, const Device& device,
                         const Progressed& progressed);

/// The progress in DIR/experiment.json. Throws InputError where this experiment, as it would run now, is not the one
/// that was started there, since one table would then mix two kinds of results: another configuration, program,
/// machine, device or number of threads, other scenes left out.
Progressed checkSameExperiment(const std::string& folder, const Experiment& experiment, const Device& device);

/// results.json, an array of the journal's records, and results.csv.
void writeResults(const std::string& folder, const std::vector<Journal::Entry>& entries);

/// A line of column names, then one line per record. Fields with a comma, a quote or a line break are in quotes.
std::string resultsCsv(const std::vector<Journal::Entry>& entries);

/// The summary at the end: one table per scene, one row per builder; costs, medians of build times, times to image as
/// the mean over views of the medians over repetitions, and the spread of those.
std::string resultsTable(const std::vector<Journal::Entry>& entries);

}  // namespace copse
