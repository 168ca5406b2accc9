// mtllib and usemtl as they are found in files.
#include "tracer/scene/io/libraries.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <set>
#include <unordered_map>

#include "builder/base/error.h"
#include "builder/base/files.h"
#include "builder/base/text.h"
#include "tracer/scene/io/file_finder.h"

namespace copse {
namespace {

constexpr uint32_t none = ~0u;

/// The files of a line that is not one file: in quotes, or up to a word that ends in ".mtl" or completes a file's name.
std::vector<std::string> splitNames(std::string_view text, FileFinder& finder) {
  std::vector<std::string> names;
  constexpr std::size_t maxNames = 1000, maxWords = 100;  // Each is looked for on the disk.
  while (!(text = trim(text)).empty() && names.size() < maxNames) {
    std::string_view name = text, after;
    if (const std::size_t end = text.find('"', 1); text.front() == '"' && end != std::string_view::npos) {
      name = text.substr(0, end + 1);
      after = text.substr(end + 1);
    } else {
      std::string_view rest = text;
      for (std::size_t words = 0; words < maxWords && !trim(rest).empty(); ++words) {
        nextWord(rest);
        const std::string_view upToHere = text.substr(0, text.size() - rest.size());
        if (extensionOf(std::string(upToHere)) != ".mtl" && !finder.find(upToHere)) continue;
        name = upToHere;
        after = rest;
        break;
      }
    }
    names.emplace_back(name);
    text = after;
  }
  return names;
}

}  // namespace

void readLibrary(const std::string& library, Scene& scene) {
  try {
    readMaterials(library, scene);
  } catch (const InputError& error) {
    scene.remarks.push_back({"broken library", fmt::format("{}; the materials that it lacks are grey", error.what())});
  }
}

void readLibraries(const std::string& file, const std::vector<std::string>& lines, bool needsOne, Scene& scene) {
  FileFinder finder(file);
  std::set<std::string> read;
  std::vector<std::string> missing;
  const auto readFound = [&](const std::string& name, bool guess) {
    const std::optional<FoundFile> found = finder.find(name);
    if (!found || (found->guessed && !guess)) return false;
    if (found->guessed && !read.contains(found->path))
      scene.remarks.push_back(
          {"guessed library", fmt::format("{}: no material library {}; using {}", file, trim(name), found->path)});
    if (read.insert(found->path).second) readLibrary(found->path, scene);
    return true;
  };
  std::set<std::string> seen;  // Some programs repeat the line for every object.
  for (const std::string& line : lines) {
    if (!seen.insert(line).second) continue;
    const std::string plain(withoutComment(line));
    if (plain.empty())
      scene.remarks.push_back({"mtllib without a name", fmt::format("{}: mtllib without a name", file)});
    else if (!readFound(line, false) && !readFound(plain, false))
      for (const std::string& name : splitNames(plain, finder))
        if (!readFound(name, true)) missing.push_back(finder.place(name));
  }
  const std::string own = std::filesystem::path(file).stem().string() + ".mtl";
  const std::optional<FoundFile> beside = read.empty() && needsOne ? finder.find(own) : std::nullopt;
  for (const std::string& library : missing)
    scene.remarks.push_back(
        {"no library", fmt::format("{}: no material library {}; {}", file, library,
                                   beside ? "using " + beside->path : std::string("its materials are grey"))});
  if (!beside) return;
  if (missing.empty())
    scene.remarks.push_back({"library beside", fmt::format("{}: names no library; using {}", file, beside->path)});
  readLibrary(beside->path, scene);
}

std::vector<uint32_t> findMaterials(const std::string& file, const std::vector<std::string>& names, Scene& scene) {
  const bool hasLibrary = !scene.materials.empty();
  std::unordered_map<std::string, uint32_t> exact, folded;
  for (uint32_t i = 0; i < scene.materials.size(); ++i) {
    exact.try_emplace(scene.materials[i].name, i);
    folded.try_emplace(foldedName(withoutComment(scene.materials[i].name)), i);
  }
  std::vector<uint32_t> index;
  for (const std::string& name : names) {
    if (const auto place = exact.find(name); place != exact.end()) {
      index.push_back(place->second);
      continue;
    }
    if (name.empty()) {
      index.push_back(none);
      scene.remarks.push_back(
          {"usemtl without a name", fmt::format("{}: usemtl without a name: its faces have no material", file)});
      continue;
    }
    if (const auto place = folded.find(foldedName(withoutComment(name))); place != folded.end()) {
      index.push_back(place->second);
      scene.remarks.push_back({"guessed material", fmt::format("{}: no library has the material '{}'; using '{}'", file,
                                                               name, scene.materials[place->second].name)});
      continue;
    }
    index.push_back(static_cast<uint32_t>(scene.materials.size()));
    scene.materials.push_back(greyMaterial(name));
    if (hasLibrary)
      scene.remarks.push_back(
          {"no material", fmt::format("{}: no library has the material '{}'; using grey", file, name)});
  }
  return index;
}

void giveMaterial(Scene& scene, const GivenMaterials& given) {
  const std::size_t first = scene.materials.size();
  readLibrary(given.library, scene);
  const std::size_t end = scene.materials.size();
  if (given.material.empty() && end - first != 1) {
    if (end > first && !given.areForInstances)
      scene.remarks.push_back(
          {"no material given", fmt::format("{}: the mesh names no material and {} has {}; using grey, 'material' "
                                            "chooses one",
                                            given.where, given.library, end - first)});
    return;
  }
  std::size_t which = first;
  while (!given.material.empty() && which < end && scene.materials[which].name != given.material) ++which;
  if (which == end)
    throw InputError(fmt::format("{}: {} has no material '{}'", given.where, given.library, given.material));
  std::ranges::fill(scene.materialOf, static_cast<uint32_t>(which));
}

}  // namespace copse
