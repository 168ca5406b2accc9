// TOML values with their checks.
#include "builder/base/toml_keys.h"

#include <fmt/format.h>

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <sstream>

#include "builder/base/error.h"

namespace copse {

static std::string place(const std::string& file, const toml::source_region& source) {
  return fmt::format("{}:{}", file, source.begin.line);
}

/// A value as messages show it: as a file has it, without what is inside of tables and arrays.
static std::string shown(const toml::node& node) {
  if (node.is_table()) return "a table";
  if (const toml::array* array = node.as_array())
    return fmt::format("an array of {} value{}", array->size(), array->size() == 1 ? "" : "s");
  std::ostringstream text;
  node.visit([&](const auto& value) {
    if constexpr (toml::is_value<decltype(value)>) text << value;
  });
  const std::string all = text.str();
  if (all.size() <= 60) return all;
  std::size_t end = 57;
  while (end && (all[end] & 0xC0) == 0x80) --end;  // Not inside of a UTF-8 character.
  return all.substr(0, end) + "…";
}

toml::table parseToml(const std::string& text, const std::string& file) {
  try {
    return toml::parse(text, std::string_view(file));
  } catch (const toml::parse_error& error) {
    throw InputError(fmt::format("{}: {}", place(file, error.source()), error.description()));
  }
}

TomlKeys::TomlKeys(const std::string& file, const toml::table& table, const std::string& what,
                   std::initializer_list<std::string_view> known)
    : file_(file), table_(table), what_(what) {
  std::string all;
  for (const std::string_view key : known) all += (all.empty() ? "" : ", ") + std::string(key);
  for (const auto& [key, value] : table_)
    if (std::find(known.begin(), known.end(), key.str()) == known.end())
      throw InputError(
          fmt::format("{}: unknown key '{}' in {} (allowed: {})", place(file_, key.source()), key.str(), what_, all));
}

std::string TomlKeys::where(std::string_view key) const {
  const toml::node* node = key.empty() ? nullptr : table_.get(key);
  const toml::source_region& source = node ? node->source() : table_.source();
  return source.begin.line ? place(file_, source) : file_;
}

void TomlKeys::fail(std::string_view key, const std::string& what) const {
  throw InputError(fmt::format("{}: {}", where(key), what));
}

void TomlKeys::failAt(const toml::node& node, const std::string& what) const {
  throw InputError(fmt::format("{}: {}", node.source().begin.line ? place(file_, node.source()) : file_, what));
}

const toml::node* TomlKeys::find(std::string_view key, bool required) const {
  const toml::node* node = table_.get(key);
  if (!node && required) fail({}, fmt::format("{} lacks the key '{}'", what_, key));
  return node;
}

std::string TomlKeys::text(std::string_view key, std::optional<std::string> standard) const {
  const toml::node* node = find(key, !standard);
  if (!node) return *standard;
  if (!node->is_string()) fail(key, fmt::format("'{}': expected a string in quotes, got {}", key, shown(*node)));
  const std::string& value = node->as_string()->get();
  if (value.empty()) fail(key, fmt::format("'{}' is empty", key));
  if (value.find('\0') != std::string::npos) fail(key, fmt::format("'{}' contains a NUL byte", key));
  return value;
}

static bool finiteNumber(const toml::node& node, double& value) {
  if (!node.is_number()) return false;
  value = node.is_integer() ? static_cast<double>(node.as_integer()->get()) : node.as_floating_point()->get();
  return std::abs(value) <= 1e30;
}

double TomlKeys::number(std::string_view key, std::optional<double> standard) const {
  const toml::node* node = find(key, !standard);
  if (!node) return *standard;
  double value = 0;
  if (!finiteNumber(*node, value)) fail(key, fmt::format("'{}': expected a finite number, got {}", key, shown(*node)));
  return value;
}

int64_t TomlKeys::integer(std::string_view key, int64_t min, int64_t max, std::optional<int64_t> standard) const {
  const toml::node* node = find(key, !standard);
  if (!node) return *standard;
  const int64_t value = node->is_integer() ? node->as_integer()->get() : 0;
  if (!node->is_integer() || value < min || value > max)
    fail(key, fmt::format("'{}': expected an integer from {} to {}, got {}", key, min, max, shown(*node)));
  return value;
}

bool TomlKeys::flag(std::string_view key, bool standard) const {
  const toml::node* node = find(key, false);
  if (!node) return standard;
  if (!node->is_boolean()) fail(key, fmt::format("'{}': expected true or false, got {}", key, shown(*node)));
  return node->as_boolean()->get();
}

std::vector<double> TomlKeys::numbers(std::string_view key, std::size_t size) const {
  const toml::node* node = find(key, true);
  std::vector<double> values;
  if (const toml::array* array = node->as_array())
    for (const toml::node& item : *array) {
      double value = 0;
      if (!finiteNumber(item, value))
        fail(key, fmt::format("'{}': expected {} finite numbers, got {}", key, size, shown(*node)));
      values.push_back(value);
    }
  if (values.size() != size)
    fail(key, fmt::format("'{}': expected an array of {} numbers, got {}", key, size, shown(*node)));
  return values;
}

TomlKeys::Triple TomlKeys::triple(std::string_view key, std::optional<Triple> standard) const {
  if (standard && !has(key)) return *standard;
  const std::vector<double> values = numbers(key, 3);
  return {values[0], values[1], values[2]};
}

TomlKeys::Triple TomlKeys::tripleNotNegative(std::string_view key) const {
  const Triple values = triple(key);
  if (*std::min_element(values.begin(), values.end()) < 0)
    fail(key, fmt::format("'{}': expected no negative number, got {}", key, fmt::join(values, ", ")));
  return values;
}

std::vector<std::string> TomlKeys::texts(std::string_view key) const {
  std::vector<std::string> values;
  const toml::node* node = find(key, false);
  if (!node) return values;
  const toml::array* array = node->as_array();
  if (!array) fail(key, fmt::format("'{}': expected an array of strings, got {}", key, shown(*node)));
  for (const toml::node& item : *array) {
    if (!item.is_string()) fail(key, fmt::format("'{}': expected an array of strings, got {}", key, shown(*node)));
    values.push_back(item.as_string()->get());
  }
  return values;
}

std::vector<int64_t> TomlKeys::integers(std::string_view key, int64_t min, int64_t max) const {
  std::vector<int64_t> values;
  const toml::node* node = find(key, false);
  if (!node) return values;
  const auto add = [&](const toml::node& item) {
    const int64_t value = item.is_integer() ? item.as_integer()->get() : 0;
    if (!item.is_integer() || value < min || value > max)
      failAt(item, fmt::format("'{}': expected integers from {} to {}, got {}", key, min, max, shown(item)));
    values.push_back(value);
  };
  if (const toml::array* array = node->as_array())
    for (const toml::node& item : *array) add(item);
  else
    add(*node);
  return values;
}

std::vector<const toml::table*> TomlKeys::tables(std::string_view key) const {
  std::vector<const toml::table*> values;
  const toml::node* node = find(key, false);
  if (!node) return values;
  const toml::array* array = node->as_array();
  if (!array) fail(key, fmt::format("'{}': expected tables, written as [[{}]], got {}", key, key, shown(*node)));
  for (const toml::node& item : *array) {
    if (!item.is_table())
      fail(key, fmt::format("'{}': expected tables, written as [[{}]], got {}", key, key, shown(*node)));
    values.push_back(item.as_table());
  }
  return values;
}

}  // namespace copse
