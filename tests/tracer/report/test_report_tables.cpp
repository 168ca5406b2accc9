// The report's tables and rows, checked against numbers worked out by hand from tests/data/report: medians over three
// repetitions, means over two views, the ideal sah, ratios to the paper.
#include <fmt/format.h>

#include <set>
#include <tuple>
#include <utility>

#include "builder/registry.h"
#include "tests/support/catch.h"
#include "tests/support/report_files.h"
#include "tracer/accel/tracers.h"
#include "tracer/report/aggregate.h"
#include "tracer/report/builders.h"
#include "tracer/report/html.h"
#include "tracer/report/paper.h"
#include "tracer/report/report.h"
#include "tracer/report/table.h"

using namespace copse;
using namespace copse::report;
using namespace copse::test;

namespace {

/// tests/data/report with builds of lbvh by further builders.
std::string withBuilders(const std::vector<std::string>& names) {
  std::string results = bytesOf(reportData + "results.json");
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
  std::string results = bytesOf(reportData + "results.json");
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
  std::string results = bytesOf(reportData + "results.json");
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

TEST_CASE("two folders side by side: ratios where they differ, and no verdict within the spread") {
  Folder a, b, out;
  fill(a);
  std::string results = bytesOf(reportData + "results.json");
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
