// The program's output. A message that cannot be written is lost without an exception or a crash. Results that cannot
// be written to standard output set the stream's error flag, which main() checks at the end.
#pragma once

#include <fmt/format.h>

#include <cstdio>
#include <utility>

namespace copse::cli {

/// A result, to standard output.
template <class... T>
void print(fmt::format_string<T...> format, T&&... values) {
  const std::string text = fmt::format(format, std::forward<T>(values)...);
  std::fwrite(text.data(), 1, text.size(), stdout);
}

/// A note, a warning or an error, to standard error.
template <class... T>
void say(fmt::format_string<T...> format, T&&... values) {
  const std::string text = fmt::format(format, std::forward<T>(values)...);
  std::fwrite(text.data(), 1, text.size(), stderr);
}

}  // namespace copse::cli
