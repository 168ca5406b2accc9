// The files of a report, each written whole.
#include "tracer/report/report.h"

#include <filesystem>

#include "builder/base/whole_file.h"
#include "tracer/report/figures.h"
#include "tracer/report/gnuplot.h"
#include "tracer/report/page.h"
#include "tracer/report/table.h"

namespace copse {

ReportFiles writeReport(const std::string& folder) {
  using namespace report;
  const Results results = aggregate(load(folder));
  const std::filesystem::path path(folder);
  ReportFiles files;
  std::vector<Figure> figures = figuresOf(results);
  files.note = drawAll(figures, folder);
  for (const Figure& figure : figures)
    for (const Panel& panel : figure.panels) files.figures += !panel.svg.empty();
  writeWholeFile((path / "table1.csv").string(), tableCsv(results));
  files.page = (path / "report.html").string();
  writeWholeFile(files.page, pageOf(results, figures, files.note));
  return files;
}

}  // namespace copse
