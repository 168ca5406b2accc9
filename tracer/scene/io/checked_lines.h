// The stream through which tinyobjloader reads. It hands over one line at a time, so that the line's number is known in
// every callback, after a check of our own: tinyobjloader takes what it cannot read for 0 and says nothing.
#pragma once

#include <functional>
#include <streambuf>
#include <string>
#include <string_view>

#include "builder/base/text.h"

namespace copse {

class CheckedLines : public std::streambuf {
 public:
  /// `check` gets each line without its end (LF, CRLF or CR) and may change it, or clear it to leave it out.
  /// A backslash at the end goes on to the next line. `text` must outlive this; its byte order mark is skipped.
  CheckedLines(const std::string& file, std::string_view text, std::function<void(std::string& line)> check)
      : file_(file), rest_(withoutMark(text)), check_(std::move(check)) {}

  int lineNumber() const { return number_; }
  /// The current line ends with the file: a cut within it cannot be told from a line that was written so.
  bool isOpen() const { return isOpen_; }
  /// Throws InputError "FILE:LINE: what" for the line in hand.
  [[noreturn]] void fail(const std::string& what) const;

 protected:
  int_type underflow() override;

 private:
  void takeLine();

  std::string file_;
  std::string_view rest_;
  std::function<void(std::string&)> check_;
  std::string line_;
  bool isOpen_ = false;
  int number_ = 0;     ///< The current line, from 1.
  int following_ = 1;  ///< The next line.
};

}  // namespace copse
