// What stands and grows in the court: the fountain, urns with plants, orange trees in tubs, and the leaves that bring
// the count to what was asked for.
#include "tracer/generators/atrium.h"

namespace copse::generator {

namespace {

constexpr double ground = -0.15, canopyHeight = 2.75, canopyRadius = 0.85;
const std::array<dvec2, 4> trees = {{{-5.4, -2.3}, {-5.4, 2.3}, {5.4, -2.3}, {5.4, 2.3}}};

void addFountain(Atrium& atrium) {
  MeshBuilder& mesh = atrium.mesh;
  const Frame frame{{0, ground, 0}};
  const uint32_t sides = atrium.segments(64, 8, 0x500000), curve = atrium.segments(5, 1, 0x500001);
  if (!atrium.fine(0.12, 0x500000)) {
    mesh.use(marble);
    mesh.lathe(frame, Profile(1.6, 0).to(1.6, 0.6).to(1.4, 0.6).to(1.4, 0), sides);
    mesh.use(water);
    mesh.lathe(frame, Profile(1.4, 0.5).to(0, 0.5), sides);
    return;
  }
  mesh.use(darkStone);
  mesh.lathe(frame.turned(pi / 8), Profile(2.05, -0.1).to(2.05, 0.1).to(1.5, 0.1), 8);
  mesh.use(marble);
  mesh.lathe(frame,
             Profile(1.62, 0.1)
                 .to(1.62, 0.18)
                 .upOut(1.5, 0.24, curve)
                 .ease(1.52, 0.5, curve)
                 .outUp(1.68, 0.58, curve)
                 .torus(0.03, 0.66, curve)
                 .to(1.5, 0.67)
                 .to(1.46, 0.64)
                 .to(1.42, 0.2)
                 .to(0.2, 0.2),
             sides);
  mesh.use(water);
  // The water stands a little higher where the bowl's water falls in.
  mesh.grid(
      sides, 2 * curve,
      [&](double u, double v) {
        const double r = 1.45 - 1.25 * v;
        return frame(r * std::cos(2 * pi * u), 0.56 + 0.012 * v * std::cos(14 * r), r * std::sin(2 * pi * u));
      },
      true);
  mesh.use(marble);
  mesh.lathe(frame,
             Profile(0.3, 0.2)
                 .to(0.3, 0.62)
                 .upOut(0.14, 0.72, curve)
                 .ease(0.12, 1.2, curve)
                 .torus(0.05, 1.3, curve)
                 .to(0.13, 1.32)
                 .outUp(0.72, 1.62, 2 * curve)
                 .torus(0.025, 1.67, curve)
                 .to(0.68, 1.67)
                 .upOut(0.1, 1.5, curve),
             sides);
  mesh.lathe(frame,
             Profile(0.1, 1.45)
                 .ease(0.075, 1.95, curve)
                 .torus(0.03, 2.02, curve)
                 .outUp(0.3, 2.16, curve)
                 .to(0.28, 2.17)
                 .upOut(0.06, 2.1, curve)
                 .ease(0.05, 2.22, curve)
                 .outUp(0.09, 2.32, curve)
                 .upOut(0, 2.47, curve),
             sides / 2);
  mesh.use(water);
  mesh.lathe(frame, Profile(0.66, 1.645).to(0, 1.65), sides);
}

/// Narrow blades that rise from the middle, lean outwards and hang.
void addPlant(Atrium& atrium, const Frame& frame, double size, Random& random, uint64_t id) {
  const uint32_t blades = atrium.repeats(30, 3, id);
  for (uint32_t k = 0; k < blades; ++k) {
    const Frame turned = frame.turned(2 * pi * (k + random.next()) / blades);
    const double length = size * random.between(0.6, 1.1), lean = random.between(0.25, 1.0),
                 droop = random.between(0.4, 1.3);
    const double width = size * random.between(0.035, 0.06);
    atrium.mesh.use(k % 3 ? leaf : paleLeaf);
    atrium.mesh.grid(2, atrium.segments(5, 2, id + k), [&](double u, double v) {
      const double half = width * std::sin(pi * (0.12 + 0.86 * v)), across = 2 * u - 1;
      const double out = length * (0.1 + lean * v * (0.5 + 0.5 * v)),
                   up = length * (v * (1.25 - 0.4 * lean) - droop * 0.55 * v * v * lean);
      return turned(half * across, up + 0.4 * half * std::abs(across), out);
    });
  }
}

void addUrn(Atrium& atrium, const Frame& frame, uint64_t id) {
  MeshBuilder& mesh = atrium.mesh;
  Random random = atrium.random(id);
  const uint32_t sides = atrium.segments(28, 5, id + 1), curve = atrium.segments(4, 1, id + 2);
  constexpr std::array<Stuff, 4> clays = {terracotta, marble, bronze, terracotta};
  mesh.use(stone);
  const double high = random.between(0.25, 0.55);
  mesh.box(frame, {-0.34, 0, -0.34}, {0.34, 0.08, 0.34});
  mesh.box(frame, {-0.28, 0.08, -0.28}, {0.28, high, 0.28});
  mesh.box(frame, {-0.33, high, -0.33}, {0.33, high + 0.07, 0.33});
  mesh.use(clays[random.below(4)]);
  const double belly = random.between(0.24, 0.33), neck = belly * random.between(0.55, 0.85),
               tall = random.between(0.45, 0.85);
  const double mouth = neck + random.between(0.03, 0.08);
  const Frame base = frame.at(0, high + 0.07, 0).turned(random.between(0, pi));
  if (!atrium.fine(0.15, id)) {
    mesh.lathe(base, Profile(0.12, 0).to(belly, 0.6 * tall).to(mouth, 0.1 + tall), sides);
    return;
  }
  mesh.lathe(base,
             Profile(0.16, 0)
                 .torus(0.02, 0.05, curve)
                 .upOut(0.09, 0.09, curve)
                 .outUp(belly, 0.1 + 0.6 * tall, 2 * curve)
                 .upOut(neck, 0.1 + 0.92 * tall, 2 * curve)
                 .outUp(mouth, 0.1 + tall, curve)
                 .to(mouth - 0.03, 0.1 + tall)
                 .to(neck - 0.03, 0.07 + 0.92 * tall),
             sides);
  mesh.use(soil);
  mesh.lathe(base, Profile(neck - 0.02, 0.08 + 0.92 * tall).to(0, 0.1 + 0.92 * tall), sides);
  addPlant(atrium, base.at(0, 0.08 + 0.92 * tall, 0), random.between(0.5, 0.85), random, id + 8);
}

void addTree(Atrium& atrium, const Frame& frame, uint64_t id) {
  MeshBuilder& mesh = atrium.mesh;
  Random random = atrium.random(id);
  const uint32_t sides = atrium.segments(32, 6, id + 1), curve = atrium.segments(3, 1, id + 2);
  mesh.use(terracotta);
  if (!atrium.fine(0.12, id)) {
    mesh.lathe(frame, Profile(0.3, 0).to(0.42, 0.65).to(0, 0.65), sides);
    mesh.use(wood);
    mesh.tube({frame(0, 0.6, 0), frame(0, 2.2, 0)}, 0.05, 3);
    return;
  }
  mesh.lathe(frame,
             Profile(0.3, 0)
                 .to(0.32, 0.06)
                 .ease(0.4, 0.5, curve)
                 .torus(0.03, 0.57, curve)
                 .to(0.41, 0.6)
                 .torus(0.035, 0.68, curve)
                 .to(0.37, 0.68)
                 .to(0.35, 0.6),
             sides);
  mesh.use(soil);
  mesh.lathe(frame, Profile(0.36, 0.61).to(0, 0.63), sides);
  mesh.use(wood);
  const double leanX = random.between(-0.1, 0.1), leanZ = random.between(-0.1, 0.1);
  const auto trunk = [&](double t) {
    return frame(leanX * t + 0.04 * std::sin(5 * t), 0.6 + 1.5 * t, leanZ * t + 0.04 * std::sin(4 * t + 1));
  };
  std::vector<dvec3> path;
  const uint32_t pieces = 2 + 2 * curve;
  for (uint32_t i = 0; i <= pieces; ++i) path.push_back(trunk(static_cast<double>(i) / pieces));
  mesh.tube(path, 0.05, atrium.segments(8, 3, id + 3));
  const uint32_t branches = atrium.repeats(7, 2, id + 4);
  for (uint32_t k = 0; k < branches; ++k) {
    const dvec3 from = trunk(random.between(0.8, 1)), way = random.direction();
    const dvec3 to = frame(0.55 * way.x, canopyHeight + 0.5 * way.y, 0.55 * way.z);
    mesh.tube({from, 0.5 * (from + to) + dvec3(0, 0.06, 0), to}, 0.02, 3);
  }
}

/// One leaf: two triangles folded along the middle.
void addLeaf(MeshBuilder& mesh, const dvec3& at, const dvec3& normal, double size, Random& random, bool whole) {
  const dvec3 along = glm::normalize(glm::cross(normal, random.direction()));
  const dvec3 side = glm::cross(normal, along), lifted = 0.12 * normal;
  const dvec3 base = at - 0.5 * size * along, tip = at + 0.5 * size * along;
  mesh.triangle(base, tip, at + size * (0.27 * side + lifted));
  if (whole) mesh.triangle(base, at + size * (lifted - 0.27 * side), tip);
}

}  // namespace

void buildGarden(Atrium& atrium) {
  addFountain(atrium);
  for (std::size_t i = 0; i < trees.size(); ++i)
    addTree(atrium, Frame{{trees[i].x, ground, trees[i].y}}, 0x510000 + 0x100 * i);
  for (const Facade& facade : Atrium::facades())
    for (int i = 0; i <= facade.bays; ++i) {
      const uint64_t id = 0x520000 + 0x1000 * facade.id + 0x80 * static_cast<uint64_t>(i);
      Random random = atrium.random(id + 0x7f);
      // By the columns; at the corners the two facades would put two in one place.
      if (i == 0 || i == facade.bays || random.next() < 0.45 || !atrium.fine(0.12, id)) continue;
      addUrn(atrium, facade.frame.at(facade.bayBorder(i) + random.between(-0.12, 0.12), ground, 1.05), id);
    }
}

void buildLeaves(Atrium& atrium, uint64_t triangles) {
  const uint64_t leaves = (triangles + 1) / 2;
  Random random = atrium.random(0x530000);
  // More leaves are smaller ones: the shade of a tree stays the same.
  const double size = 0.17 * std::sqrt(6500.0 / static_cast<double>(std::clamp<uint64_t>(leaves, 1500, 10'000'000)));
  for (uint64_t k = 0; k < leaves; ++k) {
    atrium.mesh.use(random.next() < 0.7 ? leaf : paleLeaf);
    const bool whole = 2 * k + 2 <= triangles;
    const dvec2 tree = trees[k % 4];
    const dvec3 way = random.direction();
    if (k % 8 < 5) {  // The trees.
      const double r =
          canopyRadius * std::cbrt(random.between(0.35, 1)) * (1 + 0.12 * std::sin(5 * way.x + 3 * way.z + tree.x));
      const dvec3 at = dvec3(tree.x, ground + canopyHeight, tree.y) + r * dvec3(way.x, 0.85 * way.y, way.z);
      addLeaf(atrium.mesh, at, glm::normalize(way + 0.8 * random.direction()), size, random, whole);
      continue;
    }
    // Ivy that hangs from the rail in five places, thinner towards its lower end.
    static constexpr std::array<std::array<int, 2>, 5> places = {{{0, 2}, {1, 6}, {0, 6}, {1, 4}, {2, 1}}};
    const auto& [side, border] = places[random.below(5)];
    const Facade& facade = Atrium::facades()[static_cast<std::size_t>(side)];
    const double strand = std::floor(random.between(0, 9)), reach = random.between(0.4, 1),
                 down = reach * random.next();
    const double x = 0.17 * (strand - 4) + 0.05 * std::sin(9 * down + strand) + random.between(-0.05, 0.05);
    const double length = 1.3 + 2.4 * std::abs(std::sin(2.1 * strand + side + border)), along = down * length;
    const double over = std::min(1.0, along / 1.1);  // From the rail to the cornice's edge.
    const double y = railTop + 0.03 - (railTop - 5.72) * over - std::max(0.0, along - 1.1);
    const dvec3 at = facade.frame(facade.bayBorder(border) + x, y, 0.36 + 0.34 * over + random.between(0, 0.09));
    addLeaf(atrium.mesh, at, glm::normalize(facade.frame.z + dvec3(0, 0.4, 0) + 0.7 * way), 0.8 * size, random, whole);
  }
}

}  // namespace copse::generator
