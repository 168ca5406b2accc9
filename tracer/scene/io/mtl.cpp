// Wavefront MTL by tinyobjloader: Kd, Ke and map_Kd are what a Lambertian tracer takes from it. Lines are checked and
// made plain before, since tinyobjloader takes what it cannot read for 0.
#include <fmt/format.h>
#include <tiny_obj_loader.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <istream>
#include <map>

#include "builder/base/error.h"
#include "builder/base/files.h"
#include "builder/base/text.h"
#include "tracer/scene/io/checked_lines.h"
#include "tracer/scene/io/mesh.h"

namespace copse {
namespace {

namespace fs = std::filesystem;

class MtlReader {
 public:
  MtlReader(const std::string& file, const std::string& text, Scene& scene)
      : file_(file), lines_(file, text, [this](std::string& line) { check(line); }), scene_(scene) {}

  void read();

 private:
  void check(std::string& line);
  void checkColour(std::string& line, std::string_view key, std::string_view rest);
  std::string withoutOptions(std::string_view rest);
  int texture(std::string name);
  void note(const std::string& what) {
    scene_.notes.push_back(fmt::format("{}:{}: {}", file_, lines_.lineNumber(), what));
  }

  std::string file_;
  CheckedLines lines_;
  Scene& scene_;
  std::string material_;
  std::vector<std::string> names_;  ///< In the order of the file.
};

void MtlReader::checkColour(std::string& line, std::string_view key, std::string_view rest) {
  double rgb[3] = {};
  int count = 0;
  std::string_view word = nextWord(rest);
  if (word == "spectral" || word == "xyz") {
    note(fmt::format("ignored unsupported '{} {}'; the material keeps its default", key, word));
    return line.clear();
  }
  for (; !word.empty() && word.front() != '#'; word = nextWord(rest), ++count) {
    if (count == 3) break;
    if (!parseNumber(word, rgb[count])) lines_.fail(fmt::format("'{}' is not a number", word));
    if (!(std::abs(rgb[count]) <= 1e30)) lines_.fail(fmt::format("colour '{}' is not finite", word));
  }
  if (count != 1 && count != 3) lines_.fail(fmt::format("{}: expected three numbers, got {}", key, count));
  if (count == 1) rgb[2] = rgb[1] = rgb[0];
  // A surface that reflects more than it receives never gets dark.
  const double max = key == "Kd" ? 1 : 1e30;
  const auto clamped = [&](int c) { return std::clamp(rgb[c], 0.0, max); };
  if (clamped(0) != rgb[0] || clamped(1) != rgb[1] || clamped(2) != rgb[2])
    note(fmt::format("clamped {} of '{}' to {}", key, material_, key == "Kd" ? "0 … 1" : "0 or more"));
  line = fmt::format("{} {} {} {}", key, clamped(0), clamped(1), clamped(2));
}

/// The file name of a map_ line, which may have spaces, without the options in front of it.
std::string MtlReader::withoutOptions(std::string_view rest) {
  static const std::map<std::string_view, int> maxArguments = {
      {"-blendu", 1},  {"-blendv", 1}, {"-bm", 1}, {"-boost", 1}, {"-cc", 1}, {"-clamp", 1},  {"-colorspace", 1},
      {"-imfchan", 1}, {"-mm", 2},     {"-o", 3},  {"-s", 3},     {"-t", 3},  {"-texres", 1}, {"-type", 1}};
  for (;;) {
    std::string_view after = rest;
    const std::string_view option = nextWord(after);
    const auto place = maxArguments.find(option);
    if (place == maxArguments.end()) return std::string(trim(rest));
    note(fmt::format("ignored unsupported texture option {}", option));
    rest = after;
    const bool numbers = option == "-o" || option == "-s" || option == "-t" || option == "-mm";
    for (int i = 0; i < place->second; ++i) {
      double value;
      const bool isNumber = parseNumber(nextWord(after), value);
      if (numbers && !isNumber) break;
      rest = after;
    }
  }
}

void MtlReader::check(std::string& line) {
  std::string_view rest = line;
  const std::string_view key = nextWord(rest);
  const bool colour = key == "Kd" || key == "Ke", map = key == "map_Kd" || key == "map_kd";
  if (key == "newmtl") {
    material_ = trim(rest);
    if (material_.empty()) lines_.fail("newmtl without a name");
    // By number: some versions of tinyobjloader end a name at its first blank.
    line = fmt::format("newmtl {}\nKd 0.6 0.6 0.6", names_.size());  // Grey unless it says otherwise.
    names_.push_back(material_);
  } else if (!colour && !map) {
    line.clear();
  } else if (material_.empty()) {
    lines_.fail(fmt::format("{} before the first newmtl", key));
  } else if (colour) {
    checkColour(line, std::string(key), rest);
  } else {
    const std::string name = withoutOptions(rest);
    if (name.empty()) lines_.fail("map_Kd without a file");
    line = "map_Kd " + name;
  }
}

int MtlReader::texture(std::string name) {
  std::replace(name.begin(), name.end(), '\\', '/');
  const std::string path = (fs::path(file_).parent_path() / name).lexically_normal().string();
  for (std::size_t i = 0; i < scene_.textures.size(); ++i)
    if (scene_.textures[i].file == path) return static_cast<int>(i);
  scene_.textures.push_back({path, {}});
  return static_cast<int>(scene_.textures.size()) - 1;
}

void MtlReader::read() {
  std::istream stream(&lines_);
  stream.exceptions(std::ios::badbit);  // So that the check's InputError comes through.
  std::map<std::string, int> index;
  std::vector<tinyobj::material_t> read;
  std::string warning, error;
  tinyobj::LoadMtl(&index, &read, &stream, &warning, &error);
  for (const tinyobj::material_t& m : read) {
    if (m.name.empty()) continue;  // What tinyobjloader makes of a file without a newmtl.
    scene_.materials.push_back({names_.at(std::stoul(m.name)),
                                {m.diffuse[0], m.diffuse[1], m.diffuse[2]},
                                {m.emission[0], m.emission[1], m.emission[2]},
                                m.diffuse_texname.empty() ? -1 : texture(m.diffuse_texname)});
  }
}

}  // namespace

void readMaterials(const std::string& file, Scene& scene) {
  const std::string text = readFile(file);
  MtlReader(file, text, scene).read();
}

}  // namespace copse
