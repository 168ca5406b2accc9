// As they are first, then by their tails, each folder and name without regard to case.
#include "tracer/scene/io/file_finder.h"

#include <algorithm>
#include <cctype>
#include <vector>

#include "builder/base/text.h"

namespace copse {
namespace fs = std::filesystem;

namespace {

constexpr std::size_t maxLength = 4096, maxSteps = 64;  // What systems allow, and a bound on the work for nonsense.

bool isFile(const fs::path& path) {
  std::error_code error;
  return fs::is_regular_file(path, error);
}

std::string withSlashes(std::string_view name) {
  std::string changed(name);
  std::ranges::replace(changed, '\\', '/');
  return changed;
}

}  // namespace

std::string_view withoutQuotes(std::string_view name) {
  name = trim(name);
  while (name.size() >= 2 && (name.front() == '"' || name.front() == '\'') && name.back() == name.front())
    name = trim(name.substr(1, name.size() - 2));
  return name;
}

std::string foldedName(std::string_view name) {
  name = withoutQuotes(name);
  std::string folded;
  folded.reserve(name.size());
  for (std::size_t i = 0; i < name.size(); ++i) {
    const bool escaped = name.substr(i, 3) == "%20";
    folded += escaped || name[i] == '_' ? ' ' : static_cast<char>(std::tolower(static_cast<unsigned char>(name[i])));
    if (escaped) i += 2;
  }
  return folded;
}

const std::string* FileFinder::entryLike(const fs::path& folder, const std::string& name) {
  const auto [place, isNew] = listings_.try_emplace(folder.string());
  std::unordered_map<std::string, std::string>& listing = place->second;
  std::error_code error;
  if (isNew)
    for (fs::directory_iterator entry(folder.empty() ? "." : folder, error), end; !error && entry != end;
         entry.increment(error)) {
      const std::string found = entry->path().filename().string();
      const auto [same, isFirst] = listing.try_emplace(foldedName(found), found);
      if (!isFirst) same->second = std::min(same->second, found);  // Whatever order the folder is listed in.
    }
  const auto like = listing.find(foldedName(name));
  return like == listing.end() ? nullptr : &like->second;
}

/// A relative name from the folder on.
std::optional<std::string> FileFinder::follow(const fs::path& name) {
  if (isFile(folder_ / name)) return (folder_ / name).string();
  fs::path at = folder_;
  for (const fs::path& step : name) {
    std::error_code error;
    if (step.empty() || step == "." || step == ".." || fs::exists(at / step, error)) {
      at /= step;
      continue;
    }
    const std::string* entry = entryLike(at, step.string());
    if (!entry) return {};
    at /= *entry;
  }
  return isFile(at) ? std::optional(at.string()) : std::nullopt;
}

std::string FileFinder::place(std::string_view name) const {
  return (folder_ / withSlashes(withoutQuotes(name))).lexically_normal().string();
}

std::optional<FoundFile> FileFinder::find(std::string_view name) {
  name = trim(name);
  if (name.empty() || name.size() > maxLength || name.find('\0') != std::string_view::npos) return {};
  const fs::path asWritten = withSlashes(name);
  if (isFile(folder_ / asWritten)) return FoundFile{(folder_ / asWritten).lexically_normal().string(), false};
  const fs::path plain = withSlashes(withoutQuotes(name));
  if (isFile(folder_ / plain)) return FoundFile{(folder_ / plain).lexically_normal().string(), true};

  const fs::path relative = plain.relative_path();
  const std::vector<fs::path> steps(relative.begin(), relative.end());
  for (std::size_t first = steps.size() > maxSteps ? steps.size() - 1 : 0; first < steps.size(); ++first) {
    fs::path tail;
    for (std::size_t i = first; i < steps.size(); ++i) tail /= steps[i];
    if (const std::optional<std::string> found = follow(tail))
      return FoundFile{fs::path(*found).lexically_normal().string(), true};
  }
  return {};
}

}  // namespace copse
