// The results of tests/data/report in a folder of their own, and what tests ask of the page made of them.
#pragma once

#include <filesystem>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "tests/support/files.h"

namespace copse::test {

inline const std::string reportData = std::string(COPSE_SOURCE_DIR) + "/tests/data/report/";

/// A folder with the results of tests/data/report, or those given.
inline void fill(const Folder& folder, const std::string& results = bytesOf(reportData + "results.json")) {
  putBytes(folder / "results.json", results);
  putBytes(folder / "experiment.json", bytesOf(reportData + "experiment.json"));
}

inline std::string folderOf(const Folder& folder) { return std::filesystem::path(folder / "x").parent_path().string(); }

inline bool has(const std::string& text, const std::string& part) { return text.find(part) != std::string::npos; }

inline std::size_t countOf(const std::string& text, const std::string& part) {
  std::size_t count = 0;
  for (std::size_t at = 0; (at = text.find(part, at)) != std::string::npos; at += part.size()) ++count;
  return count;
}

/// Cells of table1.csv by method and column.
inline std::map<std::string, std::map<std::string, std::string>> cellsOf(const std::string& csv) {
  std::istringstream lines(csv);
  std::vector<std::string> head;
  std::map<std::string, std::map<std::string, std::string>> cells;
  for (std::string line; std::getline(lines, line);) {
    std::vector<std::string> fields{""};
    bool inQuotes = false;
    for (const char c : line) {
      if (c == '"')
        inQuotes = !inQuotes;
      else if (c == ',' && !inQuotes)
        fields.emplace_back();
      else
        fields.back() += c;
    }
    if (head.empty())
      head = fields;
    else
      for (std::size_t i = 0; i < fields.size(); ++i) cells[fields[2]][head[i]] = fields[i];
  }
  return cells;
}

}  // namespace copse::test
