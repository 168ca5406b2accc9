// Furnished floors, with the character and count of Berkeley's Soda Hall: storeys of rooms along corridors. Few huge
// triangles in floors, walls and ceilings, masses of small ones in what stands between them, nearly all of it along the
// axes. A wing has at most 52 rooms per storey and eight storeys; more triangles make more rooms, then more wings.
#include "tracer/generators/office.h"

#include "tracer/generators/generate.h"

namespace copse::generator {

namespace {

constexpr uint32_t minTriangles = 20'000, maxTriangles = 50'000'000, perRoom = 8'200;

Office planFor(uint32_t triangles) {
  const double rooms = std::max(4.0, static_cast<double>(triangles) / perRoom);
  Office plan;
  plan.storeys = std::clamp(static_cast<int>(std::lround(std::sqrt(rooms) / 2.7)), 1, 8);
  const double along = rooms / (2 * plan.storeys);
  plan.wings = std::max(1, static_cast<int>(std::ceil(along / 26)));
  plan.along = std::max(2, static_cast<int>(along / plan.wings));
  return plan;
}

}  // namespace

Scene generateOffice(uint32_t triangles, uint64_t seed) {
  checkRange("office", triangles, minTriangles, maxTriangles);
  const Office plan = planFor(triangles);
  const double detail = findDetail(
      triangles,
      [&](double tried) {
        MeshBuilder counter(nullptr);
        Indoor indoor{{tried, seed}, counter};
        buildOffice(indoor, plan);
        return counter.count();
      },
      20);
  Scene scene;
  scene.name = "office";
  scene.materials = indoorMaterials();
  scene.positions.reserve(triangles / 10 * 9);
  scene.triangles.reserve(triangles);
  scene.materialOf.reserve(triangles);
  MeshBuilder mesh(&scene);
  Indoor indoor{{detail, seed}, mesh};
  buildOffice(indoor, plan);
  // What is missing lies on the desks of the view's room as sheets.
  indoor.papers(deskTop(plan), static_cast<uint32_t>((triangles - mesh.count()) / 2), 0.06, 0.05, 0xf00d);
  dropUnusedMaterials(scene);

  const float y = static_cast<float>(storeyHeight * plan.litStorey()), length = static_cast<float>(plan.length());
  const Frame room = plan.room(0, plan.litStorey(), 1, 0);
  const auto inRoom = [&](double a, double b, double c) { return vec3(room(a, b, c)); };
  scene.cameras = {
      {"room", inRoom(-1.62, 1.62, -2.35), inRoom(0.75, 0.82, 1.6), {0, 1, 0}, 62},
      {"corridor", {1.9f, y + 1.62f, 0.45f}, {11, y + 1.25f, -0.3f}, {0, 1, 0}, 58},
      {"street", {-11, 2.0f, 23}, {0.2f * length, 1.9f * static_cast<float>(plan.storeys), 4}, {0, 1, 0}, 52}};
  // Night: a little light from the sky, and lamps over the street.
  scene.sky = SkyLight{.radiance = {0.008f, 0.011f, 0.02f}, .file = {}, .image = {}};
  for (float x = 2; x < std::min(length, 60.0f); x += 22)
    scene.quads.push_back(lampAt({x, 6, 20}, {x, 7, 6}, 0.5f, {400, 340, 255}));
  return scene;
}

}  // namespace copse::generator
