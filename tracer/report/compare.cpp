// Two folders of results side by side: before and after, CPU and GPU, this machine and that. Runs are matched by scene,
// view, method and samples per pixel; a ratio counts only where the two ranges of repetitions do not overlap.
#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <map>
#include <tuple>

#include "builder/base/error.h"
#include "builder/base/whole_file.h"
#include "tracer/report/bars.h"
#include "tracer/report/figures.h"
#include "tracer/report/gnuplot.h"
#include "tracer/report/html.h"
#include "tracer/report/plot.h"
#include "tracer/report/report.h"

namespace copse::report {

namespace {

struct Quantity {
  const char *name, *column;
  double Run::*member;
  bool higherIsBetter;
};
constexpr Quantity quantities[] = {{"SAH cost", "sah_cost", &Run::cost, false},
                                   {"trace speed", "trace_mrays_s", &Run::rate, true},
                                   {"build", "build_ms", &Run::build, false},
                                   {"render", "render_ms", &Run::render, false},
                                   {"time to image", "total_ms", &Run::total, false}};

struct Key {
  std::string scene, label, view;
  int spp;
  auto operator<=>(const Key&) const = default;
};

using Samples = std::map<Key, std::vector<const Run*>>;

Samples byKey(const Loaded& loaded, std::vector<Key>& order) {
  Samples samples;
  for (const Run& run : loaded.runs) {
    if (run.failed) continue;
    const Key key{run.scene, run.label, run.view, run.spp};
    if (!samples.count(key)) order.push_back(key);
    samples[key].push_back(&run);
  }
  return samples;
}

Value valueOf(const std::vector<const Run*>& runs, double Run::*member) {
  std::map<std::string, std::vector<double>> values;
  for (const Run* run : runs)
    if (known(run->*member)) values[""].push_back(run->*member);
  return overViews(values);
}

enum class Verdict { none, single, within, better, worse };

struct Ratio {
  Value a, b;
  double ratio = missing;
  Verdict verdict = Verdict::none;
};

Ratio ratioOf(const Value& a, const Value& b, const Quantity& quantity) {
  Ratio result{a, b};
  if (!a.known() || !b.known() || a.value == 0) return result;
  result.ratio = b.value / a.value;
  if (a.low <= b.high && b.low <= a.high)
    result.verdict = Verdict::within;
  else
    result.verdict = (b.value > a.value) == quantity.higherIsBetter ? Verdict::better : Verdict::worse;
  // A cost is the same each time; a time that was taken once has no spread that one could know.
  const bool once = a.runs < 2 || b.runs < 2;
  if (once && quantity.member != &Run::cost) result.verdict = Verdict::single;
  return result;
}

const char* sign(Verdict verdict) {
  switch (verdict) {
    case Verdict::within:
      return "≈";
    case Verdict::better:
      return "▲";
    case Verdict::worse:
      return "▼";
    case Verdict::single:
      return "?";
    case Verdict::none:
      break;
  }
  return "";
}

const char* word(Verdict verdict) {
  switch (verdict) {
    case Verdict::within:
      return "within the spread";
    case Verdict::better:
      return "better";
    case Verdict::worse:
      return "worse";
    case Verdict::single:
      return "one run";
    case Verdict::none:
      break;
  }
  return "";
}

struct Match {
  Key key;
  std::string builder;        ///< In A.
  std::vector<Ratio> ratios;  ///< One per quantity.
};

std::string csv(const std::vector<Match>& matches) {
  std::string out = csvLine({"scene", "view", "method", "spp", "quantity", "a", "a_low", "a_high", "a_runs", "b",
                             "b_low", "b_high", "b_runs", "b_over_a", "verdict"});
  for (const Match& match : matches)
    for (std::size_t q = 0; q < std::size(quantities); ++q) {
      const Ratio& r = match.ratios[q];
      if (!r.a.known() && !r.b.known()) continue;
      out += csvLine({match.key.scene, match.key.view, match.key.label, std::to_string(match.key.spp),
                      quantities[q].column, csvNumber(r.a.value), csvNumber(r.a.low), csvNumber(r.a.high),
                      std::to_string(r.a.runs), csvNumber(r.b.value), csvNumber(r.b.low), csvNumber(r.b.high),
                      std::to_string(r.b.runs), csvNumber(r.ratio), word(r.verdict)});
    }
  return out;
}

std::string cell(const Ratio& r) {
  if (!known(r.ratio)) return "–";
  return fmt::format("<span class=\"{}\" title=\"A {} ({} to {}), B {} ({} to {}): {}\">{} {}</span>",
                     r.verdict == Verdict::better  ? "better"
                     : r.verdict == Verdict::worse ? "worse"
                                                   : "even",
                     shown(r.a.value), shown(r.a.low), shown(r.a.high), shown(r.b.value), shown(r.b.low),
                     shown(r.b.high), word(r.verdict), shownRatio(r.ratio), sign(r.verdict));
}

/// All pairs, or only those in which something differs by more than the spread.
PlainTable matchTable(const std::vector<Match>& matches, bool changedOnly) {
  PlainTable table;
  table.caption = "B over A of every scene, method, view and number of samples; hover to see both values.";
  table.headers = {"method", "scene", "view", "spp"};
  for (const Quantity& quantity : quantities) table.headers.push_back(quantity.name);
  table.texts = 3;
  const auto changed = [](const Ratio& ratio) {
    return ratio.verdict == Verdict::better || ratio.verdict == Verdict::worse;
  };
  for (const Match& match : matches) {
    if (changedOnly && std::none_of(match.ratios.begin(), match.ratios.end(), changed)) continue;
    std::vector<std::string> row{escape(match.key.label), escape(match.key.scene), escape(match.key.view),
                                 match.key.spp > 0 ? std::to_string(match.key.spp) : ""};
    for (const Ratio& ratio : match.ratios) row.push_back(cell(ratio));
    table.rows.push_back(row);
  }
  return table;
}

/// Geometric means of the ratios of one method, by quantity: a ratio and its inverse cancel out. "" is all methods.
struct Mean {
  std::string label, builder;
  int pairs = 0;
  std::vector<double> ratios;
};

std::vector<Mean> means(const std::vector<Match>& matches) {
  std::vector<Mean> all;
  for (const Match& match : matches)
    if (std::none_of(all.begin(), all.end(), [&](const Mean& mean) { return mean.label == match.key.label; }))
      all.push_back({match.key.label, match.builder, 0, {}});
  std::stable_sort(all.begin(), all.end(),
                   [](const Mean& a, const Mean& b) { return builderRank(a.builder) < builderRank(b.builder); });
  if (all.size() > 1) all.push_back({"", "", 0, {}});
  for (Mean& mean : all) {
    for (std::size_t q = 0; q < std::size(quantities); ++q) {
      double sum = 0;
      int count = 0;
      for (const Match& match : matches) {
        const double ratio = match.ratios[q].ratio;
        if ((!mean.label.empty() && match.key.label != mean.label) || !known(ratio) || ratio <= 0) continue;
        sum += std::log(ratio);
        ++count;
      }
      mean.ratios.push_back(count ? std::exp(sum / count) : missing);
    }
    for (const Match& match : matches) mean.pairs += mean.label.empty() || match.key.label == mean.label;
  }
  return all;
}

PlainTable meansTable(const std::vector<Mean>& all) {
  PlainTable table;
  table.caption = "Geometric mean of B over A of each method, over its scenes, views and numbers of samples.";
  table.headers = {"method", "pairs"};
  for (const Quantity& quantity : quantities) table.headers.push_back(quantity.name);
  for (const Mean& mean : all) {
    std::vector<std::string> row{mean.label.empty() ? "<b>all</b>" : escape(mean.label), std::to_string(mean.pairs)};
    for (const double ratio : mean.ratios) row.push_back(known(ratio) ? shownRatio(ratio) : "–");
    table.rows.push_back(row);
  }
  return table;
}

Figure meansFigure(const std::vector<Mean>& all) {
  Figure figure{"B over A", "Geometric means of each method. The dashed line is 1: nothing changed.", {}};
  for (const std::size_t q : {std::size_t{2}, std::size_t{1}, std::size_t{4}}) {
    BarGroup group{"", {}};
    for (const Mean& mean : all)
      if (known(mean.ratios[q]) && !mean.label.empty())
        group.bars.push_back({quantities[q].name, mean.label, builderColor(mean.builder), mean.ratios[q],
                              mean.ratios[q], mean.ratios[q]});
    if (!group.bars.empty() && group.bars.size() <= 40)
      figure.panels.push_back(
          barPanel(fmt::format("compare-{}", slug(quantities[q].name)), quantities[q].name,
                   quantities[q].higherIsBetter ? "B over A, longer is better" : "B over A, shorter is better",
                   fmt::format("{} of B over A for each method", quantities[q].name), {group}, true,
                   {"quantity", "method", "b_over_a", "b_over_a_low", "b_over_a_high"}));
  }
  return figure;
}

std::string onlyIn(const char* which, const std::vector<Key>& order, const Samples& other) {
  std::string names;
  int count = 0;
  for (const Key& key : order) {
    if (other.count(key)) continue;
    if (++count <= 12)
      names +=
          fmt::format("{}{} / {} / {} / {} spp", names.empty() ? "" : "; ", key.scene, key.view, key.label, key.spp);
  }
  if (count == 0) return "";
  return fmt::format("<p>Only in {}: {}{}.</p>\n", which, escape(names),
                     count > 12 ? fmt::format(" and {} more", count - 12) : "");
}

std::string sideHtml(const char* name, const Results& results) {
  return fmt::format("<h3>{}: {}</h3>\n<p><code>{}</code></p>\n{}", name, escape(results.loaded.experiment.title),
                     escape(results.loaded.source), measuredFacts(results));
}

/// Warnings about what makes A and B less comparable than they look.
std::string unlike(const Loaded& a, const Loaded& b) {
  std::map<Key, const Run*> ofA;
  for (const Run& run : a.runs)
    if (!run.failed) ofA.emplace(Key{run.scene, run.label, run.view, run.spp}, &run);
  bool size = false, settings = false;
  std::map<std::string, std::pair<double, double>> triangles;
  for (const Run& run : b.runs) {
    const auto found = ofA.find({run.scene, run.label, run.view, run.spp});
    if (run.failed || found == ofA.end()) continue;
    const Run& other = *found->second;
    size = size || run.width != other.width || run.height != other.height;
    settings = settings || run.settings != other.settings;
    if (known(run.triangles) && known(other.triangles) && run.triangles != other.triangles)
      triangles.emplace(run.scene, std::pair(other.triangles, run.triangles));
  }
  std::string out;
  const auto warn = [&](const std::string& text) { out += "<p class=\"warning\">" + text + "</p>\n"; };
  for (const auto& [scene, counts] : triangles)
    warn(fmt::format("{} has {} triangles in A and {} in B, so none of its results are comparable.", escape(scene),
                     shownCount(counts.first), shownCount(counts.second)));
  if (size)
    warn(
        "The images of A and B differ in size: times and ray counts of renders are not comparable, costs and builds "
        "are.");
  if (settings)
    warn(
        "A and B were rendered with different settings, listed below: times and ray counts of renders are not "
        "comparable.");
  return out;
}

}  // namespace

}  // namespace copse::report

namespace copse {

ReportFiles writeComparison(const std::string& a, const std::string& b, const std::string& output) {
  using namespace report;
  const Results sideA = aggregate(load(a)), sideB = aggregate(load(b));
  std::vector<Key> orderA, orderB;
  const Samples ofA = byKey(sideA.loaded, orderA), ofB = byKey(sideB.loaded, orderB);
  std::vector<Match> matches;
  for (const Key& key : orderA) {
    const auto found = ofB.find(key);
    if (found == ofB.end()) continue;
    Match match{key, ofA.at(key).front()->builder, {}};
    for (const Quantity& quantity : quantities)
      match.ratios.push_back(
          ratioOf(valueOf(ofA.at(key), quantity.member), valueOf(found->second, quantity.member), quantity));
    matches.push_back(match);
  }
  const std::filesystem::path folder(output);
  std::error_code failed;
  std::filesystem::create_directories(folder, failed);
  if (failed) throw InputError(fmt::format("-o {}: {}", output, failed.message()));
  ReportFiles files;
  const std::vector<Mean> all = means(matches);
  std::vector<Figure> figures{meansFigure(all)};
  if (figures.front().panels.empty()) figures.clear();
  files.note = drawAll(figures, output);
  for (const Figure& figure : figures)
    for (const Panel& panel : figure.panels) files.figures += !panel.svg.empty();

  std::string body =
      "<header><h1>Two results side by side</h1>\n<p class=\"about\">B over A: below 1 B is lower. ▲ B is better, ▼ B "
      "is worse, ≈ the ranges of repetitions overlap, so the difference is within the spread; ? one of the two ran "
      "only once, so its spread is unknown.</p>\n";
  body += unlike(sideA.loaded, sideB.loaded);
  if (!files.note.empty()) body += fmt::format("<p class=\"warning\">{}</p>\n", escape(files.note));
  body += "</header>\n<main>\n";
  if (matches.empty()) {
    body += "<p class=\"warning\">No run of A has a run of B of the same scene, view, method and samples.</p>\n";
  } else {
    body += "<h2>By method</h2>\n" + meansTable(all).html();
    if (files.figures > 0) body += figureHtml(figures.front());
    PlainTable changed = matchTable(matches, true);
    changed.caption = "Pairs in which something differs by more than the spread. " + changed.caption;
    body += "<h2>What changed</h2>\n" +
            (changed.rows.empty() ? "<p>No difference exceeds the spread.</p>\n" : foldedWhereLong(changed));
    body += "<h2>All pairs</h2>\n" + foldedWhereLong(matchTable(matches, false));
  }
  body += onlyIn("A", orderA, ofB) + onlyIn("B", orderB, ofA);
  body += "<h2>What was measured</h2>\n" + sideHtml("A", sideA) + sideHtml("B", sideB) +
          "</main>\n<footer>Made by <code>copse report A B</code>; <a href=\"compare.csv\">compare.csv</a> has all "
          "values.</footer>\n";
  writeWholeFile((folder / "compare.csv").string(), csv(matches));
  files.page = (folder / "report.html").string();
  writeWholeFile(files.page, document("Two results side by side", body));
  return files;
}

}  // namespace copse
