// Places and colours, made once from the registry. Colours that the colour-blind can tell apart (Okabe and Ito 2008)
// come first.
#include "tracer/report/builders.h"

#include <algorithm>
#include <iterator>
#include <map>
#include <vector>

#include "tracer/accel/tracers.h"
#include "tracer/integrators/parameters.h"

namespace copse::report {

namespace {

constexpr unsigned unknownColor = 0xa7adb4;

/// A family's colour and its shades: its first builder has the first, and one for which there is none left as well.
using Shades = std::vector<unsigned>;

const Shades baselineShades{0xf0a070, 0xe07a3c, 0xd55e00};

const Shades& shadesOf(std::size_t family) {
  static const Shades all[] = {
      {0x8a8f96, 0xb5b9be},           {0xe69f00, 0xb87f00, 0xf0c060},
      {0x5cc2a3, 0x009e73, 0x006b4e}, {0xdc9fbf, 0xb0578a, 0x7d3a60},
      {0x000000, 0x3c444d},           {0x3d8fc9, 0x9ccdee, 0x6fb3e0, 0x3d8fc9, 0x0072b2, 0x00476f},
      {0x9a8c00, 0xc9bd3f, 0x6b6200}, {0x7a5195, 0xa98bbf, 0x533566},
      {0x8c564b, 0xb88c84, 0x5f372f}, {0x2f9ea8, 0x7cc5cb, 0x1b6a71},
      {0xb23a48, 0xd58891, 0x7a2530}};
  return all[family % std::size(all)];
}

struct Known {
  int rank;
  unsigned color;
  const Method* method;  ///< Null: a baseline.
};

const Known* find(const std::string& builder) {
  static const std::map<std::string, Known> known = [] {
    std::map<std::string, Known> names;
    std::vector<std::string> families;
    std::map<std::string, std::size_t> members;
    int rank = 0;
    for (const BuilderEntry& entry : builders()) {
      const std::string family = entry.method->family ? entry.method->family : entry.method->name;
      const auto place = std::ranges::find(families, family);
      const Shades& shades = shadesOf(static_cast<std::size_t>(place - families.begin()));
      if (place == families.end()) families.push_back(family);
      const std::size_t member = members[family]++;
      names[entry.name] = {rank++, shades[member < shades.size() ? member : 0], entry.method};
    }
    std::size_t i = 0;
    for (const TracerEntry& tracer : tracers())
      for (const OwnTree& tree : tracer.ownTrees)
        names[tree.name] = {rank++, baselineShades[i++ % baselineShades.size()], nullptr};
    return names;
  }();
  const auto found = known.find(builder);
  return found == known.end() ? nullptr : &found->second;
}

bool declares(const Method& method, const std::string& parameter) {
  return std::ranges::any_of(method.parameters, [&](const ParameterSpec& spec) { return parameter == spec.name; });
}

}  // namespace

int builderRank(const std::string& builder) {
  if (builder == idealBuilder) return -1;
  const Known* const known = find(builder);
  return known ? known->rank : 1 << 20;
}

unsigned builderColor(const std::string& builder) {
  const Known* const known = find(builder);
  return known ? known->color : unknownColor;
}

bool readsParameter(const std::string& builder, const std::string& parameter) {
  const Known* const known = find(builder);
  return known && known->method && declares(*known->method, parameter);
}

bool isOfOneMethod(const std::string& parameter) {
  return std::ranges::any_of(methods::all(), [&](const Method& method) { return declares(method, parameter); });
}

bool isOfTracer(const std::string& parameter) {
  return std::ranges::any_of(tracerParameters(),
                             [&](const ParameterSpec& spec) { return !spec.ofTree && parameter == spec.name; });
}

}  // namespace copse::report
