// Settings by name: what can be set, with its range and its meaning, and the values that were chosen. What reads a
// parameter declares it: a method in its descriptor, a stage beside its code. The table of a program is these lists one
// after the other; it feeds --set, `list parameters`, range checks, TOML and the record.
#pragma once

#include <cstdint>
#include <map>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

namespace copse {

using ParameterValue = std::variant<int64_t, double, std::string>;

using ParameterValues = std::vector<std::pair<const char*, ParameterValue>>;

struct ParameterSpec {
  const char* name;  ///< "leaf.max": the prefix is the stage or the method that reads it.
  std::variant<int64_t, double, const char*> standard;  ///< The default; its type is the parameter's.
  double min = 0, max = 0;                              ///< Inclusive; for numbers.
  const char* words[8] = {};                            ///< The allowed values, for words; then null.
  const char* meaning = "";                             ///< One line.
  bool ofTree = true;  ///< false: read where rays are traced, so that the tree does not depend on it.

  constexpr std::span<const char* const> choices() const {
    std::size_t count = 0;
    while (count < std::size(words) && words[count]) ++count;
    return {words, count};
  }
  ParameterValue defaultValue() const;
};

/// As TOML writes it, but for quotes: "4", "0.5", "auto".
std::string textOf(const ParameterValue& value);

/// What methods and stages of a build read, in that order: stages, then methods in the order of the registry.
std::span<const ParameterSpec> builderParameters();

/// Values for a table's names; what was not set has its default.
class Parameters {
 public:
  /// `table` outlives it. Programs that trace rays as well have a longer one than that of builders.
  explicit Parameters(std::span<const ParameterSpec> table) : table_(table) {}
  Parameters() : Parameters(builderParameters()) {}

  /// Throws InputError for an unknown name, a wrong type or a value out of range; the text names what is allowed.
  void set(const std::string& name, const ParameterValue& value);
  /// From "leaf.max=4", as --set gives it.
  void set(const std::string& assignment);

  /// Whether set() gave it a value, so that a preset leaves it alone.
  bool isSet(const std::string& name) const;

  /// Each throws InputError for an unknown name.
  int64_t integer(const std::string& name) const;
  double real(const std::string& name) const;
  std::string text(const std::string& name) const;
  ParameterValue value(const std::string& name) const;

  /// For code that declares the parameter itself: it need not be in the table.
  ParameterValue value(const ParameterSpec& spec) const;
  int64_t integer(const ParameterSpec& spec) const;
  double real(const ParameterSpec& spec) const;
  std::string text(const ParameterSpec& spec) const;

  std::span<const ParameterSpec> table() const { return table_; }

 private:
  const ParameterSpec& specOf(const std::string& name) const;

  std::span<const ParameterSpec> table_;
  std::map<std::string, ParameterValue> values_;
};

}  // namespace copse
