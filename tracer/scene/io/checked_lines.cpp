// One line at a time, checked.
#include "tracer/scene/io/checked_lines.h"

#include <fmt/format.h>

#include "builder/base/error.h"

namespace copse {

void CheckedLines::fail(const std::string& what) const {
  throw InputError(fmt::format("{}:{}: {}", file_, number_, what));
}

void CheckedLines::takeLine() {
  line_.clear();
  number_ = following_;
  for (;;) {
    const std::size_t end = std::min(rest_.find_first_of("\r\n"), rest_.size());
    line_.append(rest_.substr(0, end));
    isOpen_ = end == rest_.size();
    const bool crlf = rest_.substr(end, 2) == "\r\n";
    rest_.remove_prefix(std::min(end + 1 + crlf, rest_.size()));
    ++following_;
    // Not in comments, and not in an MTL's map_Kd, where some programs write a folder of Windows and no file.
    if (line_.empty() || line_.back() != '\\' || rest_.empty()) return;
    const std::size_t first = std::min(line_.find_first_not_of(" \t"), line_.size());
    if (line_[first] == '#' || line_.find(" #") != std::string::npos || line_.find("\t#") != std::string::npos) return;
    if (line_.compare(first, 4, "map_") == 0 || line_.compare(first, 4, "MAP_") == 0) return;
    line_.back() = ' ';
  }
}

CheckedLines::int_type CheckedLines::underflow() {
  do {
    if (rest_.empty()) return traits_type::eof();
    takeLine();
    if (line_.find('\0') != std::string::npos) fail("a NUL byte: this is not text");
    check_(line_);
  } while (line_.empty());
  line_ += '\n';
  setg(line_.data(), line_.data(), line_.data() + line_.size());
  return traits_type::to_int_type(line_.front());
}

}  // namespace copse
