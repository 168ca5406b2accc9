// A conference room with the character and count of Ward and Grynberg's: an oval table with chairs around it, curtains,
// panelled walls, and lamps in the ceiling that are its only light. Everything fits into one closed box, most of it
// finely cut furniture, little of it walls.
#include "tracer/generators/generate.h"
#include "tracer/generators/indoor.h"

namespace copse::generator {

namespace {

constexpr uint32_t minTriangles = 20'000, maxTriangles = 50'000'000;
constexpr double halfX = 8, halfZ = 4.6, high = 3.5;
constexpr double tableX = 4.3, tableZ = 1.25;

double power(double x, double e) { return x < 0 ? -std::pow(-x, e) : std::pow(x, e); }

/// Where the table's edge is at angle a: an ellipse drawn towards a rectangle.
dvec2 edge(double a) { return {tableX * power(std::cos(a), 0.62), tableZ * power(std::sin(a), 0.62)}; }

void buildShell(Indoor& room) {
  MeshBuilder& mesh = room.mesh;
  const Frame f;
  mesh.use(carpet);
  mesh.box(f, {-halfX, -0.2, -halfZ}, {halfX, 0, halfZ});
  room.ceiling(f.at(0, high, 0), halfX, halfZ, 1.7, 4, {1.5, 0.66}, 8);
  mesh.use(wallPaint);
  mesh.box(f, {-halfX - 0.2, -0.2, -halfZ - 0.2}, {-halfX, high + 0.2, halfZ + 0.2});
  mesh.box(f, {halfX, -0.2, -halfZ - 0.2}, {halfX + 0.2, high + 0.2, halfZ + 0.2});
  mesh.box(f, {-halfX, -0.2, -halfZ - 0.2}, {halfX, high + 0.2, -halfZ});
  mesh.box(f, {-halfX, -0.2, halfZ}, {halfX, high + 0.2, halfZ + 0.2});

  // Beams below the ceiling, skirting, and panels of wood on the wall across from the windows.
  mesh.use(oak);
  for (int i = -4; i <= 4; i += 2)
    mesh.box(f, {2 * i - 0.07, high - 0.16, -halfZ}, {2 * i + 0.07, high - 0.001, halfZ});
  mesh.use(walnut);
  for (const double z : {-halfZ, halfZ - 0.02}) mesh.box(f, {-halfX, 0, z}, {halfX, 0.12, z + 0.02});
  for (const double x : {-halfX, halfX - 0.02}) mesh.box(f, {x, 0, -halfZ}, {x + 0.02, 0.12, halfZ});
  for (int i = 0; i < 12; ++i) {
    const double x0 = -halfX + 0.15 + 1.31 * i, x1 = x0 + 1.2;
    mesh.use(walnut);
    mesh.box(f, {x0, 0.16, halfZ - 0.03}, {x1, 1.0, halfZ});
    const uint32_t steps = room.segments(5, 1, 0x100 + i);  // A moulded field in each.
    const Frame panel{{0.5 * (x0 + x1), 0.58, halfZ - 0.03}};
    for (int s = 0; s < 4; ++s) {
      const Frame side{
          panel.origin, s % 2 ? dvec3(0, 1, 0) : dvec3(1, 0, 0), s % 2 ? dvec3(1, 0, 0) : dvec3(0, 1, 0), {0, 0, -1}};
      const double half = s % 2 ? 0.36 : 0.54, out = (s < 2 ? 1 : -1) * (s % 2 ? 0.54 : 0.36);
      mesh.grid(steps, steps, [&](double u, double v) {
        return side((2 * u - 1) * (half - 0.04 * v), out * (1 - (0.04 / std::abs(out)) * v),
                    0.014 * std::sin(pi * v) + 0.001);
      });
    }
    mesh.use(walnut);
    mesh.box(f, {-halfX, 1.04, halfZ - 0.05}, {halfX, 1.09, halfZ});
  }
}

void buildTable(Indoor& room) {
  MeshBuilder& mesh = room.mesh;
  const uint32_t around = room.segments(120, 16, 0x200), round = room.segments(5, 1, 0x201);
  // The top is a ring around an opening; its outer edge is round.
  const auto ring = [&](double s0, double y0, double s1, double y1, uint32_t n, bool bulge) {
    mesh.grid(
        around, n,
        [&](double u, double v) {
          const dvec2 e = edge(2 * pi * (u + 0.0031));
          const double s = s0 + (s1 - s0) * v, out = bulge ? 0.02 * std::sin(pi * v) : 0;
          return dvec3(e.x * s + (e.x > 0 ? out : -out), y0 + (y1 - y0) * v, e.y * s + (e.y > 0 ? out : -out));
        },
        true);
  };
  mesh.use(walnut);
  ring(0.995, 0.74, 0.45, 0.74, room.segments(8, 1, 0x202), false);
  ring(1, 0.69, 0.995, 0.74, round, true);
  ring(0.45, 0.69, 1, 0.69, 1, false);
  ring(0.45, 0.74, 0.45, 0.69, 1, false);
  mesh.use(oak);
  ring(0.62, 0, 0.58, 0.69, room.segments(6, 1, 0x203), false);
}

/// A seat's place at the table: papers, a mug or a bottle, a pen, a microphone on a stalk.
void buildPlace(Indoor& room, const Frame& f, uint64_t id) {
  MeshBuilder& mesh = room.mesh;
  Random random = room.random(id);
  const double which = random.next();
  room.papers(f.at(0, 0, 0.28), 2 + static_cast<uint32_t>(3 * which), 0.15, 0.06, id + 1);
  if (which < 0.6) room.mug(f.at(0.27, 0, 0.17), id + 2);
  if (which > 0.4) room.bottle(f.at(-0.26, 0, 0.12), id + 3);
  mesh.use(blackPlastic);
  mesh.tube({f(0.13, 0.008, 0.2), f(0.17, 0.008, 0.32)}, 0.004, room.segments(8, 3, id + 4));
  mesh.lathe(f.at(0, 0, 0.02),
             Profile(0.05, 0).to(0.05, 0.015).ease(0.01, 0.035, room.segments(4, 1, id + 5)).to(0, 0.036),
             room.segments(18, 5, id + 6));
  std::vector<dvec3> stalk;
  const uint32_t bends = room.segments(10, 2, id + 7);
  for (uint32_t i = 0; i <= bends; ++i) {
    const double t = static_cast<double>(i) / bends;
    stalk.push_back(f(0, 0.03 + 0.3 * t, 0.02 + 0.1 * t * t));
  }
  mesh.bentTube(stalk, 0.004, room.segments(7, 3, id + 8));
  mesh.use(steel);
  room.cushion(f.at(0, 0.34, 0.125), {0.011, 0.02, 0.014}, 1, 8, id + 9);
}

void buildSeats(Indoor& room) {
  // The chairs of a round are placed by angle, denser on the long sides than an ellipse would have them.
  constexpr int seats = 26;
  for (int i = 0; i < seats; ++i) {
    const uint64_t id = 0x1000 + 0x40 * static_cast<uint64_t>(i);
    Random random = room.random(id);
    const double s = (i + 0.5) / seats, a = 2 * pi * s - 0.18 * std::sin(4 * pi * s);
    const dvec2 e = edge(a), n = glm::normalize(dvec2(e.x * 0.16, e.y));
    const double away = random.between(0.22, 0.42), turn = random.between(-0.22, 0.22);
    Frame f;
    f.origin = {e.x + n.x * away, 0, e.y + n.y * away};
    f.z = {-n.x, 0, -n.y};
    f.x = glm::cross(f.y, f.z);
    room.armchair(f.turned(turn), i % 13 == 6 ? leather : redFabric, id + 1);
    f.origin = {e.x - n.x * 0.5, 0.7405, e.y - n.y * 0.5};
    f.z = {n.x, 0, n.y};
    f.x = glm::cross(f.y, f.z);
    buildPlace(room, f, id + 0x20);
  }
  for (int i = 0; i < 8; ++i)  // A row along the panelled wall.
    room.armchair(Frame{{-4.4 + 0.8 * i + (i > 3 ? 2.6 : 0), 0, halfZ - 0.55}}.turned(pi), blueFabric,
                  0x2000 + 0x20 * static_cast<uint64_t>(i));
}

void buildFittings(Indoor& room) {
  MeshBuilder& mesh = room.mesh;
  // The windows' wall: five pairs of curtains in front of panes and blinds.
  for (int i = 0; i < 5; ++i) {
    const uint64_t id = 0x3000 + 0x80 * static_cast<uint64_t>(i);
    const double x = -6.2 + 3.1 * i;
    mesh.use(pane);
    mesh.quad({x - 0.9, 0.8, -halfZ + 0.02}, {x + 0.9, 0.8, -halfZ + 0.02}, {x + 0.9, 2.9, -halfZ + 0.02},
              {x - 0.9, 2.9, -halfZ + 0.02});
    room.window(Frame{{x, 0.8, -halfZ + 0.06}}, 1.8, 2.1, id);
    room.blinds(Frame{{x, 0.8, -halfZ + 0.14}}, 1.7, 2.1, 0.35 + 0.13 * ((i * 7) % 5), id + 1);
    room.curtain(Frame{{x - 1.05, 0.03, -halfZ + 0.3}}, 1.0, 2.95, drapery, id + 0x40);
    room.curtain(Frame{{x + 1.05, 0.03, -halfZ + 0.3}}, 1.0, 2.95, drapery, id + 0x50);
    room.radiator(Frame{{x, 0, -halfZ + 0.12}}, 0.9, id + 0x60);
  }
  for (int i = 0; i < 16; ++i) {  // Small unlit spots between them.
    mesh.use(steel);
    mesh.lathe(Frame{{-7.4 + 2.2 * (i % 8) - 0.3, high - 0.05, i < 8 ? -3.7 : 3.7}},
               Profile(0.09, 0).to(0.1, 0.05).to(0.07, 0.045).to(0.06, 0.02).to(0, 0.03),
               room.segments(20, 6, 0x4100 + static_cast<uint64_t>(i)));
  }
  // End walls: a screen, a lectern, a clock; two doors, a bookcase, a sideboard, plants, pictures.
  const Frame west = Frame{{-halfX + 0.03, 0, 0}}.turned(0.5 * pi),
              east = Frame{{halfX - 0.03, 0, 0}}.turned(-0.5 * pi);
  mesh.use(sheet);
  mesh.box(west, {-1.6, 1.0, 0}, {1.6, 2.8, 0.03});
  mesh.use(steel);
  mesh.tube({west(-1.7, 2.84, 0.03), west(1.7, 2.84, 0.03)}, 0.045, room.segments(16, 5, 0x5000));
  mesh.use(oak);
  const Frame lectern = west.at(2.6, 0, 0.9).turned(-0.4);
  mesh.box(lectern, {-0.3, 0, -0.22}, {0.3, 1.05, 0.22});
  mesh.box(lectern.at(0, 1.06, 0), {-0.36, 0, -0.28}, {0.36, 0.04, 0.28});
  room.papers(lectern.at(0, 1.1, 0), 3, 0.1, 0.1, 0x5001);
  room.clock(west.at(0, 3.12, 0), 0x5002);
  for (const double x : {-3.2, 3.2})
    room.pottedPlant(west.at(x, 0, 0.5), 1.5, 0x5100 + static_cast<uint64_t>(x * 10 + 100));
  room.door(east.at(-2.6, 0, 0.06), 1.0, 2.15, 0.0, 0x5200);
  room.door(east.at(2.6, 0, 0.06), 1.0, 2.15, 0.0, 0x5210);
  room.bookcase(east.at(0, 0, 0.2), 2.4, 2.1, 0x5300);
  room.cabinet(east.at(-1.75, 0, 0.32), 0.5, 0.8, 3, 0x5400);
  room.pottedPlant(east.at(-1.75, 0.8, 0.32), 0.7, 0x5500);
  for (int i = 0; i < 5; ++i)
    room.picture(Frame{{-5.6 + 2.8 * i, 1.95, halfZ - 0.02}}.turned(pi), i % 2 ? 0.9 : 1.3, 0.9,
                 i % 2 ? clothBlue : clothTan);
  room.deskLamp(Frame{{-2.2, 0.74, 0.0}}, 0x5600);
  room.bin(Frame{{halfX - 0.4, 0, 3.6}}, 0x5700);
}

void buildAll(Indoor& room) {
  buildShell(room);
  buildTable(room);
  buildSeats(room);
  buildFittings(room);
}

}  // namespace

Scene generateConference(uint32_t triangles, uint64_t seed) {
  checkRange("conference", triangles, minTriangles, maxTriangles);
  const double detail = findDetail(triangles, [&](double tried) {
    MeshBuilder counter(nullptr);
    Indoor room{{tried, seed}, counter};
    buildAll(room);
    return counter.count();
  });
  Scene scene;
  scene.name = "conference";
  scene.materials = indoorMaterials();
  scene.positions.reserve(triangles / 10 * 8);
  scene.triangles.reserve(triangles);
  scene.materialOf.reserve(triangles);
  MeshBuilder mesh(&scene);
  Indoor room{{detail, seed}, mesh};
  buildAll(room);
  // What is missing lies on the floor by the lectern as sheets of paper: a pile of hand-outs.
  room.papers(Frame{{-halfX + 1.2, 0.001, 1.6}}, static_cast<uint32_t>((triangles - mesh.count()) / 2), 0.04, 0.04,
              0x6000);
  dropUnusedMaterials(scene);
  scene.cameras = {{"table", {7.1f, 1.75f, 1.5f}, {-1.5f, 0.85f, -0.6f}, {0, 1, 0}, 52},
                   {"seat", {-2.6f, 1.25f, 2.5f}, {3.4f, 0.85f, -2.2f}, {0, 1, 0}, 55},
                   {"corner", {-7.4f, 2.9f, 4.0f}, {0.6f, 0.5f, -1.0f}, {0, 1, 0}, 58}};
  return scene;
}

}  // namespace copse::generator
