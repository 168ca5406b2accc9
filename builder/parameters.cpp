// The table of parameters and the checks on values that come from outside.
#include "builder/parameters.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <numeric>

#include "builder/base/error.h"
#include "builder/bvh.h"

namespace copse {

std::span<const ParameterSpec> parameterTable() {
  static const std::vector<ParameterSpec> table{
      {"sah.traversal", 3.0, 0, 1e6, {}, "cost of a visit to an inner node (cT)"},
      {"sah.intersection", 2.0, 0, 1e6, {}, "cost of a ray-triangle test (cI)"},
      {"leaf.max", int64_t{8}, 1, maxLeafSize, {}, "most triangles in a leaf"},
      {"leaf.rule",
       std::string("sah"),
       0,
       0,
       {"sah", "count"},
       "which subtrees become leaves: sah, where it lowers the cost; count, all of at most leaf.max triangles"},
      {"morton.bits", int64_t{20}, 1, 21, {}, "bits an axis of a Morton code; 20 make the 60-bit codes of the paper"},
      {"morton.scale",
       std::string("axis"),
       0,
       0,
       {"axis", "cube"},
       "what a Morton code's cells are: the scene box cut evenly on each axis, or cubes"},
      {"hlbvh.bits",
       int64_t{15},
       1,
       15,
       {},
       "first bits of the Morton codes, of all axes, that make the clusters of the top tree"},
      {"aac.delta", int64_t{20}, 2, 1000, {}, "clusters are made of fewer boxes than this at first, half as many stay"},
      {"aac.epsilon", 0.1, 0, 0.5, {}, "of n boxes clusters stay in proportion to n^(1/2 - epsilon)"},
      {"trbvh.rounds", int64_t{3}, 0, 25, {}, "passes over the tree; each doubles the triangles below a treelet"},
      {"trbvh.treelet", int64_t{7}, 3, 7, {}, "leaves of a treelet"},
      {"atrbvh.rounds", int64_t{2}, 0, 25, {}, "passes over the tree; each doubles the triangles below a treelet"},
      {"atrbvh.treelet", int64_t{9}, 3, 20, {}, "leaves of a treelet"},
      {"kmeans.k", int64_t{8}, 2, 64, {}, "clusters that a node is split into"},
      {"kmeans.p", int64_t{5}, 1, 64, {}, "candidates drawn for each representative"},
      {"kmeans.i", int64_t{2}, 0, 100, {}, "iterations of the k-means loop; 0 takes the drawn representatives"},
      {"kmeans.m",
       int64_t{4},
       1,
       64,
       {},
       "nodes of fewer than m k triangles are split in two, not in k; the paper has 8"},
      {"kmeans.arity",
       int64_t{2},
       2,
       maxArity,
       {},
       "children of a node, at most: 2 joins clusters in pairs; more keeps them side by side, and kmeans.k follows it"},
      {"kmeans.chunk",
       int64_t{0},
       0,
       65536,
       {},
       "triangles that a team takes at a time, in whole rows of 32; 0: by size. The time depends on it, the tree does "
       "not"},
      {"kmeans.seed", int64_t{1}, 0, 4294967295.0, {}, "seed of the draws"},
      {"kmeans.seeding",
       std::string("candidates"),
       0,
       0,
       {"candidates", "plusplus"},
       "how representatives are drawn: the farthest of p candidates, as in the paper, or as k-means++ does"},
      {"kmeans.distance",
       std::string("euclid"),
       0,
       0,
       {"euclid", "manhattan", "chebyshev", "union-area"},
       "between boxes: euclid is the paper's, the sum of squares over the six coordinates"},
      {"trace.leave",
       int64_t{8},
       0,
       31,
       {},
       "on a GPU, lanes still on their way to a leaf at which those of their warp that have one no longer wait",
       false},
      {"trace.fetch", int64_t{26}, 1, 32, {}, "on a GPU, lanes with a ray below which idle ones fetch new rays", false},
      {"trace.blocks",
       int64_t{0},
       0,
       32,
       {},
       "on a GPU, blocks of four warps a multiprocessor that trace rays, at most; 0: as many as it has room for",
       false},
      {"path.queue",
       int64_t{0},
       0,
       1 << 24,
       {},
       "paths in flight, less where memory bounds them; 0: the device's own number",
       false},
  };
  return table;
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

const ParameterSpec& specOf(const std::string& name) {
  const auto table = parameterTable();
  for (const ParameterSpec& spec : table)
    if (name == spec.name) return spec;
  const auto nearest = std::min_element(table.begin(), table.end(), [&](const auto& a, const auto& b) {
    return editDistance(name, a.name) < editDistance(name, b.name);
  });
  const bool close = editDistance(name, nearest->name) <= 1 + name.size() / 3;
  throw InputError(close ? fmt::format("unknown parameter '{}': did you mean '{}'?", name, nearest->name)
                         : fmt::format("unknown parameter '{}': `list parameters` names them all", name));
}

const char* kindOf(const ParameterValue& value) {
  constexpr const char* kinds[] = {"an integer", "a number", "a word"};
  return kinds[value.index()];
}

[[noreturn]] void refuse(const ParameterSpec& spec, const std::string& given, const std::string& wanted) {
  throw InputError(fmt::format("{} = {}: {}", spec.name, given, wanted));
}

std::string textOf(const ParameterValue& value) {
  if (const auto* integer = std::get_if<int64_t>(&value)) return fmt::format("{}", *integer);
  if (const auto* real = std::get_if<double>(&value)) return fmt::format("{}", *real);
  return fmt::format("'{}'", std::get<std::string>(value));
}

void checkRange(const ParameterSpec& spec, const ParameterValue& value) {
  if (const auto* text = std::get_if<std::string>(&value)) {
    const auto same = [&](const char* choice) { return *text == choice; };
    if (std::none_of(spec.choices.begin(), spec.choices.end(), same))
      refuse(spec, textOf(value), fmt::format("one of {}", fmt::join(spec.choices, ", ")));
    return;
  }
  const auto* integer = std::get_if<int64_t>(&value);
  const double number = integer ? static_cast<double>(*integer) : std::get<double>(value);
  if (!(number >= spec.least && number <= spec.most))
    refuse(spec, textOf(value),
           fmt::format("{} from {:.10g} to {:.10g}", kindOf(spec.defaultValue), spec.least, spec.most));
}

template <class T>
bool readWhole(const std::string& text, T& value) {
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size();
}

}  // namespace

void Parameters::set(const std::string& name, const ParameterValue& value) {
  const ParameterSpec& spec = specOf(name);
  ParameterValue kept = value;
  if (const auto* integer = std::get_if<int64_t>(&value); integer && std::holds_alternative<double>(spec.defaultValue))
    kept = static_cast<double>(*integer);
  if (kept.index() != spec.defaultValue.index())
    refuse(spec, textOf(value), fmt::format("{} is wanted, not {}", kindOf(spec.defaultValue), kindOf(value)));
  checkRange(spec, kept);
  values_[name] = kept;
}

void Parameters::set(const std::string& assignment) {
  const auto equals = assignment.find('=');
  if (equals == std::string::npos) throw InputError(fmt::format("'{}': KEY=VALUE is wanted", assignment));
  const std::string name = assignment.substr(0, equals), text = assignment.substr(equals + 1);
  const ParameterSpec& spec = specOf(name);
  ParameterValue value = spec.defaultValue;
  if (auto* integer = std::get_if<int64_t>(&value)) {
    if (!readWhole(text, *integer)) refuse(spec, textOf(text), "an integer is wanted");
  } else if (auto* real = std::get_if<double>(&value)) {
    if (!readWhole(text, *real)) refuse(spec, textOf(text), "a number is wanted");
  } else {
    value = text;
  }
  set(name, value);
}

bool Parameters::isSet(const std::string& name) const { return values_.count(specOf(name).name) > 0; }

ParameterValue Parameters::value(const std::string& name) const {
  const auto found = values_.find(name);
  return found != values_.end() ? found->second : specOf(name).defaultValue;
}

int64_t Parameters::integer(const std::string& name) const { return std::get<int64_t>(value(name)); }
double Parameters::real(const std::string& name) const { return std::get<double>(value(name)); }
std::string Parameters::text(const std::string& name) const { return std::get<std::string>(value(name)); }

}  // namespace copse
