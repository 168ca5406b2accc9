// A generated scene, a tree and a small picture of it, by the names of an installed copse::tracer.
#include <cstdio>

#include "builder/build.h"
#include "tracer/accel/tracers.h"
#include "tracer/generators/generators.h"
#include "tracer/image/image_io.h"
#include "tracer/integrators/path/path_tracer.h"

int main() {
  using namespace copse;
  const Device device = openDevice("cpu");
  const Scene scene = findGenerator("cornell").generate(38, 1);
  const auto uploaded = uploadScene(device, scene);
  const BuilderEntry& builder = findBuilder("lbvh");
  const Bvh tree = buildBvh(device, trianglesOf(*uploaded), builder, withPreset(builder, {}));
  const auto tracer = makeTracer(device, tree, trianglesOf(*uploaded));
  RenderSettings settings;
  settings.width = 32;
  settings.height = 24;
  const PathResult result = renderPath(device, *uploaded, *tracer, findCamera(scene, ""), settings);
  writeExr("picture.exr", result.image, {});
  if (hasOpenImageIO()) writePng("picture.png", result.image);
  float brightest = 0;
  for (const vec3& pixel : result.image.pixels) brightest = pixel.x > brightest ? pixel.x : brightest;
  std::printf("%llu rays, brightest pixel %.2f\n", static_cast<unsigned long long>(result.rays.primary), brightest);
  return brightest > 0 ? 0 : 1;
}
