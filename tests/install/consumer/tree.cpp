// Triangles in, tree out, by the names of an installed copse::builder.
#include <cstdio>

#include "builder/build.h"

int main() {
  using namespace copse;
  const Device device = openDevice("cpu");
  std::vector<vec3> corners;
  std::vector<uvec3> triangles;
  for (uint32_t i = 0; i < 100; ++i) {
    for (const vec3 corner : {vec3(0, 0, 0), vec3(1, 0, 0), vec3(0, 1, 0)})
      corners.push_back(corner + vec3(static_cast<float>(i), 0, 0));
    triangles.emplace_back(3 * i, 3 * i + 1, 3 * i + 2);
  }
  const Buffer<vec3> positions(device, corners);
  const Buffer<uvec3> indices(device, triangles);
  const TrianglesView view{positions.data(), indices.data(), 100};

  const BuilderEntry& builder = findBuilder("lbvh");
  Parameters parameters;
  parameters.set("leaf.max=1");
  parameters = withPreset(builder, parameters);
  const Bvh tree = buildBvh(device, view, builder, parameters);
  validate(device, tree, view, 1);
  const TreeStatistics figures = statistics(device, tree, parameters);
  std::printf("%u leaves, SAH cost %.2f\n", figures.leaves, figures.sahCost);
  return figures.leaves == 100 ? 0 : 1;
}
