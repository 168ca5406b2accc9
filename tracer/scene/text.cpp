// Words, numbers and whole files.
#include "tracer/scene/text.h"

#include <fmt/format.h>

#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <limits>
#include <memory>

#include "builder/parallel/error.h"

namespace copse {
namespace fs = std::filesystem;

static bool isBlank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; }

/// from_chars takes no '+'.
static bool dropPlus(std::string_view& word) {
  if (word.empty() || word.front() != '+') return true;
  word.remove_prefix(1);
  return !word.empty() && word.front() != '-';
}

std::string_view nextWord(std::string_view& text) {
  std::size_t begin = 0;
  while (begin < text.size() && isBlank(text[begin])) ++begin;
  std::size_t end = begin;
  while (end < text.size() && !isBlank(text[end])) ++end;
  const std::string_view word = text.substr(begin, end - begin);
  text.remove_prefix(end);
  return word;
}

std::string_view trim(std::string_view text) {
  while (!text.empty() && isBlank(text.front())) text.remove_prefix(1);
  while (!text.empty() && isBlank(text.back())) text.remove_suffix(1);
  return text;
}

std::string_view withoutMark(std::string_view text) {
  if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);
  return text;
}

void noteOpenEnd(const std::string& file, std::string_view text, std::vector<std::string>& notes) {
  const std::size_t end = text.find_last_of("\r\n");
  if (!trim(end == std::string_view::npos ? text : text.substr(end + 1)).empty())
    notes.push_back(fmt::format("{}: its last line has no end: the file may have been cut", file));
}

bool parseNumber(std::string_view word, double& value) {
  if (!dropPlus(word)) return false;
  const char* end = word.data() + word.size();
  const auto [stop, error] = std::from_chars(word.data(), end, value);
  if (error == std::errc::invalid_argument) return false;
  if (error == std::errc::result_out_of_range) {
    const bool tiny = std::string_view(word.data(), stop - word.data()).find("e-") != std::string_view::npos ||
                      std::string_view(word.data(), stop - word.data()).find("E-") != std::string_view::npos;
    value = tiny ? 0 : std::numeric_limits<double>::infinity();
  }
  if (stop == end) return true;
  // Windows' printf writes 1.#QNAN, 1.#INF and 1.#IND.
  if (*stop != '#') return false;
  value = std::numeric_limits<double>::quiet_NaN();
  return true;
}

bool parseInteger(std::string_view word, int64_t& value) {
  if (!dropPlus(word)) return false;
  const auto [stop, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  return error == std::errc() && stop == word.data() + word.size();
}

std::string readFile(const std::string& file) {
  std::error_code error;
  const fs::file_status status = fs::status(file, error);
  if (!fs::exists(status)) throw InputError(fmt::format("{}: there is no such file", file));
  if (fs::is_directory(status)) throw InputError(fmt::format("{}: is a directory, not a file", file));
  if (!fs::is_regular_file(status)) throw InputError(fmt::format("{}: is not a regular file", file));

  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> stream(std::fopen(file.c_str(), "rb"), std::fclose);
  if (!stream) throw InputError(fmt::format("{}: cannot be opened: {}", file, std::strerror(errno)));
  std::string text(fs::file_size(file, error), '\0');
  const std::size_t got = error ? 0 : std::fread(text.data(), 1, text.size(), stream.get());
  if (error || got != text.size()) throw InputError(fmt::format("{}: cannot be read to its end", file));
  if (text.empty()) throw InputError(fmt::format("{}: the file is empty", file));
  return text;
}

std::string findSceneFile(const std::string& name, const std::string& scene, const std::string& where) {
  std::vector<fs::path> folders{fs::path(scene).parent_path()};
  const char* named = std::getenv("COPSE_SCENES");
  std::string_view rest = named ? named : "";
  while (!rest.empty()) {
    const std::size_t colon = std::min(rest.find(':'), rest.size());
    if (colon > 0) folders.emplace_back(rest.substr(0, colon));
    rest.remove_prefix(std::min(colon + 1, rest.size()));
  }
  if (fs::path(name).is_absolute()) folders = {""};

  std::string looked;
  for (const fs::path& folder : folders) {
    const fs::path file = folder / name;
    std::error_code error;
    if (fs::exists(file, error)) return file.string();
    looked += "\n  looked at " + file.string();
  }
  throw InputError(fmt::format("{}: there is no file '{}'{}\n  COPSE_SCENES, {}, names more folders to look in", where,
                               name, looked, named && *named ? "a list with colons" : "which is not set"));
}

}  // namespace copse
