// What hangs: curtains in the arches, banners over the gallery's rail, cables across the court with lanterns on them.
#include "tracer/generators/atrium.h"

namespace copse::generator {

namespace {

double smooth(double t) { return t * t * (3 - 2 * t); }

struct Cloth {
  double phase, sway, folds, depth;
};

Cloth drawCloth(Random& random) {
  return {random.between(0, 2 * pi), random.between(-1, 1), std::floor(random.between(6, 10)),
          random.between(0.045, 0.07)};
}

/// Half of a curtain: from the column at x = side * 1.3 towards the middle, gathered at `tie` (0 … 1 from the top) or,
/// with tie = 1, hanging free.
void addCurtainHalf(Atrium& atrium, const Frame& frame, double side, double reach, double tie, const Cloth& cloth,
                    uint64_t id) {
  const double top = 3.3, bottom = 0.1, edge = 1.33;
  atrium.mesh.grid(atrium.segments(52, 3, id), atrium.segments(30, 3, id + 1), [&](double u, double v) {
    double width = reach;
    if (tie < 1) {
      const double gathered = 0.24;
      width = v < tie ? gathered + (reach - gathered) * std::pow(1 - v / tie, 1.4)
                      : gathered + 0.34 * smooth(std::min(1.0, (v - tie) / (1 - tie) * 1.2));
    }
    const double loose = tie < 1 ? 0.6 + 0.4 * std::min(1.0, std::abs(v - tie) * 4) : 0.75 + 0.35 * v;
    const double angle = 2 * pi * cloth.folds * u + cloth.phase + 0.8 * std::sin(2.3 * u + 3 * v * cloth.sway);
    const double sway = 0.05 * cloth.sway * v * (1 - v) * std::sin(pi * u);
    const double sag = 0.05 * (1 - v) * std::sin(cloth.folds * pi * u) * std::sin(cloth.folds * pi * u);
    return frame(side * (edge - width * u) + 0.012 * std::sin(2 * angle), top + (bottom - top) * v - sag,
                 cloth.depth * loose * std::sin(angle) + sway);
  });
}

void addCurtains(Atrium& atrium, const Facade& facade) {
  for (int i = 0; i < facade.bays; ++i) {
    const uint64_t id = 0x400000 + 0x1000 * facade.id + 16 * static_cast<uint64_t>(i);
    Random random = atrium.random(id);
    const double kind = random.next();
    // The ends stay open, so that the portals are seen.
    if (facade.bays == 3 ? i == 1 : kind < 0.3) continue;
    const Frame centre = facade.frame.at(facade.bayCentre(i), 0, 0);
    constexpr std::array<Stuff, 3> colours = {red, green, blue};
    atrium.mesh.use(bronze);
    if (atrium.fine(0.1, id))
      atrium.mesh.tube({centre(-1.36, 3.33, 0), centre(1.36, 3.33, 0)}, 0.022, atrium.segments(6, 3, id + 2));
    atrium.mesh.use(colours[(static_cast<uint32_t>(i) + facade.id) % 3]);
    const double tie = kind < 0.8 ? random.between(0.55, 0.66) : 1;
    for (const double side : {-1.0, 1.0}) {
      const double reach = tie < 1 ? 1.31 : random.between(0.5, 1.1);
      addCurtainHalf(atrium, centre, side, reach, tie, drawCloth(random), id + (side > 0 ? 4 : 8));
      if (tie == 1 || !atrium.fine(0.2, id + 5)) continue;
      // The cord that gathers it.
      atrium.mesh.use(gold);
      atrium.mesh.lathe(centre.at(side * 1.21, 3.3 - 3.2 * tie, 0),
                        Profile(0.15, -0.05).outUp(0.165, 0, 2).upOut(0.15, 0.05, 2), atrium.segments(9, 4, id + 3));
      atrium.mesh.use(colours[(static_cast<uint32_t>(i) + facade.id) % 3]);
    }
  }
}

/// A short drape behind the rail of some of the gallery's arches.
void addGalleryDrapes(Atrium& atrium, const Facade& facade) {
  for (int i = 0; i < 2 * facade.bays; ++i) {
    const uint64_t id = 0x410000 + 0x1000 * facade.id + 8 * static_cast<uint64_t>(i);
    Random random = atrium.random(id);
    if (random.next() > 0.3) continue;
    const Cloth cloth = drawCloth(random);
    const double side = random.next() < 0.5 ? -1 : 1, length = random.between(1.5, 2.1),
                 reach = random.between(0.3, 0.6);
    const Frame centre = facade.frame.at(0.5 * bay * (i + 0.5) - facade.half(), 0, -0.06);
    constexpr std::array<Stuff, 3> colours = {gold, red, blue};
    atrium.mesh.use(colours[random.below(3)]);
    atrium.mesh.grid(atrium.segments(26, 3, id + 1), atrium.segments(16, 2, id + 2), [&](double u, double v) {
      const double angle = 2 * pi * 0.5 * cloth.folds * u + cloth.phase;
      const double width = reach * (1 - 0.3 * std::sin(pi * v));
      return centre(side * (0.58 - width * u), upperSpring - 0.02 - length * v,
                    0.04 * (0.7 + 0.3 * v) * std::sin(angle));
    });
  }
}

/// A long cloth over the rail: down to the cornice's edge, over it, and down the wall, with borders and a notched end.
void addBanner(Atrium& atrium, const Frame& frame, Stuff colour, uint64_t id) {
  Random random = atrium.random(id);
  const double half = 0.42, end = random.between(3.35, 3.7), phase = random.between(0, 2 * pi), over = 0.18;
  const uint32_t rows = atrium.segments(38, 4, id + 1);
  const uint32_t bend = std::max(1u, static_cast<uint32_t>(over * rows));
  // Row by row, with one at the bend whatever their number.
  const auto place = [&](double across, double down) {
    const uint32_t row = static_cast<uint32_t>(std::lround(down * rows));
    const double v = row <= bend ? over * row / bend : over + (1 - over) * (row - bend) / (rows - bend);
    const double ripple = 0.03 * v * std::sin(9 * v + 2.2 * across + phase) + 0.02 * v * std::sin(17 * across + phase);
    if (v < over) return frame(half * across, railTop + 0.02 - (railTop - 5.74) * v / over, 0.36 + 0.36 * v / over);
    const double t = (v - over) / (1 - over), notch = 0.3 * (1 - std::abs(across)) * std::max(0.0, t - 0.6) / 0.4;
    return frame(half * across * (1 - 0.05 * t), 5.74 - (5.74 - end) * t + notch, 0.725 + ripple);
  };
  const auto strip = [&](double from, double to, uint32_t columns) {
    atrium.mesh.grid(columns, rows, [&](double u, double v) { return place(from + (to - from) * u, v); });
  };
  atrium.mesh.use(colour);
  strip(-0.8, 0.8, 2 * atrium.segments(7, 1, id + 2));
  atrium.mesh.use(gold);
  strip(-1, -0.8, atrium.segments(2, 1, id + 3));
  strip(0.8, 1, atrium.segments(2, 1, id + 3));
}

void addLantern(Atrium& atrium, const dvec3& from, double drop, uint64_t id) {
  MeshBuilder& mesh = atrium.mesh;
  const uint32_t sides = atrium.segments(8, 4, id), curve = atrium.segments(2, 1, id + 1);
  const Frame frame{from - dvec3(0, drop, 0)};
  mesh.use(rope);
  mesh.tube({from, frame.origin}, 0.008, 3);
  mesh.use(bronze);
  mesh.lathe(frame, Profile(0.17, -0.14).to(0.17, -0.11).upOut(0.03, 0, curve).to(0, 0.03), sides);
  mesh.lathe(frame, Profile(0, -0.56).outUp(0.12, -0.48, curve).to(0.12, -0.46), sides);
  mesh.use(glass);
  mesh.lathe(frame, Profile(0.1, -0.46).ease(0.145, -0.13, curve), sides);
}

/// A rope between two points that sags like a parabola; returns its point at t.
template <typename Hang>
void addCable(Atrium& atrium, const dvec3& a, const dvec3& b, double sag, uint64_t id, const Hang& hang) {
  const uint32_t pieces = atrium.segments(22, 2, id);
  const auto at = [&](double t) { return a + (b - a) * t - dvec3(0, 4 * sag * t * (1 - t), 0); };
  std::vector<dvec3> path;
  for (uint32_t i = 0; i <= pieces; ++i) path.push_back(at(static_cast<double>(i) / pieces));
  atrium.mesh.use(rope);
  atrium.mesh.tube(path, 0.014, atrium.segments(4, 3, id + 1));
  hang(at);
}

void addCables(Atrium& atrium) {
  for (uint32_t k = 0; k < 7; ++k) {
    const uint64_t id = 0x430000 + 16 * k;
    Random random = atrium.random(id);
    const double x = bay * (k + 1) - halfLength, z = halfWidth - 0.3;
    const double sag = random.between(0.5, 1.3), skew = random.below(3) * bay - bay;
    const double farX = std::clamp(x + skew, 0.1 - halfLength, halfLength - 0.1);
    addCable(atrium, {x, 9.25, -z}, {farX, 9.25, z}, sag, id, [&](const auto& at) {
      const uint32_t lanterns = atrium.fine(0.12, id) ? 1 + random.below(2) : 0;
      for (uint32_t i = 0; i < lanterns; ++i) {
        const double along = (i + random.between(0.35, 0.65)) / lanterns, drop = random.between(0.15, 0.9);
        addLantern(atrium, at(along), drop, id + 4 * i + 4);
      }
    });
  }
  // Two the whole length of the court: triangles thirty times as long as they are wide.
  for (const double z : {-2.6, 2.2}) {
    Random random = atrium.random(z < 0 ? 0x440000 : 0x440010);
    const double farZ = z + random.between(-0.8, 0.8), sag = random.between(1.0, 1.6);
    addCable(atrium, {0.3 - halfLength, 9.2, z}, {halfLength - 0.3, 9.2, farZ}, sag, z < 0 ? 0x440001 : 0x440011,
             [](const auto&) {});
  }
}

}  // namespace

void buildFabric(Atrium& atrium) {
  for (const Facade& facade : Atrium::facades()) {
    addCurtains(atrium, facade);
    addGalleryDrapes(atrium, facade);
    if (facade.bays == 3) continue;
    constexpr std::array<Stuff, 4> colours = {red, blue, green, red};
    for (int i = 1; i < facade.bays; i += 2)
      if (atrium.fine(0.1, facade.id + static_cast<uint64_t>(i)))
        addBanner(atrium, facade.frame.at(facade.bayBorder(i), 0, 0), colours[static_cast<std::size_t>(i / 2)],
                  0x420000 + 0x100 * facade.id + 8 * static_cast<uint64_t>(i));
  }
  addCables(atrium);
}

}  // namespace copse::generator
