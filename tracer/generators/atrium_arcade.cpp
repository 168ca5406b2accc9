// The ground floor: fluted columns with leaves at their capitals, arches of stones in two colours, groin vaults behind.
#include "tracer/generators/atrium.h"

namespace copse::generator {

void buildArchStones(Atrium& atrium, const Frame& frame, double radius, double depth, double half, uint32_t maxStones,
                     uint64_t id) {
  MeshBuilder& mesh = atrium.mesh;
  Random random = atrium.random(id);
  if (!atrium.fine(0.13, id)) {
    mesh.use(terracotta);
    mesh.grid(4, 1, [&](double u, double v) {
      return frame(-radius * std::cos(pi * u), radius * std::sin(pi * u), half * (2 * v - 1));
    });
    return;
  }
  // An odd number, so that there is a keystone.
  const uint32_t stones = 2 * atrium.repeats(maxStones / 2, 0, id + 2) + 1;
  const uint32_t pieces = atrium.segments(18.0 / stones, (4 + stones) / stones, id);
  for (uint32_t k = 0; k < stones; ++k) {
    const bool key = 2 * k + 1 == stones;
    mesh.use(key ? paleStone : k % 2 ? stone : terracotta);
    const double a0 = pi * (k + 0.03) / stones, a1 = pi * (k + 0.97) / stones;
    const double out = half + (key ? 0.09 : random.between(0.02, 0.035));
    const double inner = radius - random.between(0.0, 0.008), outer = radius + depth * (key ? 1.2 : 1);
    const auto at = [&](double a, double r, double z) { return frame(-r * std::cos(a), r * std::sin(a), z); };
    const auto face = [&](double r0, double z0, double r1, double z1) {
      mesh.grid(pieces, 1,
                [&](double u, double v) { return at(a0 + (a1 - a0) * u, r0 + (r1 - r0) * v, z0 + (z1 - z0) * v); });
    };
    face(inner, out, outer, out);
    face(inner, -out, inner, out);
    face(outer, -out, inner, -out);
    face(outer, out, outer, half - 0.02);
    if (stones > 1)
      for (const double a : {a0, a1})
        mesh.quad(at(a, inner, -out), at(a, inner, out), at(a, outer, out), at(a, outer, -out));
  }
}

void buildArchWall(Atrium& atrium, const Frame& frame, double radius, double left, double right, double top,
                   double half, uint64_t id) {
  MeshBuilder& mesh = atrium.mesh;
  const uint32_t pieces = 2 * atrium.segments(9, 2, id);
  // Where there are stones they stand in front of the wall's edge: it may start a little further out.
  const double r = radius + (atrium.fine(0.13, id) ? 0.08 : 0);
  for (const double z : {half, -half}) {
    mesh.grid(pieces, 1, [&](double u, double v) {
      const double a = pi * u, x = -r * std::cos(a), y = r * std::sin(a);
      const double topX = u < 0.5 ? -left + left * 2 * u : right * (2 * u - 1);
      return frame(x + (topX - x) * v, y + (top - y) * v, z);
    });
    mesh.triangle(frame(-left, 0, z), frame(-r, 0, z), frame(-left, top, z));
    mesh.triangle(frame(r, 0, z), frame(right, 0, z), frame(right, top, z));
  }
}

void buildHood(Atrium& atrium, const Frame& frame, double radius, double rib, double z, uint64_t id) {
  if (!atrium.fine(0.16, id)) return;
  const uint32_t pieces = 2 * atrium.segments(10, 2, id);
  atrium.mesh.grid(atrium.segments(5, 2, id + 1), pieces, [&](double u, double v) {
    const double a = pi * v, b = pi * u, r = radius + rib * (1 - std::cos(b));
    return frame(-r * std::cos(a), r * std::sin(a), z + rib * std::sin(b));
  });
}

namespace {

/// A leaf of the capital: it rises along the bell and curls outwards at its tip.
void addCapitalLeaf(Atrium& atrium, const Frame& frame, double angle, double y0, double y1, double r0, double r1,
                    uint64_t id) {
  const Frame turned = frame.turned(angle);
  const double width = 0.11;
  atrium.mesh.grid(2 * atrium.segments(1.5, 1, id), atrium.segments(6, 2, id + 7), [&](double u, double v) {
    const double curl = std::max(0.0, v - 0.62) / 0.38, across = 2 * u - 1;
    const double y = y0 + (y1 - y0) * (v < 0.62 ? v / 0.62 : std::cos(1.9 * curl) * 0.05 + 0.95);
    const double r = r0 + (r1 - r0) * v * v + 0.09 * std::sin(0.5 * pi * curl) + 0.02 * (1 - std::abs(across));
    const double half = width * (0.75 + 0.35 * std::sin(pi * std::min(1.0, 1.25 * v))) * (1 - 0.75 * curl * curl);
    return turned(half * across, y, r - 0.35 * half * across * across);
  });
}

void addColumn(Atrium& atrium, const Frame& frame, uint64_t id) {
  MeshBuilder& mesh = atrium.mesh;
  const uint32_t sides = atrium.segments(32, 5, id), curve = atrium.segments(4, 1, id + 1);
  if (!atrium.fine(0.2, id)) {
    mesh.use(stone);
    mesh.lathe(frame, Profile(0.33, 0).to(0.267, 2.84).to(0.42, groundSpring), sides);
    return;
  }
  mesh.use(darkStone);
  mesh.box(frame, {-0.42, 0, -0.42}, {0.42, 0.16, 0.42});
  mesh.use(stone);
  mesh.lathe(frame,
             Profile(0.39, 0.16)
                 .torus(0.03, 0.27, curve)
                 .to(0.36, 0.28)
                 .upOut(0.335, 0.33, curve)
                 .to(0.35, 0.34)
                 .torus(0.022, 0.40, curve)
                 .to(0.318, 0.42),
             sides);
  // Twenty flutes from a third of the height up, where there are triangles enough to show them.
  constexpr uint32_t flutes = 20;
  const bool fluted = sides >= 24;
  const uint32_t around = fluted ? flutes * atrium.segments(4, 2, id + 2) : sides;
  mesh.use(paleStone);
  const uint32_t rows = fluted ? 3 + atrium.segments(3, 1, id + 3) : 1;
  const double flutesFrom = 1.12, bottom = 0.42, top = 2.82;
  mesh.grid(
      around, rows,
      [&](double u, double v) {
        // The lowest row is plain, the second opens the flutes, the others follow the entasis.
        const uint32_t row = static_cast<uint32_t>(std::lround(v * rows));
        double y = bottom + (top - bottom) * v;
        if (fluted)
          y = row == 0   ? bottom
              : row == 1 ? flutesFrom - 0.05
                         : flutesFrom + (top - flutesFrom) * (row - 2) / (rows - 2);
        const double t = (y - bottom) / (top - bottom);
        double r = 0.312 - 0.045 * t * t;
        if (fluted && row >= 2) r -= 0.022 * std::pow(std::abs(std::sin(0.5 * flutes * 2 * pi * u)), 0.8);
        return frame(r * std::cos(2 * pi * u), y, r * std::sin(2 * pi * u));
      },
      true);
  mesh.use(stone);
  mesh.lathe(frame,
             Profile(0.267, 2.80).torus(0.035, 2.87, curve).to(0.262, 2.88).upOut(0.36, 3.29, 2 * curve).to(0.36, 3.31),
             sides);
  const uint32_t leaves = atrium.repeats(8, 0, id + 4);
  for (uint32_t i = 0; i < leaves; ++i) {
    addCapitalLeaf(atrium, frame, 2 * pi * (i + 0.5) / leaves, 2.88, 3.08, 0.275, 0.28, id + 5);
    addCapitalLeaf(atrium, frame, 2 * pi * i / leaves, 2.90, 3.24, 0.27, 0.33, id + 6);
  }
  mesh.use(paleStone);
  mesh.box(frame, {-0.40, 3.30, -0.40}, {0.40, 3.38, 0.40});
  mesh.box(frame, {-0.43, 3.38, -0.43}, {0.43, groundSpring, 0.43});
}

/// A round relief of twelve petals on the wall above a column.
void addRosette(Atrium& atrium, const Frame& frame, uint64_t id) {
  if (!atrium.fine(0.2, id)) return;
  const uint32_t around = 12 * atrium.segments(2.5, 1, id), rings = atrium.segments(6, 2, id + 1);
  atrium.mesh.use(paleStone);
  atrium.mesh.grid(
      around, rings,
      [&](double u, double v) {
        const double t = std::max(0.02, 1 - v), petal = std::abs(std::cos(6 * 2 * pi * u));
        const double rim = t > 0.86 ? 0.05 * std::sin(pi * (1 - t) / 0.14) : 0;
        const double height =
            rim + (t < 0.86 ? 0.03 + 0.06 * petal * std::sin(pi * t / 0.86) : 0) + (t < 0.25 ? 0.05 * (1 - 4 * t) : 0);
        return frame(0.29 * t * std::cos(2 * pi * u), 0.29 * t * std::sin(2 * pi * u), height);
      },
      true);
}

/// The ceiling of one bay: where two barrels cross the higher one counts, and their crossing is the groin.
void addGroinVault(Atrium& atrium, const Frame& frame, double x0, double x1, double z0, double z1, uint64_t id) {
  const uint32_t n = 2 * atrium.segments(7, 1, id);
  constexpr double rise = 1.42;
  atrium.mesh.use(plaster);
  atrium.mesh.grid(n, n, [&](double u, double v) {
    const double x = -std::cos(pi * u), z = -std::cos(pi * v);
    const double height = std::max(std::sqrt(std::max(0.0, 1 - x * x)), std::sqrt(std::max(0.0, 1 - z * z)));
    return frame(0.5 * (x0 + x1) + 0.5 * (x1 - x0) * x, groundSpring + rise * height,
                 0.5 * (z0 + z1) + 0.5 * (z1 - z0) * z);
  });
}

/// The rib that carries the vaults from a column across the aisle to a pilaster of the outer wall.
void addRib(Atrium& atrium, const Frame& frame, uint64_t id) {
  if (!atrium.fine(0.12, id)) return;
  MeshBuilder& mesh = atrium.mesh;
  mesh.use(stone);
  const double middle = -0.5 * (wallHalf + aisle), span = 0.5 * (aisle - wallHalf) - 0.1;
  const std::array<dvec2, 6> outline = {
      {{-0.19, 0.3}, {-0.19, 0.05}, {-0.13, 0}, {0.13, 0}, {0.19, 0.05}, {0.19, 0.3}}};
  mesh.grid(5, 2 * atrium.segments(8, 2, id), [&](double u, double v) {
    const dvec2 p = outline[static_cast<std::size_t>(std::lround(5 * u))];
    const double a = pi * v;
    return frame(p.x, groundSpring + (1.24 + p.y) * std::sin(a), middle - (span + p.y) * std::cos(a));
  });
  const double back = -aisle;
  mesh.box(frame, {-0.27, 0, back}, {0.27, 0.35, back + 0.26});
  mesh.box(frame, {-0.22, 0.35, back}, {0.22, groundSpring - 0.2, back + 0.2});
  mesh.use(paleStone);
  mesh.box(frame, {-0.28, groundSpring - 0.2, back}, {0.28, groundSpring, back + 0.28});
}

/// A framed panel on the outer wall of the aisle, under a half-round head.
void addBlindArch(Atrium& atrium, const Frame& frame, uint64_t id) {
  if (!atrium.fine(0.18, id)) return;
  MeshBuilder& mesh = atrium.mesh;
  const double z = -aisle + 0.03, spring = 2.0, radius = 0.85;
  const Frame centre = frame.at(0, spring, z);
  mesh.use(terracotta);
  const uint32_t pieces = 2 * atrium.segments(7, 2, id);
  mesh.grid(pieces, 1, [&](double u, double v) {
    const double a = pi * u, x = -radius * std::cos(a);
    return centre(x, v * radius * std::sin(a) - (1 - v) * (spring - 0.75), 0);
  });
  mesh.use(paleStone);
  buildHood(atrium, centre, radius, 0.07, 0, id + 1);
  for (const double side : {-1.0, 1.0})
    mesh.box(centre, {side * (radius + 0.07) - 0.07, 0.75 - spring, -0.03}, {side * (radius + 0.07) + 0.07, 0, 0.07});
  mesh.box(centre, {-radius - 0.22, 0.62 - spring, -0.03}, {radius + 0.22, 0.75 - spring, 0.14});
}

}  // namespace

void buildArcade(Atrium& atrium) {
  for (const Facade& facade : Atrium::facades()) {
    const uint64_t part = 0x1000 * (facade.id + 1);
    for (int i = 0; i <= facade.bays; ++i) {
      const Frame border = facade.frame.at(facade.bayBorder(i), 0, 0);
      const uint64_t id = part + 64 * static_cast<uint64_t>(i);
      addRib(atrium, border, id + 20);
      if (i == 0 || i == facade.bays) continue;
      addColumn(atrium, border, id);
      addRosette(atrium, border.at(0, 4.62, wallHalf), id + 24);
    }
    for (int i = 0; i < facade.bays; ++i) {
      const Frame centre = facade.frame.at(facade.bayCentre(i), 0, 0), arch = centre.at(0, groundSpring, 0);
      const uint64_t id = part + 64 * static_cast<uint64_t>(i) + 32;
      buildArchStones(atrium, arch, groundRadius, 0.36, wallHalf, 15, id);
      atrium.mesh.use(stone);
      buildArchWall(atrium, arch, groundRadius, 0.5 * bay, 0.5 * bay, storeyTop - groundSpring, wallHalf, id + 1);
      atrium.mesh.use(paleStone);
      buildHood(atrium, arch, groundRadius + 0.36, 0.03, wallHalf, id + 3);
      addGroinVault(atrium, centre, -0.5 * bay, 0.5 * bay, -aisle, -wallHalf, id + 5);
      // The middle of each end is the portal's.
      if (facade.bays != 3 || i != 1) addBlindArch(atrium, centre, id + 7);
    }
    // One corner each: beyond the end at +x.
    const Frame corner = facade.frame.at(facade.half(), 0, 0);
    addGroinVault(atrium, corner, 0, aisle, -aisle, -wallHalf + 0.3, part + 60);
  }
}

}  // namespace copse::generator
