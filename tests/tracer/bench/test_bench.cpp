// Experiments as they run: the order, what is checked, and what is written of them.
#include <fmt/format.h>

#include <set>
#include <sstream>

#include "tests/support/catch.h"
#include "tests/support/devices.h"
#include "tests/support/experiments.h"
#include "tracer/bench/results.h"
#include "tracer/bench/runner.h"

using namespace copse;
using namespace copse::test;
using Json = nlohmann::json;

namespace {

/// lbvh, with one triangle in two leaves and another in none.
OpenTree buildUnsound(const Device& device, const Primitives& input, const Parameters& parameters) {
  OpenTree bvh = findBuilder("lbvh").method->build(device, input, parameters);
  std::vector<uint32_t> order = bvh.order.toHost();
  order[0] = order[1];
  bvh.order.upload(order);
  return bvh;
}

}  // namespace

TEST_CASE("trees are checked in every row, once per scene, or not at all") {
  const Method method{.name = "unsound", .source = "", .meaning = "", .build = buildUnsound};
  const BuilderEntry unsound{"unsound", "", "", &method};
  ExperimentFolder folder;
  Experiment x = folder.read("scenes = [\"small.toml\"]\nspp = []\n" + lbvhRow + "[[builder]]\nname = \"hlbvh\"\n");
  const Device device = chosenDevice();
  const auto throws = [&](Checked checked, std::size_t row) {
    x.validated = checked;
    x.builders[0].source = row == 0 ? unsound : findBuilder("lbvh");
    x.builders[1].source = row == 1 ? unsound : findBuilder("lbvh");
    MeasuringRunner runner(x, device, "");
    runner.load(0);
    try {
      for (const PlannedRun& run : planOf(x)) runner.run(run, {});
    } catch (const ValidationError&) {
      return true;
    }
    return false;
  };
  CHECK((throws(Checked::rows, 0) && throws(Checked::rows, 1)));
  CHECK((throws(Checked::scenes, 0) && !throws(Checked::scenes, 1)));
  CHECK((!throws(Checked::none, 0) && !throws(Checked::none, 1)));

  const auto read = [&](const std::string& key) {
    return folder.read(key + "scenes = [\"small.toml\"]\nspp = []\n" + lbvhRow).validated;
  };
  CHECK((read("") == Checked::rows && read("validate = \"scenes\"\n") == Checked::scenes));
  CHECK(read("validate = \"none\"\n") == Checked::none);
}

TEST_CASE("runs are interleaved: every builder once before any has its next repetition") {
  ExperimentFolder folder;
  const Experiment x = folder.read(smallExperiment);
  const std::vector<PlannedRun> plan = planOf(x);
  REQUIRE(plan.size() == (2 + 1) * 3 * 2 * 2);
  const char* const first[] = {"small/front/lbvh/1", "small/front/sah/1", "small/front/kmeans-q1/1",
                               "small/front/lbvh/1", "small/front/sah/1", "small/front/kmeans-q1/1",
                               "small/front/lbvh/4"};
  for (int i = 0; i < 7; ++i) CHECK(plan[i].key == first[i]);
  CHECK((plan[2].repetition == 1 && plan[3].repetition == 2));
  CHECK(plan[12].key == "small/side/lbvh/1");
  CHECK(plan[24].key == "cornell/front/lbvh/1");

  const Experiment trees = folder.read("spp = []\nscenes = [\"small.toml\"]\nrepetitions = 2\n" + lbvhRow);
  CHECK(planOf(trees).size() == 2);
  CHECK(planOf(trees)[1].key == "small/lbvh");
}

TEST_CASE("each scene is loaded once and warmed up until three times in a row have the same median") {
  CHECK_FALSE(isSteady({5, 5, 5}, 0.03));
  CHECK(isSteady({9, 5, 5, 5}, 0.03));
  CHECK_FALSE(isSteady({9, 8, 7, 6}, 0.03));
  ExperimentFolder folder;
  const Experiment x = folder.read(smallExperiment);
  const std::vector<PlannedRun> plan = planOf(x);
  Journal journal(folder / "j");
  FakeRunner runner(x);
  REQUIRE(runAll(x, openDevice("cpu", 1), plan, journal, runner));
  CHECK(runner.calls[0] == "load small");
  // Steady at once, so four of the first; then a tree of each.
  for (int i = 1; i <= 5; ++i) CHECK(runner.calls[i] == "warm lbvh");
  CHECK(runner.calls[7] == "warm kmeans-q1");
  CHECK(runner.calls[8] == "small/front/lbvh/1");
  CHECK(std::count(runner.calls.begin(), runner.calls.end(), "load small") == 1);
  CHECK(std::count(runner.calls.begin(), runner.calls.end(), "load cornell") == 1);
  CHECK(journal.entries().size() == plan.size());
  CHECK(Json::parse(journal.entries()[0].line)["run"] == Json{{"key", "small/front/lbvh/1"},
                                                              {"label", "lbvh"},
                                                              {"repetition", 1},
                                                              {"status", "done"},
                                                              {"experiment", "small"},
                                                              {"warm_up", 7}});
  CHECK(Json::parse(journal.entries()[24].line)["run"]["warm_up"] == 7);  // For its own scene, the second.
}

TEST_CASE("a run that fails is recorded with its error and the rest goes on") {
  ExperimentFolder folder;
  const Experiment x = folder.read(smallExperiment);
  Journal journal(folder / "j");
  FakeRunner runner(x);
  runner.before = [](const PlannedRun& run) {
    if (run.key == "small/side/sah/4") throw DeviceError("the device has had enough");
    if (run.key == "cornell/front/lbvh/1") throw std::bad_alloc();
  };
  std::vector<std::string> told;
  LoopEvents events;
  events.failed = [&](const PlannedRun& run, const std::string& error) { told.push_back(run.key + ": " + error); };
  REQUIRE(runAll(x, openDevice("cpu", 1), planOf(x), journal, runner, events));
  CHECK(told.size() == 4);
  CHECK(told[0] == "small/side/sah/4: the device has had enough");
  CHECK(told[2] == "cornell/front/lbvh/1: out of memory");
  CHECK(journal.entries().size() == planOf(x).size());
  int failed = 0;
  for (const Journal::Entry& entry : journal.entries()) {
    if (!entry.failed) continue;
    ++failed;
    const Json record = Json::parse(entry.line);
    CHECK(record["run"]["error"].is_string());
    CHECK(record["builder"]["name"].is_string());
    CHECK(record["image"]["spp"].is_number());
    for (const char* key : {"time_ms", "bvh", "rays"}) CHECK_FALSE(record.contains(key));
  }
  CHECK(failed == 4);
}

TEST_CASE("the time left is estimated from what has been measured") {
  ExperimentFolder folder;
  const Experiment x = folder.read(smallExperiment);
  const std::vector<PlannedRun> plan = planOf(x);
  Estimate estimate(x, openDevice("cpu", 1));
  CHECK_FALSE(estimate.measured());
  CHECK(estimate.of(plan) > 0);
  estimate.learn(plan[0], 10, 100);  // 1 spp.
  CHECK(estimate.measured());
  CHECK(estimate.of(plan[0]) == Approx(110));
  CHECK(estimate.of(plan[1]) == Approx(110));  // Another builder: as the known one.
  CHECK(estimate.of(plan[6]) == Approx(410));  // 4 spp.
  CHECK(estimate.of(plan, plan.size() - 3) == Approx(3 * 410));
  CHECK(durationText(35) == "35 s");
  CHECK(durationText(840) == "14 min");
  CHECK(durationText(7500) == "2 h 05 min");
}

TEST_CASE("results.csv has a line per record and a column per phase, results.json the same records") {
  ExperimentFolder folder;
  const Experiment x = folder.read(
      "spp = 2\nrepetitions = 2\nsize = [16, 12]\nscenes = [{ file = \"small.toml\", views = 1"
      ", name = \"a, \\\"b\\\"\" }]\n" +
      lbvhRow + "[[builder]]\nname = \"sah\"\n");
  Journal journal(folder / "j");
  const Device device = openDevice("cpu", 1);
  MeasuringRunner runner(x, device, "");
  REQUIRE(runAll(x, device, planOf(x), journal, runner));
  REQUIRE(journal.entries().size() == 4);
  writeResults(folder / "", journal.entries());
  const Json records = Json::parse(bytesOf(folder / "results.json"));
  REQUIRE(records.size() == 4);
  for (std::size_t i = 0; i < 4; ++i) CHECK(records[i] == Json::parse(journal.entries()[i].line));
  CHECK(records[0]["scene"]["name"] == "a, \"b\"");
  CHECK(records[0]["bvh"]["sah_cost"] == records[2]["bvh"]["sah_cost"]);
  CHECK(records[0]["memory"]["build_peak_bytes"] > 0);

  const std::vector<std::string> csv = lines(bytesOf(folder / "results.csv"));
  REQUIRE(csv.size() == 5);
  CHECK(contains(csv[0], "key,scene,view,label,spp,repetition,status,error,triangles"));
  CHECK(contains(csv[0], "build: morton"));
  CHECK(contains(csv[0], "build: sweep"));
  CHECK(contains(csv[0], "render: trace bounce"));
  CHECK(csv[1].rfind("\"a, \"\"b\"\"/front/lbvh/2\",\"a, \"\"b\"\"\",front,lbvh,2,1,done,,14,lbvh,cpu", 0) == 0);
}

TEST_CASE("results.csv names the optimisers as the command line does") {
  const std::string line = R"({"builder": {"name": "lbvh", "optimise": ["treelets-exact", "treelets-agglomerative"]}})";
  const std::vector<std::string> csv = lines(resultsCsv({{"", line, 1, false}}));
  CHECK(contains(csv.at(0), ",optimise,"));
  CHECK(contains(csv.at(1), ",\"treelets-exact,treelets-agglomerative\","));
}

TEST_CASE("the table has medians over repetitions and means over views") {
  ExperimentFolder folder;
  const Experiment x = folder.read(smallExperiment);
  Journal journal(folder / "j");
  FakeRunner runner(x);
  runAll(x, openDevice("cpu", 1), planOf(x), journal, runner);
  const std::vector<std::string> table = lines(resultsTable(journal.entries()));
  CHECK(contains(table[1], "small"));
  CHECK(contains(table[2], "ms at 4 spp"));
  std::istringstream sah(table[4]);
  std::string label;
  double cost, build, one, four;
  sah >> label >> cost >> build >> one >> four;
  CHECK(label == "sah");
  CHECK(cost == 11);
  CHECK(build == 4);
  CHECK(one == Approx(4 + 101.5));
  CHECK(four == Approx(4 + 401.5));
}

TEST_CASE("a picture's pixels are the means of what they cover") {
  Image image;
  image.width = 5, image.height = 2;
  for (int i = 0; i < 10; ++i) image.pixels.push_back(vec3(static_cast<float>(i % 5)));
  const Image small = boxFiltered(image, 2);
  REQUIRE((small.width == 2 && small.height == 1));
  CHECK(small.at(0, 0).x == Approx((0 + 1 + 0.5 * 2) / 2.5));
  CHECK(small.at(1, 0).x == Approx((0.5 * 2 + 3 + 4) / 2.5));
  CHECK(boxFiltered(image, 5).pixels.size() == 10);
}
