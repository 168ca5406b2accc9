// Words and numbers.
#include "builder/base/text.h"

#include <fmt/format.h>

#include <charconv>
#include <cmath>
#include <limits>

namespace copse {

static bool isBlank(char c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; }

/// from_chars takes no '+'.
static bool dropPlus(std::string_view& word) {
  if (word.empty() || word.front() != '+') return true;
  word.remove_prefix(1);
  return !word.empty() && word.front() != '-';
}

std::string_view withoutComment(std::string_view text) {
  for (std::size_t at = text.find('#'); at != std::string_view::npos; at = text.find('#', at + 1))
    if (at == 0 || isBlank(text[at - 1])) return trim(text.substr(0, at));
  return trim(text);
}

std::string lowered(std::string_view text) {
  std::string lower(text);
  for (char& c : lower)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return lower;
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

std::string grouped(uint64_t number) {
  const std::string digits = std::to_string(number);
  std::string text;
  for (std::size_t i = 0; i < digits.size(); ++i) {
    if (i > 0 && (digits.size() - i) % 3 == 0) text += ',';
    text += digits[i];
  }
  return text;
}

std::string_view withoutMark(std::string_view text) {
  if (text.starts_with("\xef\xbb\xbf")) text.remove_prefix(3);
  return text;
}

void noteOpenEnd(const std::string& file, std::string_view text, std::vector<std::string>& notes) {
  const std::size_t end = text.find_last_of("\r\n");
  if (!trim(end == std::string_view::npos ? text : text.substr(end + 1)).empty())
    notes.push_back(fmt::format("{}: the last line has no end; the file may be truncated", file));
}

bool parsePlainNumber(std::string_view word, double& value) {
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

/// Hexadecimal as C writes it, -0x1.8p3.
static bool parseHexadecimal(std::string_view word, double& value) {
  const bool negative = word.starts_with('-');
  if (negative || word.starts_with('+')) word.remove_prefix(1);
  if (!word.starts_with("0x") && !word.starts_with("0X")) return false;
  word.remove_prefix(2);
  if (word.starts_with('-')) return false;
  const char* end = word.data() + word.size();
  const auto [stop, error] = std::from_chars(word.data(), end, value, std::chars_format::hex);
  if (negative) value = -value;
  return error == std::errc() && stop == end;
}

bool parseNumber(std::string_view word, double& value) {
  if (parsePlainNumber(word, value)) return true;
  if (parseHexadecimal(word, value)) return true;
  // Fortran's 1.5D+3, the 1.5f of C, and 1.5e, whose exponent is missing.
  if (word.size() > 64 || word.find_first_of("0123456789") == std::string_view::npos) return false;
  std::string plain(word);
  if (const std::size_t at = plain.find_first_of("dD"); at != std::string::npos) plain[at] = 'e';
  if (plain.back() == 'f' || plain.back() == 'F') plain.pop_back();
  std::size_t end = plain.size();
  if (end > 0 && (plain[end - 1] == '+' || plain[end - 1] == '-')) --end;
  if (end > 0 && (plain[end - 1] == 'e' || plain[end - 1] == 'E')) plain.resize(end - 1);
  return parsePlainNumber(plain, value);
}

bool parseInteger(std::string_view word, int64_t& value) {
  if (!dropPlus(word)) return false;
  const auto [stop, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  return error == std::errc() && stop == word.data() + word.size();
}

}  // namespace copse
