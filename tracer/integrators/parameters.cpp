// The parameters of builders, tracers and the path tracer.
#include "tracer/integrators/parameters.h"

#include "builder/collapse/wide.h"
#include "tracer/accel/persistent.h"
#include "tracer/integrators/path/path_tracer.h"

namespace copse {

std::span<const ParameterSpec> tracerParameters() {
  static const std::vector<ParameterSpec> table = [] {
    const std::span<const ParameterSpec> ofBuilders = builderParameters();
    std::vector<ParameterSpec> all(ofBuilders.begin(), ofBuilders.end());
    for (const auto& room : {wideParameters(), traceParameters(), pathParameters()})
      all.insert(all.end(), room.begin(), room.end());
    return all;
  }();
  return table;
}

}  // namespace copse
