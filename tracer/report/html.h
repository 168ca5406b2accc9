// Small parts of a page: escaped text, numbers as tables print them, plain tables, CSV.
#pragma once

#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

#include "tracer/report/load.h"

namespace copse::report {

/// For text and for attributes in quotes. Control characters are left out.
std::string escape(std::string_view text);

/// Three significant digits, more where the whole part has more: 0.482, 17.8, 2,225. An en dash for NaN.
std::string shown(double value);
/// Two decimals, fewer from 10 on.
std::string shownRatio(double value);
/// 12759 → "12,759".
std::string shownCount(double value);
std::string shownBytes(double value);

/// A table whose first `texts` columns are text and the others numbers. Cells are HTML.
struct PlainTable {
  std::string caption;
  std::vector<std::string> headers;
  std::vector<std::vector<std::string>> rows;
  std::size_t texts = 1;
  std::string html() const;
};

/// Nothing for a table without rows; a long one is there to be opened.
std::string foldedWhereLong(const PlainTable& table);

/// <dl> of escaped names and texts.
std::string factList(const Facts& facts);

/// One line of CSV: fields are quoted where needed (RFC 4180).
std::string csvLine(const std::vector<std::string>& fields);
/// Ten significant digits, or nothing for NaN.
std::string csvNumber(double value);

}  // namespace copse::report
