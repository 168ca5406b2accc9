// Wavefront MTL, read line by line: what is not there has to be told from what is 0, which libraries do not tell, and
// what a Lambertian tracer cannot show is remarked on. Only Kd, Ke and map_Kd are followed. Nothing in a library is an
// error, since no geometry is at stake.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <unordered_map>

#include "builder/base/error.h"
#include "builder/base/files.h"
#include "builder/base/text.h"
#include "tracer/scene/io/checked_lines.h"
#include "tracer/scene/io/file_finder.h"
#include "tracer/scene/io/map_line.h"
#include "tracer/scene/io/mesh.h"

namespace copse {
namespace {

/// Whatever case they are written in. `map` and `amount` say what a diffuse surface does not show; `harmless` ones say
/// nothing without those.
enum class Key { newmtl, kd, ke, mapKa, mapKd, mapKe, d, tr, ks, illum, amount, opacityMap, map, harmless, unknown };

Key keyOf(std::string_view word) {
  static const std::unordered_map<std::string, Key> keys = [] {
    std::unordered_map<std::string, Key> of = {{"newmtl", Key::newmtl}, {"kd", Key::kd},       {"ke", Key::ke},
                                               {"map_kd", Key::mapKd},  {"d", Key::d},         {"tr", Key::tr},
                                               {"ks", Key::ks},         {"illum", Key::illum}, {"map_ka", Key::mapKa}};
    for (const char* key : {"map_ke", "map_emissive", "map_emission"}) of[key] = Key::mapKe;
    for (const char* key : {"map_d", "map_tr", "map_opacity"}) of[key] = Key::opacityMap;
    for (const char* key : {"map_ks", "map_tf", "map_pr", "map_pm", "map_ps", "map_pc", "map_bump", "bump", "norm",
                            "map_kn", "disp", "map_disp", "decal", "map_decal", "refl", "map_refl"})
      of[key] = Key::map;
    for (const char* key : {"pm", "ps", "pc"}) of[key] = Key::amount;
    for (const char* key : {"ka", "ns", "ni", "tf", "km", "pr", "pcr", "aniso", "anisor", "sharpness", "map_ns",
                            "map_ni", "map_pcr", "map_aat"})
      of[key] = Key::harmless;
    return of;
  }();
  const auto found = keys.find(lowered(word.substr(0, 16)));
  return found == keys.end() ? Key::unknown : found->second;
}

/// The words in front of a comment.
std::vector<std::string_view> wordsOf(std::string_view text) {
  std::vector<std::string_view> words;
  for (std::string_view word = nextWord(text); !word.empty() && word.front() != '#'; word = nextWord(text))
    words.push_back(word);
  return words;
}

class MtlReader {
 public:
  MtlReader(const std::string& file, const std::string& text, Scene& scene)
      : file_(file), lines_(file, text, [this](std::string& line) { take(line); }), scene_(scene), finder_(file) {}

  void read();

 private:
  /// What the lines since newmtl say that is no part of a Material.
  struct Said {
    std::optional<double> d, tr, illum;
    bool mapKe = false, mapKa = false, hasKs = false;
    std::string notShown;           ///< Keys of what a diffuse surface lacks.
    int line = 0, opacityLine = 0;  ///< Of the first of those keys; of d, or else Tr.
  };

  void take(std::string& line);
  void takeKey(Key key, std::string_view word, std::string_view rest);
  void takeColour(std::string_view key, std::string_view rest, vec3& colour);
  void takeMap(std::string_view key, std::string_view rest);
  std::optional<double> amount(std::string_view key, std::string_view rest);
  void notShown(std::string_view key);
  void finish();
  int texture(const std::string& path);
  std::string here(int line = 0) const { return fmt::format("{}:{}", file_, line ? line : lines_.lineNumber()); }
  Material& material() { return scene_.materials.back(); }
  /// Of the material; the text is "FILE:LINE: what".
  void remark(const std::string& kind, const std::string& what, int line = 0) {
    material().remarks.push_back({kind, fmt::format("{}: {}", here(line), what)});
  }

  std::string file_;
  CheckedLines lines_;
  Scene& scene_;
  FileFinder finder_;
  std::unordered_map<std::string, int> textureOf_;  ///< By file, of this library.
  bool hasMaterial_ = false;
  Said said_;
};

void MtlReader::takeColour(std::string_view key, std::string_view rest, vec3& colour) {
  const std::vector<std::string_view> words = wordsOf(rest);
  const auto ignored = [&](const std::string& why) {
    remark(fmt::format("ignored {}", key), fmt::format("ignored {} of '{}': {}", key, material().name, why));
  };
  if (!words.empty() && (words[0] == "spectral" || words[0] == "xyz"))
    return ignored(fmt::format("'{}' is not supported", words[0]));
  double rgb[3] = {};
  for (std::size_t i = 0; i < std::min<std::size_t>(words.size(), 3); ++i) {
    if (!parseNumber(words[i], rgb[i])) return ignored(fmt::format("'{}' is not a number", words[i].substr(0, 40)));
    if (!(std::abs(rgb[i]) <= 1e30)) return ignored(fmt::format("colour '{}' is not finite", words[i].substr(0, 40)));
  }
  if (words.size() != 1 && words.size() < 3)
    return ignored(fmt::format("expected three numbers, got {}", words.size()));
  if (words.size() == 1) rgb[2] = rgb[1] = rgb[0];
  // A surface that reflects more than it receives never gets dark.
  const double max = key == "Kd" ? 1 : 1e30;
  bool clamped = false;
  for (int c = 0; c < 3; ++c) {
    colour[c] = static_cast<float>(std::clamp(rgb[c], 0.0, max));
    clamped |= !(rgb[c] >= 0 && rgb[c] <= max);
  }
  if (clamped)
    remark(fmt::format("clamped {}", key),
           fmt::format("clamped {} of '{}' to {}", key, material().name, key == "Kd" ? "0 … 1" : "0 or more"));
}

std::optional<double> MtlReader::amount(std::string_view key, std::string_view rest) {
  double value = 0, max = 0;
  bool any = false;
  for (const std::string_view word : wordsOf(rest)) {
    if (!any && (word == "-halo" || word == "spectral" || word == "xyz")) continue;
    if (!parseNumber(word, value) || !std::isfinite(value)) {
      remark(fmt::format("ignored {}", key),
             fmt::format("ignored {} of '{}': expected a number, got '{}'", key, material().name, word.substr(0, 40)));
      return {};
    }
    max = any ? std::max(max, value) : value;
    any = true;
  }
  return any ? std::optional(max) : std::nullopt;
}

void MtlReader::notShown(std::string_view key) {
  if (said_.notShown.empty()) said_.line = lines_.lineNumber();
  if (said_.notShown.size() < 100) said_.notShown += (said_.notShown.empty() ? "" : ", ") + std::string(key);
}

int MtlReader::texture(const std::string& path) {
  const auto [place, isNew] = textureOf_.try_emplace(path, static_cast<int>(scene_.textures.size()));
  if (isNew) scene_.textures.emplace_back().file = path;
  return place->second;
}

void MtlReader::takeMap(std::string_view key, std::string_view rest) {
  const MapLine map = readMapLine(rest, [this](std::string_view name) { return finder_.find(name).has_value(); });
  const std::string& name = material().name;
  for (const std::string& option : map.ignored)
    remark("ignored option " + option.substr(0, option.find(' ')),
           fmt::format("ignored unsupported texture option {} of '{}'", option.substr(0, 80), name));
  if (map.file.empty()) return remark("ignored map", fmt::format("ignored {} of '{}': it names no file", key, name));
  const std::optional<FoundFile> found = finder_.find(map.file);
  if (found && found->guessed)
    remark("guessed texture", fmt::format("no texture {}; using {}", map.file.substr(0, 200), found->path));
  material().texture = texture(found ? found->path : finder_.place(map.file));
  material().uvScale = map.scale;
  material().uvOffset = map.offset;
}

void MtlReader::takeKey(Key key, std::string_view word, std::string_view rest) {
  switch (key) {
    case Key::kd:
      return takeColour("Kd", rest, material().kd);
    case Key::ke:
      return takeColour("Ke", rest, material().ke);
    case Key::mapKd:
      return takeMap("map_Kd", rest);
    case Key::mapKa:  // Most programs that write it give map_Kd the same file.
      said_.mapKa = true;
      return;
    case Key::mapKe:
      said_.mapKe = true;
      return remark("ignored map_Ke", fmt::format("ignored {} of '{}', which does not shine", word, material().name));
    case Key::opacityMap:
      return remark("ignored map_d", fmt::format("ignored {} of '{}', which is opaque", word, material().name));
    case Key::d:
      said_.d = amount("d", rest);
      said_.opacityLine = lines_.lineNumber();
      return;
    case Key::tr:
      said_.tr = amount("Tr", rest);
      if (!said_.d) said_.opacityLine = lines_.lineNumber();
      return;
    case Key::illum:
      said_.illum = amount("illum", rest);
      return;
    case Key::ks:
      said_.hasKs = amount("Ks", rest).value_or(0) > 0;
      return;
    case Key::amount:
      if (amount(word, rest).value_or(0) > 0) notShown(word);
      return;
    case Key::map:
      return notShown(word);
    default:
      return;
  }
}

/// What is known once all of a material's lines are.
void MtlReader::finish() {
  if (!hasMaterial_) return;
  if (said_.mapKe) material().ke = vec3(0);  // The whole surface would shine where the map has one spot that does.
  const std::string& name = material().name;
  if (said_.d ? *said_.d < 1 : said_.tr.value_or(0) > 0) {
    // Programs do not agree whether Tr is 1 - d or d, and d 0 is more often a mistake than an invisible surface.
    const std::string what = said_.d ? fmt::format("d {:g}", *said_.d) : fmt::format("Tr {:g}", *said_.tr);
    remark("ignored d", fmt::format("ignored {} of '{}', which is opaque", what, name), said_.opacityLine);
  }
  const double illum = said_.illum.value_or(2);
  if (said_.hasKs && illum != 0 && illum != 1) notShown("Ks");
  if (illum >= 3 && illum <= 9) notShown(fmt::format("illum {:g}", illum));
  if (said_.mapKa && material().texture < 0) notShown("map_Ka");
  if (!said_.notShown.empty())
    remark("not shown", fmt::format("ignored {} of '{}': surfaces are diffuse", said_.notShown, name), said_.line);
  said_ = {};
}

void MtlReader::take(std::string& line) {
  std::string_view rest = line;
  const std::string_view word = nextWord(rest);
  const Key key = keyOf(word);
  const auto lineRemark = [&](const std::string& kind, const std::string& what) {
    scene_.remarks.push_back({kind, fmt::format("{}: {}", here(), what)});
  };
  if (key == Key::newmtl) {
    finish();
    hasMaterial_ = true;
    scene_.materials.push_back(greyMaterial(std::string(trim(rest))));  // Grey unless it says otherwise.
    if (material().name.empty()) lineRemark("newmtl without a name", "newmtl without a name");
  } else if (key == Key::unknown) {
    if (!word.empty() && word.front() != '#')
      lineRemark("unknown MTL key", fmt::format("ignored unknown MTL keyword '{}'", word.substr(0, 40)));
  } else if (!hasMaterial_) {
    lineRemark("key before newmtl", fmt::format("ignored {} before the first newmtl", word));
  } else {
    takeKey(key, word, rest);
  }
  line.clear();
}

void MtlReader::read() {
  try {
    lines_.sgetc();  // Each line is taken when it is checked and nothing of it is left, so this goes to the file's end.
  } catch (const InputError&) {
    finish();
    throw;
  }
  finish();
}

}  // namespace

void readMaterials(const std::string& file, Scene& scene) {
  const std::string text = readFile(file);
  MtlReader(file, text, scene).read();
}

}  // namespace copse
