// The journal of an experiment, DIR/results.jsonl: one record per line, on disk before the next run begins. A line that
// a crash cut off is dropped, so a run is in it whole or not at all.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace copse {

/// Opened by one process at a time. Every member throws InputError "FILE: why".
class Journal {
 public:
  /// A record that the file held already.
  struct Entry {
    std::string key, line;  ///< The line without its end.
    int repetition = 1;
    bool failed = false;
  };

  /// Creates the file if it does not exist, and removes a truncated last line. Also throws where another line is not a
  /// record, and where another process has it open.
  explicit Journal(const std::string& file);
  ~Journal();
  Journal(const Journal&) = delete;
  Journal& operator=(const Journal&) = delete;

  /// What the file holds, in its order.
  const std::vector<Entry>& entries() const { return entries_; }
  bool holds(const std::string& key, int repetition) const;

  /// Appends `line`, a record in one line with its end, and waits until it is on disk. A line that cannot be written
  /// leaves nothing behind.
  void append(std::string_view line);

 private:
  [[noreturn]] void fail(int error);
  void read();

  std::string file_;
  int descriptor_ = -1;
  long long size_ = 0;
  std::vector<Entry> entries_;
};

}  // namespace copse
