// A power plant with the character and count of the University of North Carolina's: levels of gratings in a steel frame
// full of pipes, machines, ducts, cables and stairs around a furnace of tubes, a stack and tanks beside it. Most of its
// triangles are long, thin and close to others. More triangles make a larger frame.
#include "tracer/generators/plant.h"

#include "tracer/generators/generate.h"

namespace copse::generator {

namespace {

constexpr uint32_t minTriangles = 40'000, maxTriangles = 50'000'000, perCell = 25'000;

std::vector<Material> makeMaterials() {
  std::vector<Material> all(metals);
  const auto set = [&](Metal metal, const char* name, vec3 kd) {
    all[metal].name = name;
    all[metal].kd = kd;
  };
  set(oxide, "red_oxide_steel", {0.33f, 0.15f, 0.1f});
  set(galvanised, "galvanised", {0.5f, 0.52f, 0.53f});
  set(lagging, "lagging", {0.66f, 0.66f, 0.64f});
  set(greenPipe, "green_pipe", {0.1f, 0.33f, 0.17f});
  set(redPipe, "red_paint", {0.55f, 0.07f, 0.05f});
  set(yellowPipe, "yellow_paint", {0.72f, 0.53f, 0.06f});
  set(bluePipe, "blue_paint", {0.08f, 0.2f, 0.45f});
  set(whiteTank, "white_paint", {0.76f, 0.75f, 0.72f});
  set(rust, "rust", {0.34f, 0.19f, 0.11f});
  set(darkIron, "dark_iron", {0.12f, 0.12f, 0.13f});
  set(orange, "orange_paint", {0.66f, 0.26f, 0.05f});
  set(cable, "cable", {0.06f, 0.06f, 0.065f});
  set(tarmac, "tarmac", {0.13f, 0.13f, 0.135f});
  set(gravel, "gravel", {0.36f, 0.34f, 0.3f});
  set(brick, "brick", {0.45f, 0.22f, 0.15f});
  return all;
}

void layOut(Plant& plant, uint32_t triangles) {
  const double cells = std::max(2.0, static_cast<double>(triangles) / perCell);
  plant.levels = std::clamp(static_cast<int>(std::lround(0.85 * std::cbrt(cells))), 1, 10);
  const double floor = cells / plant.levels;
  plant.nz = std::max(1, static_cast<int>(std::lround(std::sqrt(0.5 * floor))));
  plant.nx = std::max(2, static_cast<int>(floor / plant.nz));
}

void buildMachines(Plant& plant) {
  for (int iy = 0; iy < plant.levels; ++iy)
    for (int ix = 0; ix < plant.nx; ++ix)
      for (int iz = 0; iz < plant.nz; ++iz) {
        if (plant.furnaceAt(ix, iz)) continue;
        const uint64_t id = 0x20000000ull + 0x1000ull * static_cast<uint64_t>((iy * 128 + ix) * 128 + iz);
        Random random = plant.random(id);
        const Frame place = plant.cell(ix, iy, iz).at(0.5 * cellSize, 0.01, 3.7);
        // First rows have a stairwell: what stands there is narrow or beside it.
        switch (random.below(7)) {
          case 0:
            plant.vessel(place, id);
            break;
          case 1:
            plant.exchanger(place, id);
            break;
          case 2:
            plant.pumps(place, id);
            break;
          case 3:
            plant.manifold(place, id);
            break;
          case 4:
            plant.cabinets(place, id);
            plant.manifold(place.at(0, 0, 1.6), id + 0x400);
            break;
          case 5:
            plant.fan(place, id);
            break;
          default:
            plant.manifold(place.at(0, 0, -1.0), id);
            plant.manifold(place.at(0, 0, 1.0), id + 0x400);
            break;
        }
      }
}

void buildAll(Plant& plant) {
  plant.buildYard();
  plant.buildSteel();
  plant.buildPipeRacks();
  buildMachines(plant);
  plant.buildFurnace();
}

}  // namespace

Scene generatePlant(uint32_t triangles, uint64_t seed) {
  checkRange("plant", triangles, minTriangles, maxTriangles);
  const double detail = findDetail(
      triangles,
      [&](double tried) {
        MeshBuilder counter(nullptr);
        Plant plant{{tried, seed}, counter};
        layOut(plant, triangles);
        buildAll(plant);
        return counter.count();
      },
      20);
  Scene scene;
  scene.name = "plant";
  scene.materials = makeMaterials();
  scene.positions.reserve(triangles / 10 * 8);
  scene.triangles.reserve(triangles);
  scene.materialOf.reserve(triangles);
  MeshBuilder mesh(&scene);
  Plant plant{{detail, seed}, mesh};
  layOut(plant, triangles);
  buildAll(plant);
  // What is missing is a bundle of rods on the ground by the tanks: four triangles each.
  mesh.use(rust);
  const uint64_t rods = (triangles - mesh.count()) / 4;
  for (uint64_t i = 0; i < rods; ++i) {
    const Frame rod{{-6 - 0.03 * static_cast<double>(i % 60), 0.02 + 0.026 * static_cast<double>(i / 60), -24}};
    mesh.quad(rod(0, 0, 0), rod(0.01, 0.012, 0), rod(0.01, 0.012, 6), rod(0, 0, 6));
    mesh.quad(rod(0.01, 0.012, 0), rod(0.02, 0, 0), rod(0.02, 0, 6), rod(0.01, 0.012, 6));
  }

  const float x = static_cast<float>(plant.lengthX()),
              y = static_cast<float>(levelHeight) * static_cast<float>(plant.levels);
  const float floor = static_cast<float>(levelHeight) * static_cast<float>(std::min(1, plant.levels - 1));
  scene.cameras = {
      {"yard", {-0.28f * x - 6, 0.3f * y + 4, -0.55f * x - 14}, {0.46f * x, 0.5f * y, 0.2f * x}, {0, 1, 0}, 48},
      {"walkway", {0.7f, floor + 1.75f, 0.72f}, {12, floor + 1.9f, 2.9f}, {0, 1, 0}, 62},
      {"road", {0.2f * x - 5, 1.8f, -8}, {0.42f * x, 0.5f * y + 2, 2}, {0, 1, 0}, 60}};
  scene.sky = SkyLight{.radiance = {0.42f, 0.54f, 0.74f}, .file = {}, .image = {}};
  // The sun from the front left, large for soft edges that few samples resolve.
  const float far = 2.2f * (x + y) + 60;
  scene.quads = {lampAt(vec3(0.4f * x, 0, 0) + far * glm::normalize(vec3(-0.55f, 0.8f, -0.75f)),
                        {0.4f * x, 0.4f * y, 0}, 0.06f * far, {700, 620, 480})};
  return scene;
}

}  // namespace copse::generator
