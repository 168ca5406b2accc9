// Text in, HTML or CSV out.
#include "tracer/report/html.h"

#include <fmt/format.h>

#include <cmath>

namespace copse::report {

std::string escape(std::string_view text) {
  std::string out;
  for (const char c : text) switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      case '\'':
        out += "&#39;";
        break;
      default:
        if (static_cast<unsigned char>(c) >= 32 || c == '\n' || c == '\t') out += c;
    }
  return out;
}

std::string shownCount(double value) {
  if (!known(value)) return "–";
  const std::string digits = fmt::format("{:.0f}", std::abs(value));
  std::string text = value < 0 ? "-" : "";
  for (std::size_t i = 0; i < digits.size(); ++i) {
    if (i > 0 && (digits.size() - i) % 3 == 0) text += ',';
    text += digits[i];
  }
  return text;
}

std::string shown(double value) {
  if (!known(value)) return "–";
  const double size = std::abs(value);
  // Bounds are where rounding would add a digit.
  if (size >= 99.95) return shownCount(value);
  if (size >= 9.995) return fmt::format("{:.1f}", value);
  if (size >= 0.9995) return fmt::format("{:.2f}", value);
  return size == 0 ? "0" : size < 0.0095 ? fmt::format("{:.2g}", value) : fmt::format("{:.3f}", value);
}

std::string shownRatio(double value) {
  if (!known(value)) return "";
  return fmt::format("{:.{}f}", value, value >= 99.5 ? 0 : value >= 9.995 ? 1 : 2);
}

std::string shownBytes(double value) {
  if (!known(value)) return "–";
  if (value < 1e4) return fmt::format("{:.0f} B", value);
  const char* const units[] = {"kB", "MB", "GB", "TB"};
  int unit = 0;
  for (value *= 1e-3; value >= 999.5 && unit < 3; value *= 1e-3) ++unit;
  return shown(value) + " " + units[unit];
}

std::string PlainTable::html() const {
  std::string out = fmt::format(
      "<div class=\"scroll\" tabindex=\"0\"><table>\n<caption><span>{}</span></caption>\n<thead><tr>", caption);
  for (std::size_t i = 0; i < headers.size(); ++i)
    out += fmt::format("<th scope=\"col\"{}>{}</th>", i < texts ? " class=\"text\"" : "", headers[i]);
  out += "</tr></thead>\n<tbody>\n";
  for (const std::vector<std::string>& row : rows) {
    out += "<tr>";
    for (std::size_t i = 0; i < row.size(); ++i)
      out += i == 0 ? fmt::format("<th scope=\"row\">{}</th>", row[i])
                    : fmt::format("<td{}>{}</td>", i < texts ? " class=\"text\"" : "", row[i]);
    out += "</tr>\n";
  }
  return out + "</tbody></table></div>\n";
}

std::string foldedWhereLong(const PlainTable& table) {
  if (table.rows.empty()) return "";
  if (table.rows.size() <= 45) return table.html();
  return fmt::format("<details><summary>All {} rows</summary>\n{}</details>\n", table.rows.size(), table.html());
}

std::string factList(const Facts& facts) {
  std::string out = "<dl>\n";
  for (const auto& [name, value] : facts) out += fmt::format("<dt>{}</dt><dd>{}</dd>\n", escape(name), escape(value));
  return out + "</dl>\n";
}

std::string csvLine(const std::vector<std::string>& fields) {
  std::string line;
  for (const std::string& field : fields) {
    if (!line.empty() || &field != &fields.front()) line += ',';
    if (field.find_first_of(",\"\r\n") == std::string::npos) {
      line += field;
      continue;
    }
    line += '"';
    for (const char c : field) line += c == '"' ? "\"\"" : std::string(1, c);
    line += '"';
  }
  return line + "\n";
}

std::string csvNumber(double value) { return known(value) ? fmt::format("{:.10g}", value) : ""; }

}  // namespace copse::report
