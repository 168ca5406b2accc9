// Table 1 in the paper's layout: methods per scene, best in bold, and beside each value what the paper has.
#pragma once

#include <string>

#include "tracer/report/aggregate.h"

namespace copse::report {

/// A column of Table 1 for every scene and row.
struct Metric {
  enum Kind { cost, rate, build, total } kind;
  int spp = 0;  ///< For `total`.

  Value of(const Row& row) const;
  double ofPaper(const struct PaperRow& row) const;
  std::string title() const;   ///< "time to image, 8 spp"
  std::string unit() const;    ///< "ms"
  std::string column() const;  ///< As a CSV header: "total_8spp_ms".
  bool higherIsBetter() const { return kind == rate; }
};

/// Cost, rate, build, and a total for each number of samples; only those with a value.
std::vector<Metric> metrics(const Results& results);

/// The best of the rows that were really built, as the table prints it; "" where there is none.
std::string bestOf(const Scene& scene, const Metric& metric);

std::string tableHtml(const Results& results);
std::string tableCsv(const Results& results);

/// Which method is best in how many scenes, for each column: the counts that the paper's text gives.
std::string winnersHtml(const Results& results);

}  // namespace copse::report
