// Files by the names that meshes and libraries give them: written on another machine, they are often quoted, of another
// case, or in a folder that only their author has.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>

namespace copse {

struct FoundFile {
  std::string path;
  bool guessed;  ///< The name was not followed to the letter; a note should say so.
};

/// Looks beside one file. Each folder is listed once, so that many names cost no more than their number.
class FileFinder {
 public:
  /// `from`: the mesh or the library that has the names.
  explicit FileFinder(const std::string& from) : folder_(std::filesystem::path(from).parent_path()) {}

  /// The regular file that is plainly meant: the name as it is (a backslash is a slash), then without quotes, then
  /// without the folders in front of it, the outermost first. Where a folder has no such name, one that differs in case
  /// alone, or by '_' or "%20" for a blank, stands for it.
  std::optional<FoundFile> find(std::string_view name);

  /// Where such a name would be, found or not: with slashes and without quotes.
  std::string place(std::string_view name) const;

 private:
  const std::string* entryLike(const std::filesystem::path& folder, const std::string& name);
  std::optional<std::string> follow(const std::filesystem::path& name);

  std::filesystem::path folder_;
  std::map<std::string, std::unordered_map<std::string, std::string>> listings_;  ///< By folder, then foldedName().
};

/// One of two names that most programs take for the same: no quotes, lower case, blanks for '_' and "%20".
std::string foldedName(std::string_view name);

/// Without blanks at both ends, and then without the quotes around it.
std::string_view withoutQuotes(std::string_view name);

}  // namespace copse
