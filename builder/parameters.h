// One table of every parameter: name, type, default, range and one line of meaning. It feeds --set, `list parameters`,
// range checks, TOML and the record.
#pragma once

#include <map>
#include <span>
#include <string>
#include <variant>
#include <vector>

namespace copse {

using ParameterValue = std::variant<int64_t, double, std::string>;

struct ParameterSpec {
  const char* name;  ///< "leaf.max": the prefix is the stage or the builder that reads it.
  ParameterValue defaultValue;
  double least, most;                ///< Inclusive; for numbers.
  std::vector<const char*> choices;  ///< For strings.
  const char* meaning;
  bool ofTree = true;  ///< false: read where rays are traced, so that the tree does not depend on it.
};

std::span<const ParameterSpec> parameterTable();

/// Values for the table's names; what was not set has its default.
class Parameters {
 public:
  /// Throws InputError for an unknown name, a wrong type or a value out of range; the text names the range.
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

 private:
  std::map<std::string, ParameterValue> values_;
};

}  // namespace copse
