// A program, not a test: builds, traces and renders one scene with this project's trees and with Embree, the baseline,
// in turn in one process, several times, and prints medians and ratios. Absolute times of a busy machine mean little;
// the ratios of neighbouring measurements are reliable.
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>

#include "builder/base/error.h"
#include "builder/base/statistics.h"
#include "builder/build.h"
#include "builder/parallel/timeline.h"
#include "tests/benchmarks/bench_ray_sets.h"
#include "tests/support/timing.h"
#include "tracer/accel/tracers.h"
#include "tracer/cli/command_line.h"
#include "tracer/generators/generators.h"
#include "tracer/image/image_io.h"
#include "tracer/integrators/path/path_tracer.h"

using namespace copse;
using namespace copse::test;
using namespace copse::baselines;
using nlohmann::json;

namespace {

struct Options {
  std::string scene, generator = "atrium", view, jsonFile;
  std::vector<std::string> builders{"sah", "lbvh"};
  std::vector<std::string> tracers{"auto"};
  std::vector<std::string> qualities{"low", "medium", "high"};
  uint32_t triangles = 0;
  int width = 1024, height = 768, spp = 8, repeat = 5, renders = 1, threads = 0;
  uint64_t seed = 1;
};

/// The median of the quotients.
double medianRatio(const std::vector<double>& a, const std::vector<double>& b) {
  std::vector<double> ratios;
  for (std::size_t i = 0; i < a.size(); ++i) ratios.push_back(a[i] / b[i]);
  return median(ratios);
}

/// A builder or baseline that is measured: how it is built, and what traces its tree.
struct Contender {
  std::string name;
  std::function<double(int threads)> build;  ///< Milliseconds; keeps the last tree.
  std::function<const RayTracer&()> tracer;
};

/// Runs every contender in turn, `repeat` times, the first turn being a warm-up; seconds[contender][turn].
std::vector<std::vector<double>> inTurn(std::size_t contenders, int repeat,
                                        const std::function<double(std::size_t)>& run) {
  std::vector<std::vector<double>> seconds(contenders);
  for (int turn = -1; turn < repeat; ++turn)
    for (std::size_t c = 0; c < contenders; ++c) {
      const double s = run(c);
      if (turn >= 0) seconds[c].push_back(s);
    }
  return seconds;
}

struct CopseTree {
  Bvh bvh;
  std::unique_ptr<TreeTracer> tracer;
};

class Bench {
 public:
  Bench(const Options& options, Scene&& scene)
      : options_(options),
        scene_(std::move(scene)),
        cpu_(openDevice("cpu", options.threads)),
        camera_(findCamera(scene_, options.view)),
        triangles_{scene_.positions.data(), scene_.triangles.data(), static_cast<uint32_t>(scene_.triangles.size())} {
    for (const std::string& name : options.builders)
      for (const std::string& tracer : options.tracers) addCopse(name, tracer);
    for (const std::string& name : options.qualities) addEmbree(name);
    reference_ = contenders_.size();
    for (std::size_t c = 0; c < contenders_.size(); ++c)
      if (contenders_[c].name == "embree-medium") reference_ = c;
    if (reference_ == contenders_.size())
      throw InputError("--qualities: expected medium among them, to which ratios are taken");
  }

  json run() {
    json out{{"scene", scene_.name},      {"triangles", triangles_.count}, {"view", camera_.name},
             {"threads", cpu_.threads},   {"device", cpu_.name},           {"width", options_.width},
             {"height", options_.height}, {"spp", options_.spp},           {"repeat", options_.repeat}};
    fmt::print("{}: {} triangles, view {}, {} threads of {}\n", scene_.name, triangles_.count, camera_.name,
               cpu_.threads, cpu_.name);
    out["build_ms"] = builds();
    out["mrays_per_s"] = traces();
    if (options_.renders > 0) out["render"] = renders();
    return out;
  }

 private:
  void addCopse(const std::string& name, const std::string& tracer) {
    auto tree = std::make_shared<CopseTree>();
    const BuilderEntry& builder = findBuilder(name);
    contenders_.push_back({tracer == "auto" ? name : name + "," + tracer,
                           [=, this, &builder](int threads) {
                             Device device = cpu_;
                             device.threads = threads;
                             return millisecondsOf([&] {
                               tree->bvh = buildBvh(device, triangles_, builder, withPreset(builder, {}));
                               tree->tracer = makeTracer(device, tree->bvh, triangles_, tracer);
                             });
                           },
                           [tree]() -> const RayTracer& { return *tree->tracer; }});
  }

  void addEmbree(const std::string& name) {
    const TreeSource source = findTreeSource("embree-" + name);
    auto tracer = std::make_shared<std::unique_ptr<TreeTracer>>();
    contenders_.push_back({source.name(),
                           [=, this](int threads) {
                             Device device = cpu_;
                             device.threads = threads;
                             tracer->reset();
                             *tracer = source.tracer().make(device, triangles_, {}, source.ownTree());
                             return millisecondsOf([&] { (*tracer)->build(device, {}, triangles_); });
                           },
                           [tracer]() -> const RayTracer& { return **tracer; }});
  }

  json builds() {
    json out;
    fmt::print("\nbuild, ms (traversal layout included)\n");
    for (const int threads : cpu_.threads > 1 ? std::vector<int>{1, cpu_.threads} : std::vector<int>{1}) {
      const auto ms = inTurn(contenders_.size(), std::min(options_.repeat, 3),
                             [&](std::size_t c) { return contenders_[c].build(threads); });
      for (std::size_t c = 0; c < contenders_.size(); ++c) {
        fmt::print("  {:<14} {} threads {:9.1f}   {:.2f} of Embree medium\n", contenders_[c].name, threads,
                   median(ms[c]), medianRatio(ms[c], ms[reference_]));
        out[contenders_[c].name][std::to_string(threads)] = median(ms[c]);
      }
    }
    return out;
  }

  json traces() {
    const std::vector<RaySet> sets = raySets(cpu_, scene_, camera_, options_.width, options_.height,
                                             contenders_[reference_].tracer(), options_.seed);
    std::vector<Hit> hits(sets[0].rays.size());
    std::vector<uint32_t> occluded(sets[0].rays.size());
    json out;
    fmt::print("\nrays, Mrays/s, and the ratio to Embree medium\n  {:<14}", "");
    for (const RaySet& set : sets) fmt::print("{:>9} ({:>6})", set.name, set.rays.size());
    fmt::print("\n");
    std::vector<std::string> rows(contenders_.size());
    for (const RaySet& set : sets) {
      const uint32_t n = static_cast<uint32_t>(set.rays.size());
      const auto ms = inTurn(contenders_.size(), options_.repeat, [&](std::size_t c) {
        const RayTracer& tracer = contenders_[c].tracer();
        return millisecondsOf([&] {
          if (set.anyHit)
            tracer.any(cpu_, "any", n, set.rays.data(), occluded.data());
          else
            tracer.closest(cpu_, "closest", n, set.rays.data(), hits.data());
        });
      });
      for (std::size_t c = 0; c < contenders_.size(); ++c) {
        const double mrays = n / median(ms[c]) / 1000, ratio = medianRatio(ms[reference_], ms[c]);
        rows[c] += fmt::format("{:9.2f} x {:4.2f} ", mrays, ratio);
        out[contenders_[c].name][set.name] = {{"mrays_per_s", mrays}, {"of_embree_medium", ratio}};
      }
    }
    for (std::size_t c = 0; c < contenders_.size(); ++c) fmt::print("  {:<14}{}\n", contenders_[c].name, rows[c]);
    return out;
  }

  json renders() {
    const auto there = uploadScene(cpu_, scene_);
    RenderSettings settings;
    settings.width = options_.width, settings.height = options_.height, settings.spp = options_.spp;
    std::vector<PathResult> results(contenders_.size());
    std::vector<std::vector<double>> traceMs(contenders_.size());
    const auto ms = inTurn(contenders_.size(), options_.renders, [&](std::size_t c) {
      Timeline timeline(cpu_);
      const Device device = cpu_.recording(timeline);
      const double all =
          millisecondsOf([&] { results[c] = renderPath(device, *there, contenders_[c].tracer(), camera_, settings); });
      double tracing = 0;
      for (const PhaseTime& phase : timeline.phases())
        if (phase.name.rfind("trace ", 0) == 0) tracing += phase.ms;
      traceMs[c].push_back(tracing);
      return all;
    });
    json out;
    fmt::print("\nthe same path tracer, {}x{}, {} spp\n", settings.width, settings.height, settings.spp);
    auto rays = [&](std::size_t c) {
      const RayCounts& r = results[c].rays;
      return static_cast<double>(r.primary + r.bounce + r.shadow);
    };
    for (std::vector<double>& times : traceMs) times.erase(times.begin());  // The warm-up turn.
    for (std::size_t c = 0; c < contenders_.size(); ++c) {
      const double rate = rays(c) / median(traceMs[c]), ratio = medianRatio(traceMs[reference_], traceMs[c]);
      fmt::print(
          "  {:<14} {:8.2f} s, {:.1f} M rays, tracing {:6.2f} Mrays/s x {:.2f}, all of it {:6.2f} Mrays/s x {:.2f}\n",
          contenders_[c].name, median(ms[c]) / 1000, rays(c) / 1e6, rate / 1000, ratio, rays(c) / median(ms[c]) / 1000,
          medianRatio(ms[reference_], ms[c]));
      out[contenders_[c].name] = {{"ms", median(ms[c])},
                                  {"rays", rays(c)},
                                  {"tracing_mrays_per_s", rate / 1000},
                                  {"tracing_of_embree_medium", ratio},
                                  {"of_embree_medium", medianRatio(ms[reference_], ms[c])}};
    }
    return out;
  }

  Options options_;
  Scene scene_;
  Device cpu_;
  const Camera& camera_;
  TrianglesView triangles_;
  std::vector<Contender> contenders_;
  std::size_t reference_ = 0;
};

}  // namespace

int main(int argc, char** argv) {
  Options options;
  copse::cli::Program program("Copse against Embree, the baseline, in turn in one program", "bench_peers");
  program.option("scene", options.scene, "a scene file; otherwise --generator");
  program.option("--generator", options.generator, "atrium by default");
  program.option("--triangles", options.triangles, "for the generator; 0 for its default");
  program.option("--view", options.view);
  program.option("--width", options.width);
  program.option("--height", options.height);
  program.option("--spp", options.spp);
  program.option("--builders", options.builders).delimiter(',');
  program.option("--tracers", options.tracers, "for the builders' trees").delimiter(',');
  program.option("--qualities", options.qualities, "Embree's: low, medium, high").delimiter(',');
  program.option("--threads", options.threads);
  program.option("--repeat", options.repeat);
  program.option("--renders", options.renders, "turns of the path tracer; 0 leaves it out");
  program.option("--json", options.jsonFile);
  if (const auto status = program.parse(argc, argv)) return *status;
  try {
    Scene scene;
    if (options.scene.empty()) {
      const GeneratorEntry& generator = findGenerator(options.generator);
      scene = generator.generate(options.triangles ? options.triangles : generator.defaultTriangles, options.seed);
    } else {
      scene = loadScene(options.scene);
    }
    loadTextures(scene);
    const json out = Bench(options, std::move(scene)).run();
    if (!options.jsonFile.empty()) std::ofstream(options.jsonFile) << out.dump(2) << '\n';
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "error: %s\n", error.what());
    return 3;
  }
}
