// A court open to the sky, with the character of Dabrovic's Sponza: two storeys of arcades around it, very large
// triangles in floors and walls beside very small ones in leaves and mouldings, long thin ones in cables and cornices.
// The detail is searched so that the parts come to a little less than the count asked for; leaves make up the rest.
#include "tracer/generators/atrium.h"

#include "tracer/generators/generate.h"

namespace copse::generator {

namespace {

constexpr uint32_t minTriangles = 5'000, maxTriangles = 50'000'000;

void buildParts(Atrium& atrium) {
  buildShell(atrium);
  buildArcade(atrium);
  buildGallery(atrium);
  buildRoof(atrium);
  buildFabric(atrium);
  buildGarden(atrium);
}

uint64_t countAt(double detail, uint64_t seed) {
  MeshBuilder counter(nullptr);
  Atrium atrium{{detail, seed}, counter};
  buildParts(atrium);
  return counter.count();
}

std::vector<Material> makeMaterials() {
  std::vector<Material> all(stuffs);
  const auto set = [&](Stuff stuff, const char* name, vec3 kd) {
    all[stuff].name = name;
    all[stuff].kd = kd;
  };
  set(stone, "stone", {0.66f, 0.55f, 0.41f});
  set(paleStone, "pale_stone", {0.74f, 0.66f, 0.53f});
  set(darkStone, "dark_stone", {0.36f, 0.30f, 0.23f});
  set(plaster, "plaster", {0.76f, 0.62f, 0.43f});
  set(terracotta, "terracotta", {0.55f, 0.25f, 0.14f});
  set(slabPale, "slab_pale", {0.62f, 0.57f, 0.49f});
  set(slabDark, "slab_dark", {0.40f, 0.35f, 0.30f});
  set(marble, "marble", {0.80f, 0.78f, 0.73f});
  set(wood, "wood", {0.27f, 0.16f, 0.09f});
  set(bronze, "bronze", {0.30f, 0.20f, 0.09f});
  set(red, "red_cloth", {0.55f, 0.05f, 0.04f});
  set(blue, "blue_cloth", {0.06f, 0.13f, 0.42f});
  set(green, "green_cloth", {0.07f, 0.28f, 0.12f});
  set(gold, "gold_cloth", {0.72f, 0.47f, 0.12f});
  set(leaf, "leaf", {0.10f, 0.27f, 0.05f});
  set(paleLeaf, "pale_leaf", {0.26f, 0.42f, 0.08f});
  set(soil, "soil", {0.10f, 0.07f, 0.04f});
  set(water, "water", {0.10f, 0.27f, 0.30f});
  set(rope, "rope", {0.22f, 0.17f, 0.11f});
  set(glass, "lantern_glass", {0.85f, 0.74f, 0.50f});
  return all;
}

void addLightAndCameras(Scene& scene) {
  scene.sky = SkyLight{.radiance = {0.8f, 1.0f, 1.3f}, .file = {}, .image = {}};
  // The sun: 3.5 m wide, 75 m away, 2.7 degrees: five times the real one, for soft edges that few samples resolve.
  const dvec3 to = glm::normalize(dvec3(-0.30, 1, -0.55)), centre = dvec3(0, 3, 0) + 75.0 * to;
  const dvec3 u = glm::normalize(glm::cross(to, dvec3(1, 0, 0))), v = glm::cross(to, u);
  const double side = 3.5;
  // cross(v, u) is -to: it shines down.
  scene.quads.push_back({vec3(centre - 0.5 * side * (u + v)), vec3(side * v), vec3(side * u), {2450, 2100, 1580}});

  scene.cameras = {{"nave", {-11.7f, 1.7f, -0.9f}, {0, 3.35f, 0.35f}, {0, 1, 0}, 62},
                   {"gallery", {-11.9f, 7.9f, -4.45f}, {-1.0f, 2.5f, 1.4f}, {0, 1, 0}, 60},
                   {"arcade", {-11.6f, 1.65f, 7.3f}, {0, 2.15f, 6.2f}, {0, 1, 0}, 58}};
}

}  // namespace

Scene generateAtrium(uint32_t triangles, uint64_t seed) {
  checkRange("atrium", triangles, minTriangles, maxTriangles);
  Scene scene;
  scene.name = "atrium";
  scene.materials = makeMaterials();
  scene.positions.reserve(triangles / 10 * 8);
  scene.triangles.reserve(triangles);
  scene.materialOf.reserve(triangles);

  MeshBuilder mesh(&scene);
  const double detail = findDetail(triangles - triangles / 20, [&](double tried) { return countAt(tried, seed); });
  Atrium atrium{{detail, seed}, mesh};
  buildParts(atrium);
  buildLeaves(atrium, triangles - mesh.count());
  addLightAndCameras(scene);
  return scene;
}

}  // namespace copse::generator
