// Tables beside Table 1: trees, rays by kind; and the images.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "builder/base/files.h"
#include "tracer/report/html.h"
#include "tracer/report/page.h"

namespace copse::report {

namespace {

std::string base64(const std::string& bytes) {
  static const char* const digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    uint32_t three = 0;
    for (std::size_t k = 0; k < 3; ++k)
      three = three << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0);
    for (std::size_t k = 0; k < 4; ++k) out += i + k <= bytes.size() ? digits[three >> (18 - 6 * k) & 63] : '=';
  }
  return out;
}

}  // namespace

std::string raysHtml(const Results& results) {
  PlainTable speed, steps;
  speed.caption =
      "Millions of rays per second by kind, and rays per image, from the renders with the highest samples per pixel.";
  steps.caption = "Nodes visited and triangles tested per ray of each kind.";
  for (PlainTable* table : {&speed, &steps}) {
    table->headers = {"method", "scene"};
    table->texts = 2;
    for (const char* unit :
         table == &speed ? std::array{"MRays/s", "rays, millions"} : std::array{"nodes", "triangles"})
      for (const char* kind : rayKinds) table->headers.push_back(fmt::format("{}<br><small>{}</small>", kind, unit));
  }
  for (const Scene& scene : results.scenes)
    for (const Row& row : scene.rows) {
      const bool any = std::any_of(row.rates.begin(), row.rates.end(), [](const Value& v) { return v.known(); });
      if (row.ideal || !any) continue;
      std::vector<std::string> line{escape(row.label), escape(scene.name)};
      for (const Value& rate : row.rates) line.push_back(shown(rate.value));
      for (const Value& rays : row.rays) line.push_back(shown(1e-6 * rays.value));
      speed.rows.push_back(line);
      if (std::none_of(row.nodesPerRay.begin(), row.nodesPerRay.end(), known)) continue;
      line.resize(2);
      for (const double nodes : row.nodesPerRay) line.push_back(shown(nodes));
      for (const double triangles : row.trianglesPerRay) line.push_back(shown(triangles));
      steps.rows.push_back(line);
    }
  return foldedWhereLong(speed) + foldedWhereLong(steps);
}

std::string treesHtml(const Results& results) {
  struct Column {
    const char* title;
    double Row::*member;
    std::string (*text)(double);
  };
  std::vector<Column> columns{{"nodes", &Row::nodes, shownCount},    {"leaves", &Row::leaves, shownCount},
                              {"depth", &Row::depth, shownCount},    {"end-point overlap", &Row::overlap, shown},
                              {"tree", &Row::treeBytes, shownBytes}, {"build peak", &Row::buildPeakBytes, shownBytes}};
  const auto unused = [&](const Column& column) {
    for (const Scene& scene : results.scenes)
      for (const Row& row : scene.rows)
        if (known(row.*column.member)) return false;
    return true;
  };
  columns.erase(std::remove_if(columns.begin(), columns.end(), unused), columns.end());
  if (columns.empty()) return "";
  PlainTable table;
  table.caption =
      "What was built. End-point overlap (Aila, Karras and Laine 2013): area of surfaces inside nodes that do not hold "
      "them, over all area, weighted as the cost is; of two trees of equal cost the one with less of it traces faster.";
  table.headers = {"method", "scene", "SAH cost"};
  table.texts = 2;
  for (const Column& column : columns) table.headers.push_back(column.title);
  for (const Scene& scene : results.scenes)
    for (const Row& row : scene.rows) {
      if (row.ideal) continue;
      std::vector<std::string> line{escape(row.label), escape(scene.name), shown(row.cost.value)};
      for (const Column& column : columns) line.push_back(column.text(row.*column.member));
      table.rows.push_back(line);
    }
  return foldedWhereLong(table);
}

std::string imagesHtml(const Results& results) {
  namespace fs = std::filesystem;
  constexpr std::uintmax_t largest = 1 << 20;
  constexpr std::size_t maxFiles = 60;
  std::error_code ignored;
  std::vector<fs::path> files;
  for (fs::directory_iterator entry(fs::path(results.loaded.folder) / "images", ignored), end; !ignored && entry != end;
       entry.increment(ignored))
    if (extensionOf(entry->path().string()) == ".png" && entry->is_regular_file(ignored) &&
        entry->file_size(ignored) <= largest)
      files.push_back(entry->path());
  std::sort(files.begin(), files.end());
  if (files.size() > maxFiles) files.resize(maxFiles);
  std::string out;
  for (const fs::path& file : files) {
    std::ifstream stream(file, std::ios::binary);
    const std::string bytes{std::istreambuf_iterator<char>(stream), {}};
    const std::string name = escape(file.stem().string());
    out += fmt::format(
        "<figure><img alt=\"Render of {0}\" src=\"data:image/png;base64,{1}\"><figcaption>{0}</figcaption></figure>\n",
        name, base64(bytes));
  }
  return out.empty() ? "" : "<div class=\"images\">\n" + out + "</div>\n";
}

}  // namespace copse::report
