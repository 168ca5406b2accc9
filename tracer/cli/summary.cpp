// The summary's tables.
#include "tracer/cli/summary.h"

#include <fmt/format.h>

#include "builder/base/text.h"
#include "tracer/cli/print.h"
#include "tracer/integrators/phases.h"

namespace copse::cli {

namespace {

void row(const std::string& name, double ms, const std::string& note = "") {
  print("{:<28}{:>12.2f}{}{}\n", name, ms, note.empty() ? "" : "   ", note);
}

std::string rateNote(uint64_t rays, double rate) {
  if (rate < 0) return rays ? grouped(rays) + " rays" : "";
  return fmt::format("{} rays, {:.2f} Mrays/s", grouped(rays), rate);
}

}  // namespace

void printHead(const RunRecord& record) {
  print("scene    {}, {} triangles, {} emitters\n", record.sceneName, grouped(record.triangles),
        grouped(record.emitters));
  print("device   {}: {}{}\n", record.device.kindName(), record.device.name,
        record.device.isCuda() ? "" : fmt::format(", {} threads", record.device.threads));
  if (!record.tree) return;
  if (!record.tree->statistics) {
    print("tree     {}: in its own format, {:.1f} MB\n", record.builder, record.tree->bytes * 1e-6);
    return;
  }
  const TreeStatistics& tree = *record.tree->statistics;
  std::string builder = record.builder;
  for (const std::string& optimiser : record.optimisers) builder += " + " + optimiser;
  const std::string children = tree.arity > 2 ? fmt::format(" of up to {} children", tree.arity) : "";
  print("tree     {}: SAH cost {:.2f}, {} nodes{}, {} leaves of at most {}, depth {}, {:.1f} MB\n", builder,
        tree.sahCost, grouped(tree.nodes), children, grouped(tree.leaves), tree.maxLeafTriangles, tree.depth,
        record.tree->bytes * 1e-6);
  if (record.tree->endPointOverlap) print("overlap  {:.3f} at end points\n", *record.tree->endPointOverlap);
}

void printTraversal(const TraversalRecord& traversal) {
  print("\n{:<28}{:>12}{:>12}\n", "visits per ray", "nodes", "triangles");
  for (const auto& [name, counts] :
       {std::pair{"  primary", &traversal.primary}, std::pair{"  bounce", &traversal.bounce},
        std::pair{"  shadow", &traversal.shadow}})
    if (*counts) print("{:<28}{:>12.2f}{:>12.2f}\n", name, (*counts)->nodes, (*counts)->triangles);
}

void printBuildPhases(const RunRecord& record) {
  print("{:<28}{:>12}\n", "", "ms");
  row("load", record.loadMs);
  row("build", record.buildMs);
  for (const PhaseTime& phase : record.buildPhases) row("  " + phase.name, phase.ms);
}

void printSummary(const RunRecord& record, const std::string& also) {
  printHead(record);
  if (record.image) {
    const RenderSettings& s = record.image->settings;
    print("image    {}{}: view {}, {}x{}, {:.6g} spp\n\n", record.image->file, also, record.image->view, s.width,
          s.height, record.image->samplesDone);
  }
  if (record.earlier)
    print("resumed  from {:.6g} spp, by {} in {:.2f} ms of build + render, which the figures below leave out\n\n",
          record.earlier->samplesDone,
          record.earlier->runs == 1 ? "one run" : fmt::format("{} runs", record.earlier->runs),
          record.earlier->buildMs + record.earlier->renderMs);
  printBuildPhases(record);
  row("render", record.renderMs);
  const RayRates rates = rayRates(record);
  const RayCounts rays = record.rays.value_or(RayCounts{});
  for (const PhaseTime& phase : record.renderPhases) {
    std::string note;
    if (phase.group == &groups::primaryRays) note = rateNote(rays.primary, rates.primary);
    if (phase.group == &groups::bounceRays) note = rateNote(rays.bounce, rates.bounce);
    if (phase.group == &groups::shadowRays) note = rateNote(rays.shadow, rates.shadow);
    row("  " + phase.name, phase.ms, note);
  }
  row("time to image", record.totalMs(),
      "build + render; " + rateNote(rays.primary + rays.bounce + rays.shadow, rates.all));
  if (record.traversal) printTraversal(*record.traversal);
}

}  // namespace copse::cli
