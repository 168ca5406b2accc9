// A TOML table whose every key is known, with the expected type, or an InputError that names file and line.
#pragma once

#include <toml++/toml.h>
#include <array>
#include <initializer_list>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace copse {

/// Throws InputError "FILE:LINE: why" where `text` is not TOML.
toml::table parseToml(const std::string& text, const std::string& file);

class TomlKeys {
 public:
  /// `what` names the table in messages, such as "[[mesh]]". Throws for a key that is not in `known`.
  TomlKeys(const std::string& file, const toml::table& table, const std::string& what,
           std::initializer_list<std::string_view> known);

  bool has(std::string_view key) const { return table_.contains(key); }
  /// "FILE:LINE" of a key, or of the table where it is not there.
  std::string where(std::string_view key = {}) const;
  [[noreturn]] void fail(std::string_view key, const std::string& what) const;
  /// Likewise at a value inside of it, such as an element of an array.
  [[noreturn]] void failAt(const toml::node& node, const std::string& what) const;

  // Each throws where the key is there with another type, or where it is not there and no default is given.
  std::string text(std::string_view key, std::optional<std::string> standard = {}) const;
  double number(std::string_view key, std::optional<double> standard = {}) const;
  int64_t integer(std::string_view key, int64_t min, int64_t max, std::optional<int64_t> standard = {}) const;
  bool flag(std::string_view key, bool standard) const;
  /// `size` finite numbers.
  std::vector<double> numbers(std::string_view key, std::size_t size) const;
  /// Three finite numbers.
  using Triple = std::array<double, 3>;
  Triple triple(std::string_view key, std::optional<Triple> standard = {}) const;
  /// None of them negative.
  Triple tripleNotNegative(std::string_view key) const;
  std::vector<std::string> texts(std::string_view key) const;
  /// An array of integers, or a single one; empty where the key is not there.
  std::vector<int64_t> integers(std::string_view key, int64_t min, int64_t max) const;
  /// The tables of `[[key]]`; empty where there are none.
  std::vector<const toml::table*> tables(std::string_view key) const;

 private:
  const toml::node* find(std::string_view key, bool required) const;

  const std::string& file_;
  const toml::table& table_;
  std::string what_;
};

}  // namespace copse
