// Words and numbers out of text: what every reader of a file shares.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace copse {

/// The next run of non-blank characters, taken off the front of `text`; empty at the end.
std::string_view nextWord(std::string_view& text);
/// Without blanks at both ends.
std::string_view trim(std::string_view text);
/// Up to a '#' that begins a word, trimmed: what OBJ and MTL take for a comment.
std::string_view withoutComment(std::string_view text);
/// ASCII letters in lower case.
std::string lowered(std::string_view text);
/// False where the whole word is not one decimal number. "nan", "inf" and what Windows prints for them are numbers that
/// are not finite; so is what a double cannot hold.
bool parsePlainNumber(std::string_view word, double& value);
/// The same and what other programs write: "1.5D+3" of Fortran, "1.5f" and "-0x1.8p0" of C, "1.5e" without an exponent.
bool parseNumber(std::string_view word, double& value);
/// False where the whole word is not one integer that 64 bits hold.
bool parseInteger(std::string_view word, int64_t& value);

/// 261744 → "261,744".
std::string grouped(uint64_t number);

/// Without the byte order mark that some editors put before UTF-8.
std::string_view withoutMark(std::string_view text);
/// Notes where the last line has words and no end: a cut there cannot be told from a file that was written so.
void noteOpenEnd(const std::string& file, std::string_view text, std::vector<std::string>& notes);

}  // namespace copse
