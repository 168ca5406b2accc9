// copse bench from outside: killed, interrupted, out of disk, and resumed.
#include <signal.h>

#include <chrono>
#include <random>
#include <set>
#include <thread>

#include "tests/support/catch.h"
#include "tests/support/devices.h"
#include "tests/support/experiments.h"
#include "tests/support/program.h"
#include "tracer/image/image_io.h"

using namespace copse;
using namespace copse::test;
using Json = nlohmann::json;
using namespace std::chrono_literals;

namespace {

/// 3 views of two scenes, 3 builders, 2 numbers of samples, 2 repetitions; no warm-up.
struct Bench : ExperimentFolder {
  static constexpr std::size_t runs = 36;
  const std::string config = std::string("warm_up = { least = 0, most = 0, builds = 0 }\n") + smallExperiment;
  std::string device;  ///< Empty for the test program's.
  Bench() { write(config); }
  std::vector<std::string> arguments(bool resume = true) const {
    const std::string on = device.empty() ? deviceOption() : device;
    std::vector<std::string> list{"bench", "x.toml", "-o", "r", "--device", on, "--threads", "1"};
    if (resume) list.push_back("--resume");
    return list;
  }
  Ran bench(bool resume = true, const std::vector<Limit>& limits = {}) const {
    return runCopse(*this / "", arguments(resume), limits);
  }
  std::string journal() const { return bytesOf(*this / "r/results.jsonl"); }
};

/// The whole lines of a journal; each must be a record, and none the same run as another.
std::vector<std::string> runsOf(const std::string& journal) {
  std::vector<std::string> keys;
  std::set<std::string> once;
  for (std::size_t begin = 0, end; (end = journal.find('\n', begin)) != std::string::npos; begin = end + 1) {
    const Json record = Json::parse(journal.substr(begin, end - begin), nullptr, false);
    REQUIRE(record.is_object());
    keys.push_back(record["run"]["key"].get<std::string>() + " " + record["run"]["repetition"].dump());
    CHECK(once.insert(keys.back()).second);
  }
  return keys;
}

bool waitFor(const std::function<bool()>& condition) {
  for (int i = 0; i < 20000; ++i) {
    if (condition()) return true;
    std::this_thread::sleep_for(1ms);
  }
  return false;
}

}  // namespace

TEST_CASE("an experiment that is killed ten times and resumed loses no run and repeats none", "[medium]") {
  Bench bench;
  constexpr std::size_t runs = 8 * Bench::runs;  // So many that no kill comes too late.
  bench.write(std::string(bench.config).replace(bench.config.find("repetitions = 2"), 15, "repetitions = 16"));
  std::mt19937 random(4);
  std::string before;
  int killed = 0;
  for (int i = 0; i < 10; ++i) {
    Running running(bench / "", bench.arguments());
    // At any moment, once a few more runs are done: between two, in the middle of one, while one is written.
    const std::size_t more = random() % 4;
    const std::size_t wanted = std::count(before.begin(), before.end(), '\n') + more;
    waitFor([&] {
      const std::string now = bench.journal();
      return running.hasEnded() || static_cast<std::size_t>(std::count(now.begin(), now.end(), '\n')) >= wanted;
    });
    std::this_thread::sleep_for(std::chrono::microseconds(random() % 8000));
    running.signal(SIGKILL);
    killed += running.wait().status == 128 + SIGKILL;
    const std::string after = bench.journal();
    const std::size_t whole = before.rfind('\n') + 1;  // 0 where there is no line.
    CHECK(after.compare(0, whole, before, 0, whole) == 0);
    before = after;
    runsOf(before);
  }
  CHECK(killed == 10);
  const Ran last = bench.bench();
  INFO(last.err);
  REQUIRE(last.status == 0);
  CHECK(runsOf(bench.journal()).size() == runs);
  CHECK(bench.journal().compare(0, before.rfind('\n') + 1, before, 0, before.rfind('\n') + 1) == 0);
  const Json results = Json::parse(bytesOf(bench / "r/results.json"));
  CHECK(results.size() == runs);
  const Json experiment = Json::parse(bytesOf(bench / "r/experiment.json"));
  CHECK((experiment["planned"] == runs && experiment["done"] == runs && experiment["failed"] == 0));
  CHECK(experiment["finished"].is_string());
  CHECK(experiment["config"] == bytesOf(bench / "x.toml"));
  for (const char* file : {"r/results.csv", "r/report.html"}) CHECK(std::filesystem::exists(bench / file));
}

TEST_CASE("a torn last line of the journal is dropped, a torn line before it is an error") {
  Folder folder;
  const std::string file = folder / "j";
  const auto line = [](int repetition) {
    return Json{{"run", {{"key", "a/b"}, {"repetition", repetition}, {"status", "done"}}}}.dump() + "\n";
  };
  for (const std::string& tail :
       {std::string(), line(3).substr(0, 20), std::string("{\"run\": 3}\n"), std::string("\n")}) {
    putBytes(file, line(1) + line(2) + tail);
    {
      Journal journal(file);
      CHECK(journal.entries().size() == 2);
      CHECK((journal.holds("a/b", 2) && !journal.holds("a/b", 3) && !journal.holds("a", 1)));
      journal.append(line(3));
    }
    CHECK(bytesOf(file) == line(1) + line(2) + line(3));
  }
  putBytes(file, line(1) + "{\"run\": \n" + line(2));
  CHECK_THROWS_WITH(Journal(file), Contains("j:2: expected the record of a run"));
}

TEST_CASE("a run whose record was torn is made again", "[medium]") {
  Bench bench;
  REQUIRE(bench.bench(false).status == 0);
  const std::string whole = bench.journal();
  const std::size_t last = whole.rfind('\n', whole.size() - 2) + 1;
  putBytes(bench / "r/results.jsonl", whole.substr(0, last + 40));
  REQUIRE(bench.bench().status == 0);
  CHECK(runsOf(bench.journal()).size() == Bench::runs);
  CHECK(bench.journal().compare(0, last, whole, 0, last) == 0);
}

TEST_CASE("a disk that is full is a clear error, and what was done before stays", "[medium]") {
  Bench bench;
  bench.device = "cpu";  // A GPU's driver writes files of its own, to which the limit would apply as well.
  // Room for some records.
  const Ran full = bench.bench(false, {{RLIMIT_FSIZE, 20'000}});
  CHECK(full.status == 2);
  CHECK(contains(full.err, "r/results.jsonl: cannot write: File too large"));
  const std::string part = bench.journal();
  CHECK(part.size() <= 20'000);
  CHECK(part.back() == '\n');
  const std::size_t some = runsOf(part).size();
  CHECK((some > 2 && some < Bench::runs));
  const Ran rest = bench.bench();
  INFO(rest.err);
  CHECK(rest.status == 0);
  CHECK(runsOf(bench.journal()).size() == Bench::runs);
}

TEST_CASE("Ctrl-C ends with 130 and the results so far, without the run in progress") {
  Bench bench;
  bench.write(
      "name = \"long\"\nscenes = [\"small.toml\"]\nspp = [1, 100000]\nsize = [160, 120]\nrepetitions = [2, 1]\n"
      "views = 1\nwarm_up = { least = 0, most = 0, builds = 0 }\n[[builder]]\nname = \"lbvh\"\n");
  Running running(bench / "", bench.arguments());
  REQUIRE(waitFor([&] { return runsOf(bench.journal()).size() == 2 || running.hasEnded(); }));
  std::this_thread::sleep_for(50ms);
  running.signal(SIGINT);
  const Ran ran = running.wait();
  INFO(ran.err);
  CHECK(ran.status == 130);
  CHECK(contains(ran.err, "interrupted: 1 runs are left; continue with --resume"));
  CHECK(Json::parse(bytesOf(bench / "r/results.json")).size() == 2);
  const Json experiment = Json::parse(bytesOf(bench / "r/experiment.json"));
  CHECK((experiment["planned"] == 3 && experiment["done"] == 2 && experiment["finished"].is_null()));
}

TEST_CASE("an experiment without samples builds trees, renders nothing, and has a report") {
  Bench bench;
  bench.write(
      "spp = []\nrepetitions = 2\nscenes = [{ generator = \"atrium\", triangles = 6000 }]\n"
      "[[builder]]\nname = \"kmeans-r1\"\nset = { kmeans.i = [0, 1] }\n");
  const Ran ran = bench.bench();
  INFO(ran.err);
  REQUIRE(ran.status == 0);
  CHECK(contains(ran.out, "1 scenes × 2 builders × 2 repetitions = 4 runs, trees alone"));
  const Json results = Json::parse(bytesOf(bench / "r/results.json"));
  REQUIRE(results.size() == 4);
  CHECK(results[1]["run"]["key"] == "atrium/kmeans-r1,i=1");
  CHECK(results[1]["builder"]["parameters"]["kmeans.i"] == 1);
  CHECK((results[1]["bvh"]["sah_cost"] > 1 && results[1]["time_ms"]["build"] > 0));
  CHECK_FALSE((results[1].contains("image") || results[1].contains("rays")));
  CHECK(std::filesystem::exists(bench / "r/report.html"));
  CHECK_FALSE(std::filesystem::exists(bench / "r/images"));
}

TEST_CASE("results are never overwritten or mixed with those of another experiment", "[medium]") {
  Bench bench;
  REQUIRE(bench.bench(false).status == 0);
  const std::string journal = bench.journal(), page = bytesOf(bench / "r/experiment.json");
  const Ran again = bench.bench(false);
  CHECK(again.status == 2);
  CHECK(contains(again.err, "r: already holds results; continue with --resume"));
  std::filesystem::remove(bench / "r/report.html");
  const Ran finished = bench.bench();
  CHECK(finished.status == 0);
  CHECK(contains(finished.out, "all of its 36 runs are done; nothing is left to do"));
  CHECK(std::filesystem::exists(bench / "r/report.html"));

  std::vector<std::string> threads = bench.arguments();
  threads[7] = "2";
  const Ran others = runCopse(bench / "", threads);
  CHECK(others.status == 2);
  CHECK(contains(others.err, "cannot resume: the device or its number of threads has changed"));
  for (const char* file : {"small.toml", "small.obj"}) {
    const std::string was = bytesOf(bench / file);
    putBytes(bench / file, was + "# more\n");
    const Ran scene = bench.bench();
    CHECK(scene.status == 2);
    CHECK(contains(scene.err, "cannot resume: a scene's description or mesh has changed"));
    putBytes(bench / file, was);
  }
  bench.write(std::string(smallExperiment) + "[[builder]]\nname = \"hlbvh\"\n");
  const Ran changed = bench.bench();
  CHECK(changed.status == 2);
  CHECK(contains(changed.err, "cannot resume: the configuration has changed"));
  CHECK(bench.journal() == journal);
  CHECK(bytesOf(bench / "r/experiment.json") == page);
  std::string other = page;
  other.replace(other.find("\"commit\": \"") + 11, 4, "0000");
  putBytes(bench / "r/experiment.json", other);
  bench.write(bench.config);
  const Ran commit = bench.bench();
  CHECK(commit.status == 2);
  CHECK(contains(commit.err, "cannot resume: the version of Copse has changed"));
}

TEST_CASE("two processes do not write one folder at a time") {
  Bench bench;
  Journal held((std::filesystem::create_directories(bench / "r"), bench / "r/results.jsonl"));
  CHECK_THROWS_WITH(Journal(bench / "r/results.jsonl"), Contains("another process is writing it"));
}

TEST_CASE("a scene that cannot be made fails its runs, the others are done, and the status is 1", "[medium]") {
  ExperimentFolder folder;
  folder.write(
      "name = \"part\"\nspp = 1\nsize = [16, 12]\nrepetitions = 1\nviews = 1\n"
      "scenes = [{ generator = \"atrium\", triangles = 10 }, \"small.toml\", \"gone.toml\"]\n"
      "[[builder]]\nname = \"lbvh\"\n[[builder]]\nname = \"sah\"\n");
  const Ran ran = runCopse(folder / "", {"bench", "x.toml", "--device", deviceOption(), "--threads", "1"});
  INFO(ran.err);
  CHECK(ran.status == 1);
  CHECK(contains(ran.err, "note: scene gone is left out: no file gone.toml"));
  CHECK(contains(
      ran.err,
      "failed: atrium/nave/lbvh/1, repetition 1: generator 'atrium': expected 5000 to 50000000 triangles, got 10"));
  CHECK(contains(ran.out, "2 of 4 runs done, 2 failed"));
  const Json results = Json::parse(bytesOf(folder / "out/part/results.json"));
  REQUIRE(results.size() == 4);
  CHECK((results[0]["run"]["status"] == "failed" && results[3]["run"]["status"] == "done"));
  CHECK(std::filesystem::exists(folder / "out/part/images/small-front.png") == hasOpenImageIO());
  const Json experiment = Json::parse(bytesOf(folder / "out/part/experiment.json"));
  CHECK((experiment["done"] == 2 && experiment["failed"] == 2 && experiment["left_out"].size() == 1));
}
