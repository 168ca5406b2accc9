// Reading experiment files: keys, defaults, rows, and errors with file and line.
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

std::vector<std::string> labels(const Experiment& experiment) {
  std::vector<std::string> names;
  for (const ExperimentBuilder& row : experiment.builders) names.push_back(row.label);
  return names;
}

}  // namespace

TEST_CASE("an experiment is what its file says, with defaults for the rest") {
  ExperimentFolder folder;
  const Experiment x = folder.read(
      "title = \"T\"\nreport = [\"table\", \"phases\"]\nscenes = [\"small.toml\"]\nspp = [8, 128]\nsize = [40, 30]\n"
      "repetitions = [5, 2]\nmax_depth = 3\nlight_samples = 4\nseed = 9\ndevice = \"cpu\"\nthreads = 2\n"
      "warm_up = { least = 1, most = 2, within = 0.5, builds = 0 }\nset = { leaf.rule = \"count\" }\n" +
      lbvhRow);
  CHECK(x.name == "x");
  CHECK(x.title == "T");
  CHECK(x.report == std::vector<std::string>{"table", "phases"});
  REQUIRE(x.scenes.size() == 1);
  CHECK(x.scenes[0].name == "small");
  CHECK(x.scenes[0].views == std::vector<std::string>{"front", "side"});
  CHECK(x.spp == std::vector<int>{8, 128});
  CHECK(x.repetitions == std::vector<int>{5, 2});
  CHECK((x.settings.width == 40 && x.settings.height == 30 && x.settings.maxDepth == 3));
  CHECK((x.settings.lightSamples == 4 && x.settings.seed == 9 && x.device == "cpu" && x.threads == 2));
  CHECK((x.warmUp.min == 1 && x.warmUp.max == 2 && x.warmUp.within == 0.5 && x.warmUp.builds == 0));
  CHECK(x.builders.at(0).parameters.text("leaf.rule") == "count");

  const Experiment plain = folder.read("scenes = [{ generator = \"cornell\" }]\nspp = 2\n" + lbvhRow);
  CHECK((plain.settings.width == 1024 && plain.settings.height == 768));
  CHECK(plain.repetitions == std::vector<int>{3});
  CHECK(plain.scenes[0].views.size() == 3);
  CHECK(plain.device == "auto");
}

TEST_CASE("views are chosen by number, by name, or all, for every scene or for one") {
  ExperimentFolder folder;
  const auto viewsOf = [&](const std::string& views, const std::string& scene) {
    return folder.read("spp = 1\n" + views + "scenes = [" + scene + "]\n" + lbvhRow).scenes[0].views;
  };
  using Names = std::vector<std::string>;
  CHECK(viewsOf("views = 1\n", "\"small.toml\"") == Names{"front"});
  CHECK(viewsOf("views = \"all\"\n", "\"small.toml\"") == Names{"front", "side"});
  CHECK(viewsOf("views = [\"side\"]\n", "\"small.toml\"") == Names{"side"});
  CHECK(viewsOf("views = 1\n", "{ file = \"small.toml\", views = \"side\" }") == Names{"side"});
  CHECK(viewsOf("", "\"small.obj\"") == Names{"front"});
  CHECK(contains(folder.errorOf("spp = 1\nscenes = [{ file = \"small.toml\", views = [\"top\"] }]\n" + lbvhRow),
                 "x.toml:2: unknown view 'top' (available: front, side)"));
  CHECK(contains(folder.errorOf("spp = 1\nviews = [\"side\", \"side\"]\nscenes = [\"small.toml\"]\n" + lbvhRow),
                 "x.toml:2: view 'side' is named twice"));
}

TEST_CASE("lists in set make a row for each combination, the last key fastest") {
  ExperimentFolder folder;
  const std::string head = "spp = []\nscenes = [{ generator = \"cornell\" }]\n[[builder]]\nname = \"kmeans\"\n";
  CHECK(labels(folder.read(head + "set = { \"kmeans.k\" = [8, 16], kmeans.i = [0, 2] }\n")) ==
        std::vector<std::string>{"kmeans,k=8,i=0", "kmeans,k=8,i=2", "kmeans,k=16,i=0", "kmeans,k=16,i=2"});
  const Experiment x =
      folder.read(head + "label = \"k{kmeans.k}p{kmeans.p}\"\nset = { kmeans.k = [8, 16], kmeans.p = 7 }\n");
  CHECK(labels(x) == std::vector<std::string>{"k8p7", "k16p7"});
  CHECK(x.builders[1].parameters.integer("kmeans.k") == 16);
  CHECK(x.builders[1].parameters.integer("kmeans.p") == 7);
  CHECK(labels(folder.read(head + "set = { kmeans.k = 8 }\n")) == std::vector<std::string>{"kmeans"});
  CHECK(crossProduct({}).size() == 1);
}

TEST_CASE("optimise names what runs over a row's trees, and the label tells it") {
  ExperimentFolder folder;
  const std::string head = "spp = []\nscenes = [\"small.toml\"]\n";
  Experiment x = folder.read(head + lbvhRow + "[[builder]]\nname = \"lbvh\"\noptimise = [\"treelets-exact\"]\n" +
                             "[[builder]]\nname = \"trbvh\"\n");
  CHECK(labels(x) == std::vector<std::string>{"lbvh", "lbvh+treelets-exact", "trbvh"});
  const Device device = chosenDevice();
  MeasuringRunner runner(x, device, "");
  runner.load(0);
  std::vector<RunRecord> records;
  for (const PlannedRun& run : planOf(x))
    if (run.repetition == 1) records.push_back(runner.run(run, {}).record);
  const auto cost = [&](std::size_t row) { return records[row].tree->statistics->sahCost; };
  CHECK(cost(1) == cost(2));
  CHECK(records[1].optimisers == OptimiserNames{"treelets-exact"});
  CHECK(Json::parse(toJson(records[1]))["builder"]["optimise"] == Json::array({"treelets-exact"}));
  CHECK_FALSE(Json::parse(toJson(records[0]))["builder"].contains("optimise"));
  CHECK(contains(folder.errorOf(head + "[[builder]]\nname = \"lbvh\"\noptimise = [\"fast\"]\n"),
                 "x.toml:5: unknown optimiser 'fast'"));
}

TEST_CASE("how rays are traced is set like a builder's parameters, and recorded where it is not the default") {
  ExperimentFolder folder;
  const std::string head = "spp = 1\nscenes = [\"small.toml\"]\n";
  const Experiment x =
      folder.read(head + "set = { path.queue = 1000 }\n" + lbvhRow + "set = { trace.leave = [4, 8] }\n");
  CHECK(labels(x) == std::vector<std::string>{"lbvh,leave=4", "lbvh,leave=8"});
  CHECK(contains(folder.errorOf(head + lbvhRow + "set = { trace.fetch = 0 }\n"),
                 "trace.fetch: expected an integer from 1"));

  RunRecord record;
  record.parameters = x.builders[0].parameters;
  const std::string line = toJson(record, true);
  const Json told = Json::parse(line);
  CHECK(told["tracer"]["parameters"] == Json{{"trace.leave", 4}, {"path.queue", 1000}});
  CHECK_FALSE(told["builder"]["parameters"].contains("trace.leave"));
  CHECK(contains(lines(resultsCsv({{"", line, 1, false}})).at(1), " trace.leave=4 path.queue=1000"));
  record.parameters = Parameters();
  CHECK_FALSE(Json::parse(toJson(record)).contains("tracer"));
  record.tracer = "wide8";
  const std::string named = toJson(record, true);
  CHECK(Json::parse(named)["tracer"] == Json{{"name", "wide8"}});
  const std::vector<std::string> table = lines(resultsCsv({{"", named, 1, false}}));
  CHECK(contains(table.at(0), ",tracer,"));
  CHECK(contains(table.at(1), ",wide8,"));
}

TEST_CASE("each row is measured with every tracer, and labels and keys tell them apart") {
  ExperimentFolder folder;
  const std::string head = "scenes = [\"small.toml\"]\nspp = 1\n";
  const auto of = [&](const std::string& text) { return folder.read(head + text); };
  const Experiment both = of("tracers = [\"binary\", \"wide8\"]\n" + lbvhRow +
                             "[[builder]]\nname = \"kmeans\"\nlabel = \"k {kmeans.i} {tracer}\"\n" +
                             "[[builder]]\nname = \"sah\"\nlabel = \"S\"\ntracer = \"auto\"\n");
  CHECK(labels(both) ==
        std::vector<std::string>{"lbvh,tracer=binary", "lbvh,tracer=wide8", "k 2 binary", "k 2 wide8", "S"});
  CHECK(both.builders[1].tracer.name() == std::string("wide8"));
  CHECK(both.builders[4].tracer.isAuto());
  std::set<std::string> keys;
  for (const PlannedRun& run : planOf(both)) keys.insert(run.key + fmt::format(" {}", run.repetition));
  CHECK(keys.size() == planOf(both).size());
  const Experiment inPlace = readExperiment(folder / "x.toml", "wide8");
  for (const ExperimentBuilder& row : inPlace.builders) CHECK(row.tracer.name() == std::string("wide8"));

  CHECK(labels(of("tracers = [\"wide8\"]\n" + lbvhRow)) == std::vector<std::string>{"lbvh"});
  CHECK(labels(of(lbvhRow + "tracer = \"wide8\"\n" + lbvhRow)) ==
        std::vector<std::string>{"lbvh,tracer=wide8", "lbvh"});
  CHECK(of(lbvhRow + "tracer = [\"wide8\", \"auto\"]\n").builders.size() == 2);

  for (const auto& [text, error] :
       {std::pair<std::string, std::string>{"tracers = [\"bvh16\"]\n" + lbvhRow, "x.toml:3: unknown tracer 'bvh16'"},
        {"tracers = [\"binary\", \"binary\"]\n" + lbvhRow, "named twice"},
        {"tracers = []\n" + lbvhRow, "empty list"},
        {lbvhRow + "tracer = 3\n", "x.toml:5"}})
    CHECK_THROWS_WITH(of(text), Contains(error));
  if (tracers().back().ownTrees.empty()) return;
  CHECK_THROWS_WITH(of("tracers = [\"embree\"]\n" + lbvhRow), Contains("builds its own trees"));
  const std::string embree = "[[builder]]\nname = \"embree-low\"\n";
  CHECK_THROWS_WITH(of(embree + "tracer = \"wide8\"\n"), Contains("x.toml:5") && Contains("cannot trace embree-low"));
  CHECK(labels(of("tracers = [\"binary\", \"wide8\"]\n" + embree)) == std::vector<std::string>{"embree-low"});
}

TEST_CASE("the configurations that come with Copse can be read, and hold what the paper has") {
  const auto read = [](const std::string& name) {
    return readExperiment(std::string(COPSE_SOURCE_DIR "/configs/") + name + ".toml");
  };
  CHECK(labels(read("quick")).size() >= 10);
  CHECK(read("quick").renders());
  CHECK(labels(read("scaling")).size() == 8);
  CHECK(read("scaling").scenes.size() == 6);
  const Experiment parameters = read("parameters"), iterations = read("iterations"), paper = read("paper");
  CHECK(labels(parameters).size() == 88);
  CHECK_FALSE(parameters.renders());
  CHECK(labels(iterations).size() == 64);
  CHECK(labels(iterations)[17] == "kmeans-r2,i=1");
  CHECK(labels(read("phases")).size() >= 5);
  // Missing originals are left out, and the generators' scenes replace them.
  CHECK(paper.scenes.size() >= 5);
  CHECK(iterations.scenes.size() == 1);
  CHECK(labels(paper) == std::vector<std::string>{"sah", "lbvh", "hlbvh", "atrbvh", "kmeans-q1", "kmeans-q2",
                                                  "kmeans-q3", "kmeans-q4", "kmeans-q5"});
  CHECK(paper.spp == std::vector<int>{8, 128});
  CHECK(labels(read("gpu")).size() == 12);
  CHECK(read("gpu").scenes.size() >= 4);  // The generated ones; real meshes may be missing.
  CHECK((labels(read("gpu-short")).size() == 7 && read("gpu-short").scenes.size() >= 2));
  CHECK(labels(read("gpu-variants")).size() == 16);
  CHECK(labels(read("gpu-variants"))[1] == "leave at 0, fetch below 20");
  CHECK((read("gpu").validated == Checked::scenes && read("gpu-short").validated == Checked::scenes));
}

TEST_CASE("errors in an experiment are reported with file and line before anything runs") {
  ExperimentFolder folder;
  const std::string scenes = "scenes = [\"small.toml\"]\n";
  struct Wrong {
    std::string text, message;
  };
  const Wrong wrongs[] = {
      {"spp = 1\n" + scenes + "samples = 4\n" + lbvhRow, "x.toml:3: unknown key 'samples' in an experiment"},
      {scenes + lbvhRow, "lacks the key 'spp'"},
      {"spp = [8, 0]\n" + scenes + lbvhRow, "x.toml:1: 'spp': expected integers from 1 to"},
      {"spp = [8, 8]\n" + scenes + lbvhRow, "x.toml:1: 'spp': expected ascending numbers, got 8 after 8"},
      {"spp = 1\n" + lbvhRow, "'scenes': expected an array"},
      {"spp = 1\nscenes = [3]\n" + lbvhRow, "x.toml:2: expected a scene: a file name"},
      {"spp = 1\nscenes = [\"small.toml\", \"small.toml\"]\n" + lbvhRow, "x.toml:2: duplicate scene 'small'"},
      {"spp = 1\nscenes = [{ generator = \"sponge\" }]\n" + lbvhRow, "x.toml:2: unknown generator 'sponge'"},
      {"spp = 1\nscenes = [{ file = \"small.toml\", seed = 2 }]\n" + lbvhRow,
       "x.toml:2: 'seed' does not go with 'file'"},
      {"spp = 1\nscenes = [\"gone.toml\"]\n" + lbvhRow, "found none of its scenes"},
      {"spp = 1\nmissing_scenes = \"fail\"\nscenes = [\"small.toml\",\n\"gone.toml\"]\n" + lbvhRow,
       "x.toml:4: no file gone.toml"},
      {"spp = 1\nsize = [10]\n" + scenes + lbvhRow, "x.toml:2: 'size': expected [width, height]"},
      {"spp = [1, 2]\nrepetitions = [1, 2, 3]\n" + scenes + lbvhRow,
       "x.toml:2: 'repetitions': expected one number, or 2"},
      {"spp = 1\nreport = [\"pie\"]\n" + scenes + lbvhRow, "x.toml:2: unknown figure 'pie'"},
      {"spp = 1\ndevice = \"gpu\"\n" + scenes + lbvhRow, "x.toml:2: 'device': expected auto, cuda or cpu, got 'gpu'"},
      {"spp = 1\nvalidate = true\n" + scenes + lbvhRow, "x.toml:2: 'validate'"},
      {"spp = 1\nvalidate = \"once\"\n" + scenes + lbvhRow,
       "x.toml:2: 'validate': expected rows, scenes or none, got 'once'"},
      {"spp = 1\nwarm_up = { most = 2, least = 3 }\n" + scenes + lbvhRow, "x.toml:2: 'most' is less than 'least'"},
      {"spp = 1\n" + scenes, "needs at least one [[builder]]"},
      {"spp = 1\n" + scenes + "[[builder]]\nname = \"bvh\"\n", "x.toml:4: unknown builder 'bvh'"},
      {"spp = 1\n" + scenes + lbvhRow + lbvhRow, "duplicate row 'lbvh'"},
      {"spp = 1\n" + scenes + lbvhRow + "set = { leaf.max = 0 }\n",
       "x.toml:5: leaf.max: expected an integer from 1 to 64, got 0"},
      {"spp = 1\n" + scenes + lbvhRow + "set = { leaf.max = [4, 99999] }\n",
       "x.toml:5: leaf.max: expected an integer from 1 to 64, got 99999"},
      {"spp = 1\n" + scenes + lbvhRow + "set = { leaf.mux = 1 }\n", "x.toml:5: unknown parameter 'leaf.mux'"},
      {"spp = 1\nset = { leaf.max = [1, 2] }\n" + scenes + lbvhRow, "x.toml:2: 'leaf.max' is a list"},
      {"spp = 1\n" + scenes + lbvhRow + "label = \"a/b\"\n", "x.toml:5: 'a/b' cannot be the name of a builder"},
      {"spp = 1\n" + scenes + lbvhRow + "label = \"{leaf.max\"\n", "x.toml:5: '{leaf.max' has no '}'"},
      {"spp = 1\nspp = 2\n", "x.toml:2: "},
  };
  for (const Wrong& wrong : wrongs) {
    const std::string error = folder.errorOf(wrong.text);
    INFO(wrong.text);
    INFO(error);
    CHECK(contains(error, wrong.message));
    CHECK(contains(error, "x.toml"));
  }
}

TEST_CASE("a missing scene is left out with a note, or another replaces it under its own name") {
  ExperimentFolder folder;
  putBytes(folder / "far.toml", "name = \"far\"\n[[mesh]]\nfile = \"no/such.obj\"\n");
  const Experiment x = folder.read(
      "spp = 1\nscenes = [\"far.toml\", \"gone.toml\", { file = \"away.toml\", instead = \"small.toml\" }]\n" +
      lbvhRow + "[[builder]]\nname = \"nobody\"\noptional = true\n");
  REQUIRE(x.scenes.size() == 1);
  CHECK(x.scenes[0].name == "small");
  REQUIRE(x.leftOut.size() == 4);
  CHECK(x.leftOut[0].name == "nobody");
  CHECK(x.leftOut[1].name == "far");
  CHECK(contains(x.leftOut[1].why, "far.toml:3: no file 'no/such.obj'"));
  CHECK(x.leftOut[2].name == "gone");
  CHECK(x.leftOut[3].name == "away");
}
