// Names of files and what is in them.
#include "builder/base/files.h"

#include <fmt/format.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>

#include "builder/base/error.h"
#include "builder/base/text.h"

namespace copse {
namespace fs = std::filesystem;

std::string extensionOf(const std::string& file) { return lowered(fs::path(file).extension().string()); }

void checkFile(const std::string& file) {
  std::error_code ignored;
  const fs::file_status status = fs::status(file, ignored);
  if (!fs::exists(status)) throw InputError(fmt::format("{}: no such file", file));
  if (fs::is_directory(status)) throw InputError(fmt::format("{}: is a directory, not a file", file));
  if (!fs::is_regular_file(status)) throw InputError(fmt::format("{}: is not a regular file", file));
}

std::string readFile(const std::string& file) {
  checkFile(file);
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> stream(std::fopen(file.c_str(), "rb"), std::fclose);
  if (!stream) throw InputError(fmt::format("{}: cannot open: {}", file, std::strerror(errno)));
  std::error_code error;
  std::string text(fs::file_size(file, error), '\0');
  const std::size_t got = error ? 0 : std::fread(text.data(), 1, text.size(), stream.get());
  if (error || got != text.size()) throw InputError(fmt::format("{}: read failed before the end of the file", file));
  if (text.empty()) throw InputError(fmt::format("{}: the file is empty", file));
  return text;
}

}  // namespace copse
