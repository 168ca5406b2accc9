// The build functions that the registry lists, one a file of this folder. Each takes boxes and gives a tree of one
// primitive a leaf; none looks at the triangles themselves.
#pragma once

#include "builder/registry.h"

namespace copse {

Bvh buildLbvh(const Device& device, const BuildInput& input, const Parameters& parameters);
Bvh buildLbvhApetrei(const Device& device, const BuildInput& input, const Parameters& parameters);
Bvh buildHlbvh(const Device& device, const BuildInput& input, const Parameters& parameters);
Bvh buildTrbvh(const Device& device, const BuildInput& input, const Parameters& parameters);
Bvh buildAtrbvh(const Device& device, const BuildInput& input, const Parameters& parameters);
Bvh buildKmeans(const Device& device, const BuildInput& input, const Parameters& parameters);
Bvh buildAac(const Device& device, const BuildInput& input, const Parameters& parameters);
Bvh buildSah(const Device& device, const BuildInput& input, const Parameters& parameters);

}  // namespace copse
