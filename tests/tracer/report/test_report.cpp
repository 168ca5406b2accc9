// What a page must say, by numbers worked out by hand from tests/data/report: medians over three repetitions, means
// over two views, the ideal sah, ratios to the paper; and what it must not contain.
#include <fmt/format.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <map>
#include <set>
#include <sstream>
#include <tuple>
#include <utility>

#include "builder/base/error.h"
#include "builder/registry.h"
#include "tests/support/catch.h"
#include "tests/support/files.h"
#include "tests/support/program.h"
#include "tracer/accel/tracers.h"
#include "tracer/report/aggregate.h"
#include "tracer/report/builders.h"
#include "tracer/report/html.h"
#include "tracer/report/paper.h"
#include "tracer/report/report.h"
#include "tracer/report/table.h"

using namespace copse;
using namespace copse::report;
using copse::test::bytesOf;
using copse::test::Folder;
using copse::test::putBytes;
namespace fs = std::filesystem;

namespace {

const std::string data = std::string(COPSE_SOURCE_DIR) + "/tests/data/report/";

/// A folder with the results of tests/data/report, or those given.
void fill(const Folder& folder, const std::string& results = bytesOf(data + "results.json")) {
  putBytes(folder / "results.json", results);
  putBytes(folder / "experiment.json", bytesOf(data + "experiment.json"));
}

std::string folderOf(const Folder& folder) { return fs::path(folder / "x").parent_path().string(); }

bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

std::size_t countOf(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (std::size_t at = 0; (at = text.find(part, at)) != std::string::npos; at += part.size()) ++count;
  return count;
}

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

/// Cells of table1.csv by method and column.
std::map<std::string, std::map<std::string, std::string>> cellsOf(const std::string& csv) {
  std::istringstream lines(csv);
  std::vector<std::string> head;
  std::map<std::string, std::map<std::string, std::string>> cells;
  for (std::string line; std::getline(lines, line);) {
    std::vector<std::string> fields{""};
    bool inQuotes = false;
    for (const char c : line) {
      if (c == '"')
        inQuotes = !inQuotes;
      else if (c == ',' && !inQuotes)
        fields.emplace_back();
      else
        fields.back() += c;
    }
    if (head.empty())
      head = fields;
    else
      for (std::size_t i = 0; i < fields.size(); ++i) cells[fields[2]][head[i]] = fields[i];
  }
  return cells;
}

}  // namespace

TEST_CASE("the median is the middle, of an even number of values the mean of the two in the middle") {
  CHECK(median({3, 1, 2}) == 2);
  CHECK(median({4, 1, 3, 2}) == 2.5);
  CHECK(median({missing, 7}) == 7);
  CHECK(!known(median({})));
}

TEST_CASE("table 1 holds medians over repetitions, then means over views, with their ranges") {
  Folder folder;
  fill(folder);
  writeReport(folderOf(folder));
  auto cells = cellsOf(bytesOf(folder / "table1.csv"));
  auto& lbvh = cells["lbvh"];
  CHECK(lbvh["total_8spp_ms"] == "160");      // (110 + 210) / 2
  CHECK(lbvh["total_8spp_ms_low"] == "150");  // (100 + 200) / 2
  CHECK(lbvh["total_8spp_ms_high"] == "185");
  CHECK(lbvh["trace_mrays_s"] == "4");  // (5 + 3) / 2
  CHECK(lbvh["build_ms"] == "6");       // The median of 5, 5, 6, 6, 7, 10: no view changes a tree.
  CHECK(lbvh["runs"] == "6");
}

TEST_CASE("the ideal sah has the render of sah and no build, and sah itself keeps its own") {
  Folder folder;
  fill(folder);
  writeReport(folderOf(folder));
  auto cells = cellsOf(bytesOf(folder / "table1.csv"));
  CHECK(cells["sah, ideal"]["total_8spp_ms"] == "120");  // (80 + 160) / 2
  CHECK(cells["sah, ideal"]["build_ms"].empty());
  CHECK(cells["sah, ideal"]["total_8spp_ms_paper"] == "141");
  CHECK(cells["sah"]["total_8spp_ms"] == "170");
  CHECK(cells["sah"]["total_8spp_ms_paper"].empty());  // The paper has no sah that takes time.
}

TEST_CASE("beside each value stands its ratio to the paper's, or the ratio to lbvh where times are not comparable") {
  Folder folder;
  fill(folder);
  writeReport(folderOf(folder));
  auto cells = cellsOf(bytesOf(folder / "table1.csv"));
  CHECK(cells["kmeans-q2"]["sah_cost_paper"] == "211");
  CHECK(cells["kmeans-q2"]["sah_cost_over_paper"] == "1");
  CHECK(cells["kmeans-q2"]["build_ms_paper"] == "4.2");
  CHECK(cells["kmeans-q2"]["trace_mrays_s_paper"] == "212");
  CHECK(cells["kmeans-q2"]["total_8spp_ms_over_lbvh"] == "0.9375");                     // 150 / 160
  CHECK(cells["kmeans-q2"]["total_8spp_ms_paper_over_lbvh"].substr(0, 6) == "0.9025");  // 139 / 154
  const std::string page = bytesOf(folder / "report.html");
  CHECK(has(page, "<td class=\"beside\">×1.00</td>"));
  CHECK(has(page, "<td class=\"beside\">0.94 (0.90)</td>"));
  CHECK(has(page, "GTX TITAN Black at 1024×768"));
  // A row with parameters of its own is none of the paper's methods.
  CHECK(cells["k=4 <&> it's"]["sah_cost_paper"].empty());
}

TEST_CASE("a row whose rays were traced in another way than the usual one says so") {
  std::string results = bytesOf(data + "results.json");
  const std::string row = "\"builder\":{\"name\":\"lbvh\"";
  for (std::size_t at = 0; (at = results.find(row, at)) != std::string::npos; at += 60 + row.size())
    results.insert(at, "\"tracer\":{\"parameters\":{\"trace.leave\":4}},");
  Folder folder;
  fill(folder, results);
  writeReport(folderOf(folder));
  CHECK(countOf(bytesOf(folder / "report.html"), ">trace.leave = 4</td>") == 1);
  CHECK(has(bytesOf(folder / "report.html"), "Parameters in which rows differ"));
}

TEST_CASE("on a GPU at the paper's size times are set against the paper's themselves") {
  std::string results = bytesOf(data + "results.json");
  const auto replace = [&](const std::string& from, const std::string& to) {
    for (std::size_t at = 0; (at = results.find(from, at)) != std::string::npos; at += to.size())
      results.replace(at, from.size(), to);
  };
  replace("\"kind\":\"cpu\"", "\"kind\":\"cuda\"");
  replace("\"width\":320,\"height\":240", "\"width\":1024,\"height\":768");
  Folder folder;
  fill(folder, results);
  writeReport(folderOf(folder));
  CHECK(has(bytesOf(folder / "report.html"), "<td class=\"beside\">×1.08</td>"));  // 150 / 139
}

TEST_CASE("a mesh that is generated or has another number of triangles is none of the paper's") {
  Scene scene;
  scene.plain = "sponza";
  scene.triangles = 66450;
  CHECK(isPapersMesh(scene));
  scene.generated = true;
  CHECK(!isPapersMesh(scene));
  scene.generated = false;
  scene.triangles = 80000;
  CHECK(!isPapersMesh(scene));
  scene.plain = "san-miguel";  // A part of the model that was cut to the paper's count.
  scene.triangles = 7882088;
  CHECK(!isPapersMesh(scene));
}

TEST_CASE(
    "every original that fetch.sh can bring has the paper's row beside it, by the name that its description has") {
  const std::tuple<const char*, double, double> originals[] = {{"sponza", 66450, 264},
                                                               {"sibenik", 75284, 192},
                                                               {"crytek-sponza", 262267, 279},
                                                               {"lbl-conference", 331179, 159},
                                                               {"happy-buddha", 1087716, 216},
                                                               {"soda-hall", 2169000, 270},
                                                               {"laine-hairball", 2880000, 1290},
                                                               {"unc-power-plant", 12759246, 132}};
  for (const auto& [name, triangles, cost] : originals) {
    INFO(name);
    CHECK(
        has(bytesOf(std::string(COPSE_SOURCE_DIR) + "/scenes/" + name + ".toml"), fmt::format("name = \"{}\"", name)));
    Scene scene;
    scene.plain = name;
    scene.triangles = triangles;
    REQUIRE(paperBaseline(scene));
    CHECK(paperBaseline(scene)->cost == cost);
    scene.generated = true;
    CHECK(!paperBaseline(scene));
  }
}

TEST_CASE("the best of a scene and column is bold, those that print alike are all, and the ideal never is") {
  Folder folder;
  fill(folder);
  writeReport(folderOf(folder));
  const std::string page = bytesOf(folder / "report.html");
  CHECK(countOf(page, "<b>211</b>") == 2);  // 211 and 210.6
  CHECK(has(page, "<b>6.00</b>"));          // lbvh's build
  CHECK(has(page, "<b>150</b>"));           // kmeans-q2 at 8 spp, though the ideal has 120
  CHECK(!has(page, "<b>120</b>"));
  const std::string winners = page.substr(page.find("best (scenes)"));
  CHECK(has(winners.substr(0, winners.find("</table>")), "sah (1), kmeans-q2 (1)"));  // Both trace alike.
  CHECK(!has(winners.substr(0, winners.find("</table>")), "ideal"));
}

TEST_CASE("numbers are shown with three digits, or all of their whole part") {
  CHECK(shown(0.4824) == "0.482");
  CHECK(shown(9.996) == "10.0");
  CHECK(shown(99.96) == "100");
  CHECK(shown(12759.4) == "12,759");
  CHECK(shown(missing) == "–");
}

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
  const std::string array = bytesOf(data + "results.json");
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

namespace {

/// tests/data/report with builds of lbvh by further builders.
std::string withBuilders(const std::vector<std::string>& names) {
  std::string results = bytesOf(data + "results.json");
  const std::size_t begin = results.find("{\"schema\"");
  const std::string line = results.substr(begin, results.find('\n', begin) + 1 - begin);
  for (const std::string& name : names) {
    std::string more = line;
    for (std::size_t at = 0; (at = more.find("\"lbvh\"", at)) != std::string::npos; at += name.size())
      more.replace(at, 6, "\"" + name + "\"");
    results.insert(begin, more);
  }
  return results;
}

std::vector<std::string> labelsOf(const report::Scene& scene) {
  std::vector<std::string> labels;
  for (const Row& row : scene.rows) labels.push_back(row.label);
  return labels;
}

}  // namespace

TEST_CASE("every builder has a place of its own, in the order of the registry behind the ideal's, and a colour") {
  std::vector<std::string> names;
  for (const BuilderEntry& entry : builders()) names.push_back(entry.name);
  int last = builderRank(idealBuilder);
  for (const std::string& name : names) {
    INFO(name);
    if (name != idealBuilder) CHECK(builderRank(name) > std::exchange(last, builderRank(name)));
    CHECK(builderColor(name) != builderColor("of tomorrow"));
  }
  CHECK(builderRank("of tomorrow") > last);
  // Families differ, and within one the shades do.
  std::set<unsigned> colors;
  for (const char* name : {"lbvh", "lbvh-apetrei", "hlbvh", "trbvh", "atrbvh", "aac-fast", "aac-hq", "sah", "kmeans-q1",
                           "kmeans-q2", "kmeans-q3", "kmeans-q4", "kmeans-q5"})
    colors.insert(builderColor(name));
  CHECK(colors.size() == 13);
}

TEST_CASE("rows stand in the order of the registry, then Embree's, then builders that are not known, in grey") {
  Folder folder;
  fill(folder, withBuilders({"of tomorrow", "embree-high", "aac-hq", "embree-low"}));
  const Results results = aggregate(load(folderOf(folder)));
  REQUIRE(results.scenes.size() == 1);
  const std::vector<std::string> labels = labelsOf(results.scenes[0]);
  const auto sorted = [&](const std::vector<std::string>& some) {
    std::vector<std::ptrdiff_t> places;
    for (const std::string& label : some)
      places.push_back(std::find(labels.begin(), labels.end(), label) - labels.begin());
    return std::is_sorted(places.begin(), places.end()) && places.back() < static_cast<std::ptrdiff_t>(labels.size());
  };
  CHECK(sorted({"sah, ideal", "sah", "lbvh", "aac-hq", "kmeans-q2", "of tomorrow"}));
  if (!tracers().back().ownTrees.empty()) {
    CHECK(sorted({"kmeans-q2", "embree-low", "embree-high", "of tomorrow"}));
    CHECK(builderColor("embree-low") != builderColor("embree-high"));
    CHECK(builderColor("embree-low") != builderColor("of tomorrow"));
  }
  writeReport(folderOf(folder));
  const std::string page = bytesOf(folder / "report.html");
  for (const char* name : {"embree-low", "embree-high", "of tomorrow"}) CHECK(has(page, name));
}

TEST_CASE("a parameter is told of rows whose method reads it") {
  CHECK(readsParameter("kmeans-q3", "kmeans.k"));
  CHECK_FALSE(readsParameter("sah", "kmeans.k"));
  CHECK_FALSE(readsParameter("kmeans-q3", "leaf.max"));
  CHECK_FALSE(readsParameter("of tomorrow", "kmeans.k"));
  CHECK((isOfOneMethod("kmeans.k") && !isOfOneMethod("leaf.max") && !isOfOneMethod("trace.leave")));
  CHECK((isOfTracer("trace.leave") && !isOfTracer("leaf.max")));
}

TEST_CASE("figures are drawings of their own and parts of the page, and names in them are no commands") {
  if (!gnuplotIsThere()) {
    WARN("gnuplot is not installed: its drawings were not checked");
    return;
  }
  Folder folder;
  std::string results = bytesOf(data + "results.json");
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

TEST_CASE("two folders side by side: ratios where they differ, and no verdict within the spread") {
  Folder a, b, out;
  fill(a);
  std::string results = bytesOf(data + "results.json");
  // lbvh's times to image in the nave, 100, 110 and 150 ms, become 95, 105 and 145; in the loft all are doubled.
  for (const auto& [from, to] : {std::pair{"\"total\":100}", "\"total\":95}"},
                                 {"\"total\":110}", "\"total\":105}"},
                                 {"\"total\":150}", "\"total\":145}"},
                                 {"\"total\":200}", "\"total\":400}"},
                                 {"\"total\":210}", "\"total\":420}"},
                                 {"\"total\":220}", "\"total\":440}"}})
    for (std::size_t at = 0; (at = results.find(from, at)) != std::string::npos; at += 8)
      results.replace(at, std::string(from).size(), to);
  fill(b, results);
  writeComparison(folderOf(a), folderOf(b), out / "new/compare");
  const std::string csv = bytesOf(out / "new/compare/compare.csv");
  CHECK(has(csv, "sponza,nave,lbvh,8,total_ms,110,100,150,3,105,95,145,3,0.9545454545,within the spread"));
  CHECK(has(csv, "sponza,loft,lbvh,8,total_ms,210,200,220,3,420,400,440,3,2,worse"));
  CHECK(has(csv, "sponza,nave,kmeans-q2,8,build_ms,12,12,12,1,12,12,12,1,1,one run"));
  const std::string page = bytesOf(out / "new/compare/report.html");
  CHECK(has(page, "2.00 ▼"));
  CHECK(!has(page, "http"));
  CHECK(!has(page, "class=\"warning\""));

  for (const auto& [from, to] :
       {std::pair{"\"triangles\":66450", "\"triangles\":66451"}, {"\"width\":320", "\"width\":321"}})
    for (std::size_t at = 0; (at = results.find(from, at)) != std::string::npos; at += 8)
      results.replace(at, std::string(from).size(), to);
  fill(b, results);
  writeComparison(folderOf(a), folderOf(b), out / "new/compare");
  const std::string other = bytesOf(out / "new/compare/report.html");
  CHECK(has(other, "sponza has 66,450 triangles in A and 66,451 in B"));
  CHECK(has(other, "differ in size"));
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
