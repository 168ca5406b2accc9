// What encloses the court: floors of slabs, outer walls of two triangles each, corner piers, the portals, the gallery's
// ceiling.
#include "tracer/generators/atrium.h"

namespace copse::generator {

const std::array<Facade, 4>& Atrium::facades() {
  static const std::array<Facade, 4> all = {{
      {{{0, 0, halfWidth}, {-1, 0, 0}, {0, 1, 0}, {0, 0, -1}}, 8, 0},
      {{{0, 0, -halfWidth}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, 8, 1},
      {{{halfLength, 0, 0}, {0, 0, 1}, {0, 1, 0}, {-1, 0, 0}}, 3, 2},
      {{{-halfLength, 0, 0}, {0, 0, -1}, {0, 1, 0}, {1, 0, 0}}, 3, 3},
  }};
  return all;
}

namespace {

constexpr double courtFloor = -0.16;

/// A level ring between the court's opening and the outer walls, as four strips of two triangles.
void addRing(MeshBuilder& mesh, double y, double opening) {
  const double x0 = halfLength - opening, z0 = halfWidth - opening, x1 = outerLength, z1 = outerWidth;
  for (const double side : {-1.0, 1.0}) {
    mesh.quad({-x1, y, side * z0}, {x1, y, side * z0}, {x1, y, side * z1}, {-x1, y, side * z1});
    mesh.quad({side * x0, y, -z0}, {side * x0, y, z0}, {side * x1, y, z0}, {side * x1, y, -z0});
  }
}

void addFloors(Atrium& atrium) {
  MeshBuilder& mesh = atrium.mesh;
  const double step = wallHalf + 0.35, x0 = halfLength - step, z0 = halfWidth - step;
  mesh.use(darkStone);
  mesh.quad({-outerLength, -0.4, -outerWidth}, {-outerLength, -0.4, outerWidth}, {outerLength, -0.4, outerWidth},
            {outerLength, -0.4, -outerWidth});
  mesh.use(stone);
  addRing(mesh, 0, step);
  for (const double s : {-1.0, 1.0}) {
    mesh.quad({-x0, 0, s * z0}, {x0, 0, s * z0}, {x0, -0.4, s * z0}, {-x0, -0.4, s * z0});
    mesh.quad({s * x0, 0, -z0}, {s * x0, 0, z0}, {s * x0, -0.4, z0}, {s * x0, -0.4, -z0});
  }
  // The court's slabs, each a little higher or lower than its neighbours, in a pattern of squares with a border.
  Random random = atrium.random(0x200000);
  const uint32_t nx = atrium.repeats(24, 4, 0x200001), nz = atrium.repeats(8, 2, 0x200002);
  const double joint = 0.006;
  for (uint32_t j = 0; j < nz; ++j)
    for (uint32_t i = 0; i < nx; ++i) {
      const bool border = i == 0 || j == 0 || i + 1 == nx || j + 1 == nz;
      mesh.use(border ? terracotta : (i + j) % 2 ? slabPale : slabDark);
      const double top = courtFloor + random.between(-0.006, 0.006);
      mesh.box(Frame(), {-x0 + 2 * x0 * i / nx + joint, -0.4, -z0 + 2 * z0 * j / nz + joint},
               {-x0 + 2 * x0 * (i + 1) / nx - joint, top, -z0 + 2 * z0 * (j + 1) / nz - joint});
    }
  mesh.use(terracotta);
  addRing(mesh, galleryFloor, -wallHalf + 0.6);
}

void addWalls(Atrium& atrium) {
  MeshBuilder& mesh = atrium.mesh;
  mesh.use(plaster);
  const double x = outerLength, z = outerWidth, bottom = -0.4;
  for (const double s : {-1.0, 1.0}) {
    mesh.quad({-x, bottom, s * z}, {x, bottom, s * z}, {x, ridge, s * z}, {-x, ridge, s * z});
    mesh.quad({s * x, bottom, -z}, {s * x, bottom, z}, {s * x, ridge, z}, {s * x, ridge, -z});
  }
  for (const Facade& facade : Atrium::facades()) {
    const double half = facade.half() + aisle;
    const Frame wall = facade.frame.at(0, 0, -aisle);
    if (!atrium.fine(0.08, facade.id)) continue;
    mesh.use(darkStone);
    mesh.box(wall, {-half, 0, -0.05}, {half, 0.45, 0.06});
    mesh.use(stone);
    mesh.box(wall, {-half, 0.45, -0.05}, {half, 0.52, 0.09});
    mesh.box(wall, {-half, galleryFloor, -0.05}, {half, galleryFloor + 0.3, 0.05});
    mesh.box(wall, {-half, 9.3, -0.05}, {half, 9.5, 0.12});
  }
}

/// Courses of stone that sit a little in or out by chance.
void addPiers(Atrium& atrium) {
  MeshBuilder& mesh = atrium.mesh;
  const uint32_t courses = atrium.repeats(11, 2, 0x210000);
  for (int corner = 0; corner < 4; ++corner) {
    Random random = atrium.random(0x210001 + static_cast<uint64_t>(corner));
    const Frame frame{{corner & 1 ? halfLength : -halfLength, 0, corner & 2 ? halfWidth : -halfWidth}};
    for (uint32_t i = 0; i < courses; ++i) {
      const double size = 0.46 + random.between(-0.012, 0.012) + (i % 2 ? 0.02 : 0);
      mesh.use(i % 2 ? stone : paleStone);
      mesh.box(frame, {-size, storeyTop * i / courses, -size}, {size, storeyTop * (i + 1) / courses, size});
    }
    mesh.use(darkStone);
    mesh.box(frame, {-0.56, 0, -0.56}, {0.56, 0.3, 0.56});
    mesh.use(paleStone);
    mesh.box(frame, {-0.55, groundSpring - 0.16, -0.55}, {0.55, groundSpring, 0.55});
    mesh.use(stone);
    mesh.box(frame, {-0.36, galleryFloor, -0.36}, {0.36, upperTop, 0.36});
    mesh.use(paleStone);
    mesh.box(frame, {-0.42, railTop - 0.1, -0.42}, {0.42, railTop, 0.42});
    mesh.box(frame, {-0.42, upperSpring - 0.14, -0.42}, {0.42, upperSpring, 0.42});
  }
}

/// A panelled double door in a stone frame, in the middle of each end wall.
void addPortal(Atrium& atrium, const Frame& frame, uint64_t id) {
  MeshBuilder& mesh = atrium.mesh;
  const double spring = 2.35, radius = 1.1;
  const Frame wall = frame.at(0, 0, -aisle), arch = wall.at(0, spring, 0.08);
  buildArchStones(atrium, arch, radius, 0.34, 0.12, 11, id);
  mesh.use(paleStone);
  buildHood(atrium, arch, radius + 0.36, 0.045, 0.1, id + 1);
  mesh.use(wood);
  mesh.box(wall, {-radius, 0.06, 0}, {radius, spring, 0.04});
  mesh.grid(2 * atrium.segments(7, 2, id + 2), 1,
            [&](double u, double v) { return arch(-radius * std::cos(pi * u), v * radius * std::sin(pi * u), -0.04); });
  if (!atrium.fine(0.1, id)) return;
  for (const double s : {-0.55, 0.55})
    for (int row = 0; row < 3; ++row)
      mesh.box(wall, {s - 0.4, 0.22 + 0.72 * row, 0.04}, {s + 0.4, 0.8 + 0.72 * row, 0.075});
  mesh.use(stone);
  for (const double s : {-1.0, 1.0}) {
    mesh.box(wall, {s * 1.28 - 0.2, 0, 0}, {s * 1.28 + 0.2, spring - 0.12, 0.2});
    mesh.box(wall, {s * 1.28 - 0.25, spring - 0.12, 0}, {s * 1.28 + 0.25, spring, 0.26});
    mesh.box(wall, {s * 1.28 - 0.25, 0, 0}, {s * 1.28 + 0.25, 0.3, 0.26});
  }
  mesh.box(wall, {-1.6, -0.01, 0}, {1.6, 0.06, 0.7});
  mesh.use(bronze);
  const uint32_t studs = atrium.repeats(6, 0, id + 3), sides = atrium.segments(8, 4, id + 4),
                 curve = atrium.segments(2, 1, id + 5);
  for (uint32_t k = 0; k < studs; ++k)
    for (const double s : {-1.02, -0.08, 0.08, 1.02}) {
      const dvec3 place = wall(s, 0.25 + 0.38 * k, 0.04);
      mesh.lathe({place, wall.x, wall.z, -wall.y}, Profile(0.035, 0).upOut(0, 0.03, curve), sides);
    }
}

/// Beams over the gallery and boards on them.
void addCeiling(Atrium& atrium) {
  MeshBuilder& mesh = atrium.mesh;
  const double y = 9.78;
  mesh.use(wood);
  addRing(mesh, y, 0.25);
  for (const Facade& facade : Atrium::facades()) {
    const uint32_t beams = atrium.repeats(static_cast<uint32_t>(4 * facade.bays), 2, 0x220000 + facade.id);
    const double half = facade.half();
    for (uint32_t k = 0; k <= beams; ++k) {
      const double x = half * (2.0 * k / beams - 1);
      mesh.box(facade.frame, {x - 0.08, y - 0.24, -aisle}, {x + 0.08, y, -0.2});
    }
    if (!atrium.fine(0.08, facade.id)) continue;
    for (const double z : {-1.3, -2.5}) mesh.box(facade.frame, {-half, y - 0.16, z - 0.07}, {half, y, z + 0.07});
  }
}

}  // namespace

void buildShell(Atrium& atrium) {
  addFloors(atrium);
  addWalls(atrium);
  addPiers(atrium);
  addCeiling(atrium);
  addPortal(atrium, Atrium::facades()[2].frame, 0x230000);
  addPortal(atrium, Atrium::facades()[3].frame, 0x230010);
}

}  // namespace copse::generator
