// The office's shell: slabs, walls with doors and windows, corridors, stairs, roofs, and the street.
#include "tracer/generators/office.h"

namespace copse::generator {

namespace {

constexpr double wall = 0.12, outerWall = 0.26, clear = storeyHeight - 0.3;
constexpr double stairs = 6, stairsHalf = 1.7;

/// The walls of one room with its door and window, its ceiling, and its furniture.
void buildRoom(Indoor& in, const Office& plan, int w, int storey, int i, int side) {
  MeshBuilder& mesh = in.mesh;
  const Frame room = plan.room(w, storey, i, side);
  const uint64_t id = 0x10000ull * (1 + static_cast<uint64_t>(((w * 64 + storey) * 64 + i) * 2 + side));
  Random random = in.random(id + 1);
  const double half = 0.5 * roomWidth, back = 0.5 * roomDepth;

  mesh.use(wallPaint);
  mesh.box(room, {half - 0.5 * wall, 0, -back}, {half + 0.5 * wall, clear, back});
  const Frame inner = room.at(0, 0, -back);
  in.wallWithOpening(inner, half, clear, wall, -1.5, -0.5, 0, 2.1);
  mesh.use(concrete);
  const Frame outer = room.at(0, 0, back + 0.5 * outerWall);
  in.wallWithOpening(outer, half, clear, outerWall, -1.3, 1.3, 0.9, 2.6);
  mesh.use(carpet);
  mesh.quad(room(-half, 0.004, -back), room(half, 0.004, -back), room(half, 0.004, back), room(-half, 0.004, back));
  mesh.use(walnut);
  for (const double x : {-half + 0.5 * wall, half - 0.5 * wall - 0.015})
    mesh.box(room, {x, 0, -back}, {x + 0.015, 0.09, back});

  const bool viewed = w == 0 && side == 0 && i == 1 && storey == plan.litStorey();
  const double ajar = random.next();
  in.door(inner.at(-1.0, 0, 0), 1.0, 2.1, viewed || ajar < 0.7 ? 0 : 1.5 * ajar, id + 2);
  in.window(outer.at(0, 0.9, 0), 2.6, 1.7, id + 8);
  // Few rooms have their lamps on: what a view does not see should not take its samples.
  const bool on =
      viewed || (w == 0 && side == 0 && storey != plan.litStorey() && i < 10 && (i * 5 + storey * 3) % 11 == 0);
  furnish(in, room, on, viewed, id + 0x1000);
}

void buildCorridor(Indoor& in, const Office& plan, int w, int storey) {
  MeshBuilder& mesh = in.mesh;
  const Frame f = plan.wing(w).at(0, storeyHeight * storey, 0);
  const double length = plan.length();
  const uint64_t id = 0x900000000ull + 0x1000ull * static_cast<uint64_t>(w * 64 + storey);
  mesh.use(linoleum);
  mesh.quad(f(0, 0.004, -corridorHalf), f(length, 0.004, -corridorHalf), f(length, 0.004, corridorHalf),
            f(0, 0.004, corridorHalf));
  const bool lit = w == 0 && storey == plan.litStorey();
  const int apart = std::max(1, plan.along / 12);
  for (int i = 0; i < plan.along; ++i) {
    const uint64_t here = id + 0x20 * static_cast<uint64_t>(i);
    const double x = roomWidth * (i + 0.5);
    in.ceiling(f.at(x, roomHeight - 0.1, 0), 0.5 * roomWidth, corridorHalf, 0, 1, {1.4, 0.5},
               lit && i % apart == 0 ? 2 : 0);
    const Frame north = f.at(x + 0.9, 1.55, -corridorHalf + 0.06),
                south = f.at(x + 0.9, 1.55, corridorHalf - 0.06).turned(pi);
    in.picture(i % 2 ? north : south, 1.1, 0.8, i % 3 ? clothBlue : clothRed);
    if (i % 4 == 2) in.pottedPlant(f.at(x + 0.9, 0, i % 2 ? 0.85 : -0.85), 1.2, here + 1);
    if (i % 5 == 3) in.bin(f.at(x + 1.4, 0, 0.98), here + 0x1e);
    // Plates beside the doors.
    mesh.use(steel);
    mesh.box(f, {x - 0.3, 1.5, -corridorHalf + 0.06}, {x - 0.05, 1.65, -corridorHalf + 0.07});
    mesh.box(f, {x + 0.05, 1.5, corridorHalf - 0.07}, {x + 0.3, 1.65, corridorHalf - 0.06});
  }
  mesh.use(wallAccent);
  mesh.box(f, {length - 0.02, 0, -corridorHalf}, {length, clear, corridorHalf});
  in.clock(f.at(length - 0.03, 2.3, 0).turned(-0.5 * pi), id + 0xf00);
}

/// Two flights per storey around an open well, with railings.
void buildStairs(Indoor& in, const Office& plan, int w, int storey) {
  MeshBuilder& mesh = in.mesh;
  const Frame f = plan.wing(w).at(0, storeyHeight * storey, 0);
  const uint64_t id = 0xa00000000ull + 0x1000ull * static_cast<uint64_t>(w * 64 + storey);
  mesh.use(linoleum);
  mesh.box(f, {-1.7, -0.2, -stairsHalf}, {0, 0, stairsHalf});
  mesh.use(wallPaint);
  for (const double z : {-stairsHalf - 0.2, stairsHalf}) mesh.box(f, {-stairs, -0.3, z}, {0, clear, z + 0.2});
  // From a stairs' landing into the corridor.
  const Frame end{f(0, 0, 0), {0, 0, -1}, {0, 1, 0}, {1, 0, 0}};
  in.wallWithOpening(end, stairsHalf + 0.2, clear, wall, -corridorHalf, corridorHalf, 0, 2.5);
  mesh.use(concrete);
  const Frame west{f(-stairs, 0, 0), {0, 0, 1}, {0, 1, 0}, {-1, 0, 0}};
  in.wallWithOpening(west, stairsHalf + 0.2, storeyHeight, 0.2, -0.8, 0.8, 1.0, 2.6);
  if (storey + 1 == plan.storeys) return;
  constexpr int steps = 9;
  constexpr double tread = 0.28, rise = storeyHeight / (2 * steps);
  mesh.use(linoleum);
  mesh.box(f, {-stairs + 0.1, steps * rise - 0.18, -stairsHalf}, {-1.7 - steps * tread, steps * rise, stairsHalf});
  for (int i = 0; i < steps; ++i) {
    const double x = -1.7 - tread * i, y = rise * i;
    mesh.box(f, {x - tread - 0.03, y, 0.12}, {x, y + rise, stairsHalf});
    const double back = -1.7 - steps * tread + tread * i, up = steps * rise + rise * i;
    mesh.box(f, {back, up, -stairsHalf}, {back + tread + 0.03, up + rise, -0.12});
  }
  in.railing(f(-1.7, 0.1, 0.14), f(-1.7 - steps * tread, steps * rise + 0.05, 0.14), 0.9, id);
  in.railing(f(-1.7 - steps * tread, steps * rise + 0.05, -0.14), f(-1.7, storeyHeight, -0.14), 0.9, id + 8);
  in.railing(f(-1.7, storeyHeight, 0.1), f(-1.7, storeyHeight, stairsHalf), 0.95, id + 16);
}

void buildWing(Indoor& in, const Office& plan, int w) {
  MeshBuilder& mesh = in.mesh;
  const Frame f = plan.wing(w);
  const double length = plan.length(), top = storeyHeight * plan.storeys, z = wingDepth + outerWall;
  for (int storey = 0; storey <= plan.storeys; ++storey) {
    mesh.use(concrete);
    mesh.box(f.at(0, storeyHeight * storey, 0), {0, -0.3, -z}, {length + outerWall, 0, z});
    // A ledge along the front.
    for (const double s : {-1.0, 1.0})
      mesh.box(f.at(0, storeyHeight * storey, 0), {0, -0.26, s * z - 0.06}, {length + outerWall, -0.06, s * z + 0.06});
  }
  for (int storey = 0; storey < plan.storeys; ++storey) {
    for (int i = 0; i < plan.along; ++i)
      for (int side = 0; side < 2; ++side) buildRoom(in, plan, w, storey, i, side);
    buildCorridor(in, plan, w, storey);
    buildStairs(in, plan, w, storey);
    mesh.use(concrete);  // The gables.
    const Frame level = f.at(0, storeyHeight * storey, 0);
    mesh.box(level, {length, 0, -z}, {length + outerWall, clear, z});
    mesh.box(level, {-0.06, 0, stairsHalf + 0.2}, {wall - 0.06, clear, z});
    mesh.box(level, {-0.06, 0, -z}, {wall - 0.06, clear, -stairsHalf - 0.2});
  }
  // The roof: a parapet, ducts and housings.
  mesh.use(concrete);
  const Frame roof = f.at(0, top, 0);
  for (const double s : {-z, z - 0.2}) mesh.box(roof, {0, 0, s}, {length + outerWall, 0.8, s + 0.2});
  mesh.box(roof, {length + outerWall - 0.2, 0, -z}, {length + outerWall, 0.8, z});
  mesh.box(roof, {-stairs - 0.1, -0.3, -stairsHalf - 0.2}, {0.2, 2.6, stairsHalf + 0.2});
  mesh.use(steel);
  for (int i = 0; i < plan.along / 3; ++i) {
    const Frame unit = roof.at(6 + 12.0 * i, 0, i % 2 ? 2.5 : -2.5);
    mesh.box(unit, {-1.5, 0.2, -1}, {1.5, 1.8, 1});
    mesh.lathe(unit.at(0, 1.8, 0), Profile(0.7, 0).to(0.7, 0.3).to(0.6, 0.32).to(0, 0.2),
               in.segments(24, 6, 0xb00 + static_cast<uint64_t>(i)));
    mesh.bentTube({unit(1.5, 1, 0), unit(3.4, 1, 0), unit(3.8, 0.6, 0), unit(3.8, 0, 0)}, 0.28,
                  in.segments(16, 6, 0xb01));
  }
}

}  // namespace

void buildOffice(Indoor& in, const Office& plan) {
  for (int w = 0; w < plan.wings; ++w) buildWing(in, plan, w);
  MeshBuilder& mesh = in.mesh;
  const double length = plan.length(), back = -wingApart * (plan.wings - 1) - 30;
  mesh.use(pavement);
  mesh.quad({-60, -0.31, 60}, {length + 40, -0.31, 60}, {length + 40, -0.31, back}, {-60, -0.31, back});
  mesh.use(concrete);
  mesh.box(Frame{{0, -0.31, 0}}, {-60, 0, 11}, {length + 40, 0.14, 14});
  for (int i = 0; i < std::min(plan.along, 26) / 2; ++i) {  // Tubs with plants along the pavement.
    const Frame tub{{3.0 + 8 * i, -0.17, 12.3}};
    in.pottedPlant(tub, 2.2, 0xc000 + 0x40 * static_cast<uint64_t>(i));
    mesh.use(steel);
    mesh.tube({tub(4, 0, 0.8), tub(4, 1.0, 0.8)}, 0.06, in.segments(12, 5, 0xc800));
  }
}

}  // namespace copse::generator
