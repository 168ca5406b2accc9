// Records of runs, as `report` and `bench --resume` read them. The first byte says which file of a folder the rest is.
#include "tests/fuzz/fuzz.h"
#include "tracer/bench/results.h"
#include "tracer/report/figures.h"
#include "tracer/report/page.h"
#include "tracer/report/table.h"

using namespace copse;
using namespace copse::fuzz;

namespace {

void readReport() {
  attempt([] {
    const report::Results results = report::aggregate(report::load(folder() / ""));
    report::tableCsv(results);
    report::pageOf(results, report::figuresOf(results), "");
  });
}

}  // namespace

extern "C" int LLVMFuzzerInitialize(int*, char***) {
  const std::string data = COPSE_SOURCE_DIR "/tests/data/report/";
  write("results.json", test::bytesOf(data + "results.json"));
  return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, std::size_t size) {
  if (size == 0) return -1;
  const std::string_view rest = text(data + 1, size - 1);
  static const std::string results = test::bytesOf(folder() / "results.json");
  if (data[0] == 'j') {
    const std::string file = write("results.jsonl", rest);
    attempt([&] {
      const Journal journal(file);
      resultsCsv(journal.entries());
      resultsTable(journal.entries());
    });
  } else if (data[0] == 'e') {
    write("experiment.json", rest);
    readReport();
    std::filesystem::remove(folder() / "experiment.json");
  } else {
    write("results.json", rest);
    readReport();
    write("results.json", results);
  }
  return 0;
}
