// A file that is written whole or not at all: its bytes go to a temporary name in the same folder, which is renamed
// when all of them are on the disk. What fails or is given up leaves the old file as it was and nothing beside it.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace copse {

/// Every member throws InputError "FILE: why". Making one and letting it go tells early whether FILE can be written.
/// A device or a pipe (/dev/stdout) is written directly; a symbolic link is followed. Not for use by two threads.
class WholeFile {
 public:
  explicit WholeFile(const std::string& file);
  ~WholeFile();
  WholeFile(const WholeFile&) = delete;
  WholeFile& operator=(const WholeFile&) = delete;

  void write(const void* bytes, std::size_t count);
  void write(std::string_view text) { write(text.data(), text.size()); }
  /// Where the next write goes, in bytes from the start.
  void seek(uint64_t position);
  uint64_t position() const { return position_; }

  /// Puts the file in its place. Throws as well if an earlier write failed and its error was swallowed on the way.
  void commit();

 private:
  [[noreturn]] void fail(int error);

  std::string file_, target_, temporary_;  // temporary_ is empty where the target is written directly.
  int descriptor_ = -1, slot_ = -1;
  int error_ = 0;
  uint64_t position_ = 0;
};

/// The common case: all of it at once.
void writeWholeFile(const std::string& file, std::string_view text);

/// For a signal handler that ends the program after it: no temporary file stays behind. Safe in such a handler.
void removeTemporaryFiles() noexcept;

}  // namespace copse
