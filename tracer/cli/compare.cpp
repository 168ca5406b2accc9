// copse compare: how two images differ, and whether they exceed given limits.
#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <nlohmann/json.hpp>

#include "builder/base/error.h"
#include "builder/base/whole_file.h"
#include "builder/parallel/device.h"
#include "tracer/cli/commands.h"
#include "tracer/cli/options.h"
#include "tracer/cli/print.h"
#include "tracer/cli/progress.h"
#include "tracer/image/compare.h"
#include "tracer/image/image_io.h"

namespace copse::cli {

namespace {

struct Options {
  std::string a, b, layer, stats, heatmap;
  double maxRmse = -1, maxRelMse = -1;
};

/// False, with a message, where `value` is over its limit. NaN is over every limit.
bool within(const char* option, const char* name, double value, double limit) {
  if (limit < 0 || value <= limit) return true;
  say("error: {} {:.6g} is over {} {:.6g} by {:.6g}\n", name, value, option, limit, value - limit);
  return false;
}

/// An image of the two, and what it was in its file.
struct Side {
  std::string file;
  Image image;
  ImageSource source;
};

/// `layer` of both where both are EXR files that have it. A file of a single layer, as a reference often is, is taken
/// as it is if the other file has `layer`; so is one of a format without layers.
void readBoth(Side& a, Side& b, const std::string& layer) {
  bool found = false;
  const auto wantedOf = [&](const Side& side) -> std::string {
    if (layer.empty() || !isExr(side.file)) return "";
    const ExrHas has = lookForExrLayer(side.file, layer);
    found = found || has.layer;
    return has.layer || has.layers != 1 ? layer : "";
  };
  const std::string wantedA = wantedOf(a), wantedB = wantedOf(b);
  if (!layer.empty() && !found) {
    readImage(a.file, isExr(a.file) ? layer : "");  // Says what there is.
    readImage(b.file, layer);
    throw InputError(fmt::format("--layer {}: neither image has layers", layer));
  }
  a.image = readImage(a.file, wantedA, &a.source);
  b.image = readImage(b.file, wantedB, &b.source);
}

/// What of a file was taken, where that is not simply its RGB.
void printSource(const char* key, const Side& side, nlohmann::ordered_json& json) {
  const ImageSource& source = side.source;
  const auto line = [&](const char* what, const std::string& value) {
    print("{:<12}  {}\n", fmt::format("{}_{}", what, key), value);
    json[fmt::format("{}_{}", what, key)] = value;
  };
  if (!source.layer.empty()) line("layer", source.layer);
  if (!source.isPlain && !source.channels.empty()) line("channels", source.channels);
  if (!source.window.empty()) line("window", source.window);
  if (!source.transfer.empty())
    line("transfer", source.transfer + (source.transfer.ends_with("sRGB") ? ", decoded to linear" : ""));
}

/// Whole numbers end at 1, and light does not.
void noteBeyondOne(const Side& side, const Side& other) {
  if (!other.source.transfer.ends_with("sRGB") || side.source.transfer.ends_with("sRGB")) return;
  const auto count =
      std::ranges::count_if(side.image.pixels, [](const vec3& p) { return p.x > 1 || p.y > 1 || p.z > 1; });
  if (count > 0) say("note: {}: {} pixels are above 1, which {} cannot hold\n", side.file, count, other.file);
}

int run(const Options& options, bool limitRmse, bool limitRelMse) {
  if ((limitRmse && !(options.maxRmse >= 0)) || (limitRelMse && !(options.maxRelMse >= 0)))
    throw InputError("--max-rmse and --max-rel-mse: expected 0 or more");
  checkApart({{"--heatmap", options.heatmap}, {"--stats", options.stats}}, {{"", options.a}, {"", options.b}});
  endOnSignal();
  openDevice("cpu");  // Fails properly where threads cannot be started; OpenMP would end the program with 1.
  if (!options.heatmap.empty()) checkOutput("--heatmap", options.heatmap, ".png");
  checkPng("--heatmap", options.heatmap);
  checkWritable(options.stats);
  Side sideA{options.a, {}, {}}, sideB{options.b, {}, {}};
  readBoth(sideA, sideB, options.layer);
  const Image &a = sideA.image, &b = sideB.image;
  Image map;
  const Difference d = compareImages(a, b, options.heatmap.empty() ? nullptr : &map);

  const std::pair<const char*, double> figures[] = {
      {"rmse", d.rmse},    {"rel_mse", d.relMse}, {"flip", d.flip},          {"max_error", d.maxError},
      {"mean_a", d.meanA}, {"mean_b", d.meanB},   {"block_rms", d.blockRms}, {"block_worst", d.blockWorst}};
  nlohmann::ordered_json json = {
      {"schema", 1},        {"a", options.a},     {"b", options.b},           {"width", a.width},
      {"height", a.height}, {"blocks", d.blocks}, {"bad_pixels", d.badPixels}};
  print("size          {}x{}\n", a.width, a.height);
  printSource("a", sideA, json);
  printSource("b", sideB, json);
  noteBeyondOne(sideA, sideB);
  noteBeyondOne(sideB, sideA);
  for (const auto& [name, value] : figures) {
    print("{:<12}  {:.6g}\n", name, value);
    json[name] = value;
  }
  print("blocks        {}\nbad_pixels    {}\n", d.blocks, d.badPixels);
  if (!options.heatmap.empty()) writePng(options.heatmap, map);
  if (!options.stats.empty())
    writeWholeFile(options.stats, json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n");
  const bool rmse = within("--max-rmse", "rmse", d.rmse, options.maxRmse);
  const bool relMse = within("--max-rel-mse", "rel_mse", d.relMse, options.maxRelMse);
  // The figures leave them out, so no limit covers them.
  const bool bad = d.badPixels > 0 && (limitRmse || limitRelMse);
  if (bad) say("error: {} pixels are not finite in one image or both\n", d.badPixels);
  return rmse && relMse && !bad ? done : failedCheck;
}

}  // namespace

Command addCompare(CommandLine& program) {
  CommandLine command = program.addCommand("compare", "Compare two images");
  auto options = std::make_shared<Options>();
  command.option("A", options->a, "Image: EXR, or PNG and what else OpenImageIO reads").required();
  command.option("B", options->b, "Image to compare it with").required();
  command.option("--layer", options->layer, "Layer or channel of EXR images with several, as ViewLayer.Combined")
      .notEmpty();
  const Option rmse = command.option("--max-rmse", options->maxRmse, "Exit status 1 if rmse is larger");
  const Option relMse = command.option("--max-rel-mse", options->maxRelMse, "Exit status 1 if rel_mse is larger");
  command.option("--stats", options->stats, "FILE.json: the figures").notEmpty();
  command.option("--heatmap", options->heatmap, "FILE.png: map of the visible differences").notEmpty();
  return [=] { return run(*options, rmse.given(), relMse.given()); };
}

}  // namespace copse::cli
