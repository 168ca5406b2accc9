// What a folder of results says, as a page: results.json in; report.html, figures and tables as CSV out.
// Reads JSON alone, so that results of another machine, of another version or of a script will do as well.
#pragma once

#include <string>

namespace copse {

struct ReportFiles {
  std::string page;  ///< The HTML that was written.
  int figures = 0;   ///< SVG files under figures/ beside it.
  std::string note;  ///< Why there are no figures, or nothing.
};

/// Reads `folder`/results.json (where it is not there: the journal results.jsonl) and, where it is there,
/// experiment.json. Writes report.html, table1.csv and figures/ there. Throws InputError "FILE:LINE: what".
ReportFiles writeReport(const std::string& folder);

/// Two folders side by side, B as a multiple of A; writes report.html, compare.csv and figures/ to `output`, which is
/// made.
ReportFiles writeComparison(const std::string& a, const std::string& b, const std::string& output);

}  // namespace copse
