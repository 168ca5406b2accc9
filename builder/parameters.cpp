// Checks on values that come from outside, and the name that was probably meant.
#include "builder/parameters.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <numeric>

#include "builder/base/error.h"

namespace copse {

ParameterValue ParameterSpec::defaultValue() const {
  return std::visit([](const auto& value) { return ParameterValue(value); }, standard);
}

namespace {

/// Levenshtein's distance, for the name that was probably meant.
std::size_t editDistance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), std::size_t{0});
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i - 1] != b[j - 1]);
      diagonal = row[j];
      row[j] = std::min({replaced, row[j] + 1, row[j - 1] + 1});
    }
  }
  return row.back();
}

std::string expectedBy(const ParameterSpec& spec) {
  if (std::holds_alternative<const char*>(spec.standard))
    return fmt::format("one of {}", fmt::join(spec.choices(), ", "));
  const char* kind = std::holds_alternative<double>(spec.standard) ? "a number" : "an integer";
  return fmt::format("{} from {:.10g} to {:.10g}", kind, spec.min, spec.max);
}

[[noreturn]] void refuse(const ParameterSpec& spec, const std::string& given) {
  throw InputError(fmt::format("{}: expected {}, got {}", spec.name, expectedBy(spec), given));
}

/// For messages: 4.0 is shown as no integer, and words in quotes.
std::string shown(const ParameterValue& value) {
  if (const auto* real = std::get_if<double>(&value)) return fmt::format("{:#}", *real);
  return std::holds_alternative<std::string>(value) ? fmt::format("'{}'", textOf(value)) : textOf(value);
}

void checkRange(const ParameterSpec& spec, const ParameterValue& value) {
  if (const auto* text = std::get_if<std::string>(&value)) {
    const auto same = [&](const char* choice) { return *text == choice; };
    if (std::ranges::none_of(spec.choices(), same)) refuse(spec, shown(value));
    return;
  }
  const auto* integer = std::get_if<int64_t>(&value);
  const double number = integer ? static_cast<double>(*integer) : std::get<double>(value);
  if (!(number >= spec.min && number <= spec.max)) refuse(spec, shown(value));
}

template <class T>
bool readWhole(const std::string& text, T& value) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size();
}

}  // namespace

std::string textOf(const ParameterValue& value) {
  return std::visit([](const auto& v) { return fmt::format("{}", v); }, value);
}

const ParameterSpec& Parameters::specOf(const std::string& name) const {
  for (const ParameterSpec& spec : table_)
    if (name == spec.name) return spec;
  const auto nearest = std::min_element(table_.begin(), table_.end(), [&](const auto& a, const auto& b) {
    return editDistance(name, a.name) < editDistance(name, b.name);
  });
  const bool close = editDistance(name, nearest->name) <= 1 + name.size() / 3;
  throw InputError(close ? fmt::format("unknown parameter '{}' (did you mean '{}'?)", name, nearest->name)
                         : fmt::format("unknown parameter '{}' (`copse list parameters` shows all)", name));
}

void Parameters::set(const std::string& name, const ParameterValue& value) {
  const ParameterSpec& spec = specOf(name);
  ParameterValue kept = value;
  if (const auto* integer = std::get_if<int64_t>(&value); integer && std::holds_alternative<double>(spec.standard))
    kept = static_cast<double>(*integer);
  if (kept.index() != spec.standard.index()) refuse(spec, shown(value));
  checkRange(spec, kept);
  values_[name] = kept;
}

void Parameters::set(const std::string& assignment) {
  const auto equals = assignment.find('=');
  if (equals == std::string::npos) throw InputError(fmt::format("expected KEY=VALUE, got '{}'", assignment));
  const std::string name = assignment.substr(0, equals), text = assignment.substr(equals + 1);
  const ParameterSpec& spec = specOf(name);
  ParameterValue value = spec.defaultValue();
  if (auto* integer = std::get_if<int64_t>(&value)) {
    double number;
    if (!readWhole(text, *integer)) refuse(spec, readWhole(text, number) ? text : shown(text));
  } else if (auto* real = std::get_if<double>(&value)) {
    if (!readWhole(text, *real)) refuse(spec, shown(text));
  } else {
    value = text;
  }
  set(name, value);
}

bool Parameters::isSet(const std::string& name) const { return values_.count(specOf(name).name) > 0; }

ParameterValue Parameters::value(const std::string& name) const {
  const auto found = values_.find(name);
  return found != values_.end() ? found->second : specOf(name).defaultValue();
}

ParameterValue Parameters::value(const ParameterSpec& spec) const {
  const auto found = values_.find(spec.name);
  return found != values_.end() ? found->second : spec.defaultValue();
}

int64_t Parameters::integer(const ParameterSpec& spec) const { return std::get<int64_t>(value(spec)); }
int64_t Parameters::integer(const std::string& name) const { return std::get<int64_t>(value(name)); }
double Parameters::real(const ParameterSpec& spec) const { return std::get<double>(value(spec)); }
std::string Parameters::text(const ParameterSpec& spec) const { return std::get<std::string>(value(spec)); }
double Parameters::real(const std::string& name) const { return std::get<double>(value(name)); }
std::string Parameters::text(const std::string& name) const { return std::get<std::string>(value(name)); }

}  // namespace copse
