// What the program says. A message that cannot be written is lost and nothing else is: no exception, no crash. Results
// on standard output that cannot be written are told by the stream's error flag, which main() asks for at the end.
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
