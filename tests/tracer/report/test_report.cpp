// The report's page: it is self-contained and escapes text, works without gnuplot, and refuses broken results.
#include <unistd.h>

#include <cstdlib>
#include <filesystem>

#include "builder/base/error.h"
#include "tests/support/catch.h"
#include "tests/support/program.h"
#include "tests/support/report_files.h"
#include "tracer/report/aggregate.h"
#include "tracer/report/html.h"
#include "tracer/report/report.h"

using namespace copse;
using namespace copse::report;
using namespace copse::test;
namespace fs = std::filesystem;

namespace {

/// PATH for the time of a test.
class Path {
 public:
  explicit Path(const std::string& path) : before_(std::getenv("PATH")) { ::setenv("PATH", path.c_str(), 1); }
  ~Path() { ::setenv("PATH", before_.c_str(), 1); }

 private:
  std::string before_;
};

bool gnuplotIsThere() { return std::system("command -v gnuplot >/dev/null") == 0; }

std::string errorOf(const std::string& folder) {
  try {
    writeReport(folder);
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

}  // namespace

TEST_CASE("a page needs no network and no script, and text of the results stays text") {
  Folder folder;
  fill(folder);
  writeReport(folderOf(folder));
  const std::string page = bytesOf(folder / "report.html");
  CHECK(!has(page, "http"));
  CHECK(!has(page, "<script"));
  CHECK(!has(page, "@import"));
  CHECK(!has(page, "<link"));
  CHECK(countOf(page, "src=\"") == countOf(page, "src=\"data:"));
  CHECK(has(page, "A small &amp; &lt;true&gt; report"));
  CHECK(has(page, "k=4 &lt;&amp;&gt; &quot;it&#39;s&quot;"));
  CHECK(!has(page, "<&>"));
  CHECK(!has(page, "<12 GB>"));
}

TEST_CASE("runs that failed or were not done are listed, and no figure counts them") {
  Folder folder;
  fill(folder);
  writeReport(folderOf(folder));
  const std::string page = bytesOf(folder / "report.html");
  CHECK(has(page, "no memory for &lt;12 GB&gt; &amp; more"));
  CHECK(has(page, "1 run failed"));
  CHECK(has(page, "4 of 16 planned runs are missing"));
  CHECK(has(page, "<dt>scene soda-hall</dt><dd>soda.obj: not &lt;there&gt;</dd>"));
  CHECK(cellsOf(bytesOf(folder / "table1.csv")).count("hlbvh") == 0);
  CHECK(has(page, "<sup>*</sup>"));  // The row that has one view of two.
}

TEST_CASE("images that bench left are part of the page") {
  Folder folder;
  fill(folder);
  fs::create_directory(folder / "images");
  putBytes(folder / "images/sponza-nave.png", "abcd");
  writeReport(folderOf(folder));
  CHECK(has(bytesOf(folder / "report.html"), "src=\"data:image/png;base64,YWJjZA==\""));
}

TEST_CASE("broken results are an error with file and line, and no page is written") {
  Folder folder;
  CHECK(has(errorOf(folderOf(folder)), "not a results folder"));
  CHECK(has(errorOf(folder / "absent"), "no such folder"));
  putBytes(folder / "results.json", "[\n{\"schema\": 1},\n{\"schema\": }\n]\n");
  CHECK(has(errorOf(folderOf(folder)), "results.json:3: no JSON"));
  putBytes(folder / "results.json", "[\n{\"scene\": {\"name\": \"a, [b\"}},\n{\"time_ms\": {\"build\": \"x\"}}\n]\n");
  CHECK(has(errorOf(folderOf(folder)), "results.json:3: time_ms.build: expected a number"));
  putBytes(folder / "results.json", "[{\"time_ms\": {\"build\": 1e400}}]");
  CHECK(has(errorOf(folderOf(folder)), "results.json: "));
  putBytes(folder / "results.json", "[7]");
  CHECK(has(errorOf(folderOf(folder)), "results.json:1: expected an object"));
  putBytes(folder / "results.json", "[]");
  putBytes(folder / "experiment.json", "{\n\n");
  CHECK(has(errorOf(folderOf(folder)), "experiment.json:3: no JSON"));
  CHECK(!fs::exists(folder / "report.html"));
}

TEST_CASE("no results, and results that say almost nothing, still make a page") {
  Folder folder;
  putBytes(folder / "results.json", "[]");
  writeReport(folderOf(folder));
  CHECK(has(bytesOf(folder / "report.html"), "No results yet"));
  putBytes(folder / "results.json", "[{}, {\"bvh\": null, \"time_ms\": null, \"scene\": {\"name\": \"a\"}}]");
  writeReport(folderOf(folder));
  CHECK(has(bytesOf(folder / "report.html"), "</html>"));
}

TEST_CASE("the journal of a bench that was cut off is read up to its torn line") {
  Folder folder;
  const std::string array = bytesOf(reportData + "results.json");
  const std::string first = array.substr(2, array.find(",\n") - 2);
  putBytes(folder / "results.jsonl", first + "\n" + first + "\n" + first.substr(0, 40));
  CHECK(load(folderOf(folder)).runs.size() == 2);

  // Resumed after Ctrl-C and then killed: the array is of the first time.
  putBytes(folder / "results.json", "[" + first + "]");
  putBytes(folder / "experiment.json", R"({"planned": 5, "done": 1, "failed": 0})");
  CHECK(load(folderOf(folder)).runs.size() == 2);
  writeReport(folderOf(folder));
  CHECK(has(bytesOf(folder / "report.html"), "3 of 5 planned runs are missing"));
}

TEST_CASE("a run that failed belongs to its scene, whatever it says of its triangles") {
  Folder folder;
  const std::string run =
      R"({"run": {"label": "lbvh", "status": "STATUS"},
          "scene": {"name": "ball", "triangles": COUNT, "generated": true},
          "builder": {"name": "lbvh"}, "bvh": {"sah_cost": 3}, "time_ms": {"build": 2, "total": 2}})";
  const auto record = [&](const std::string& status, const std::string& count) {
    std::string text = run;
    text.replace(text.find("STATUS"), 6, status);
    return text.replace(text.find("COUNT"), 5, count);
  };
  for (const char* count : {"null", "0", "144000"}) {
    INFO(count);
    putBytes(folder / "results.json",
             "[" + record("failed", count) + "," + record("done", "144288") + "," + record("failed", count) + "]");
    const Results results = aggregate(load(folderOf(folder)));
    REQUIRE(results.scenes.size() == 1);
    CHECK(results.scenes[0].name == "ball");
    CHECK(results.scenes[0].triangles == 144288);
  }
}

TEST_CASE("a record of copse render --stats alone is a folder of results") {
  Folder folder;
  putBytes(folder / "results.json",
           R"({"schema": 1, "scene": {"name": "cornell", "triangles": 38}, "device": {"kind": "cpu"},
               "builder": {"name": "lbvh", "parameters": {}}, "bvh": {"sah_cost": 34.2},
               "image": {"width": 8, "height": 8, "spp": 2, "view": "front"},
               "time_ms": {"load": 1, "build": 2, "build_phases": {}, "render": 3, "render_phases": {}, "total": 5}})");
  writeReport(folderOf(folder));
  auto cells = cellsOf(bytesOf(folder / "table1.csv"));
  CHECK(cells["lbvh"]["total_2spp_ms"] == "5");
  CHECK(cells["lbvh"]["sah_cost"] == "34.2");
}

TEST_CASE("phases are drawn by the groups that they are declared with, and as other where this version has none such") {
  const auto record = [](const std::string& builder) {
    return R"({"builder": {"name": ")" + builder + R"("}, "scene": {"name": "s", "triangles": 10},
               "image": {"view": "v", "spp": 2, "width": 4, "height": 4, "integrator": "path"},
               "time_ms": {"build": 10, "render": 6, "total": 16,
                           "build_phases": {"boxes": 1, "clusters": 2, "assign and sum": 3, "sort by magic": 4},
                           "render_phases": {"generate": 1, "trace primary": 2, "denoise": 3}}})";
  };
  Folder folder;
  putBytes(folder / "results.json", "[" + record("lbvh") + "," + record("kmeans-q1") + "]");
  writeReport(folderOf(folder));
  const auto drawn = [&](const std::string& figure, const std::string& group) {
    return has(bytesOf(folder / ("figures/" + figure + ".gp")), "'" + group + "' at screen");
  };
  for (const std::string group : {"boxes", "hierarchy", "k-means", "other"}) CHECK(drawn("phases-builders", group));
  for (const std::string group : {"boxes", "hierarchy", "k-means loop", "other"}) CHECK(drawn("phases-kmeans", group));
  for (const std::string group : {"generate", "trace primary", "other"}) CHECK(drawn("phases-render", group));
  CHECK_FALSE(drawn("phases-builders", "sort by magic"));
}

TEST_CASE("where gnuplot is not there the page has its tables and says what is missing") {
  Folder folder, empty;
  fill(folder);
  const Path path(folderOf(empty));
  const ReportFiles files = writeReport(folderOf(folder));
  CHECK(files.figures == 0);
  CHECK(has(files.note, "gnuplot is not installed"));
  const std::string page = bytesOf(folder / "report.html");
  CHECK(has(page, "gnuplot is not installed"));
  CHECK(has(page, "class=\"results\""));
  CHECK(fs::exists(folder / "figures/relative-cost.gp"));
  CHECK(fs::exists(folder / "figures/relative-cost.csv"));
}

TEST_CASE("where gnuplot fails the page says so and leaves no drawing behind") {
  Folder folder, bin;
  fill(folder);
  putBytes(bin / "gnuplot", "#!/bin/sh\necho 'no terminal of that name' >&2\nexit 1\n");
  fs::permissions(bin / "gnuplot", fs::perms::owner_all);
  const Path path(folderOf(bin));
  const ReportFiles files = writeReport(folderOf(folder));
  CHECK(has(files.note, "no terminal of that name"));
  CHECK(!fs::exists(folder / "figures/relative-cost.svg"));
}

TEST_CASE("figures are drawings of their own and parts of the page, and names in them are no commands") {
  if (!gnuplotIsThere()) {
    WARN("gnuplot is not installed: its drawings were not checked");
    return;
  }
  Folder folder;
  std::string results = bytesOf(reportData + "results.json");
  const std::string wicked = "`touch owned`'; system('touch owned'); '@x _^{}%s\\\\\\\"";
  for (std::size_t at = 0; (at = results.find("\"kmeans-q2\"", at)) != std::string::npos; at += wicked.size())
    results.replace(at, 11, "\"" + wicked + "\"");
  fill(folder, results);
  const ReportFiles files = writeReport(folderOf(folder));
  CHECK(files.note == "");
  CHECK(files.figures > 5);
  const std::string drawing = bytesOf(folder / "figures/relative-cost.svg");
  CHECK(has(drawing, "<svg"));
  CHECK(has(drawing, "touch owned"));
  CHECK(has(bytesOf(folder / "report.html"), "role=\"img\""));
  CHECK(!fs::exists("owned"));
  CHECK(!fs::exists(folder / "owned"));
  CHECK(!fs::exists(folder / "figures/owned"));
}

TEST_CASE("copse report tells the page's name, and ends with 2 where the input is wrong") {
  Folder folder;
  fill(folder);
  const test::Ran done = test::runCopse(folderOf(folder), {"report", "."});
  CHECK(done.status == 0);
  CHECK(done.out == "./report.html\n");
  const test::Ran missing = test::runCopse(folderOf(folder), {"report", "nowhere"});
  CHECK(missing.status == 2);
  CHECK(has(missing.err, "error: nowhere: no such folder"));
  const test::Ran elsewhere = test::runCopse(folderOf(folder), {"report", ".", "-o", "there"});
  CHECK(elsewhere.status == 2);
  CHECK(has(elsewhere.err, "-o needs two folders to compare"));
}
