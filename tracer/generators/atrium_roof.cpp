// Cornices that run around the court with mitred corners, in very long thin triangles, and the tiled roof behind them.
#include "tracer/generators/atrium.h"

namespace copse::generator {

namespace {

/// A moulding around the court: (out from the wall's middle, height) from below to above.
void addCornice(MeshBuilder& mesh, const std::vector<dvec2>& outline) {
  const double rows = static_cast<double>(outline.size() - 1);
  mesh.grid(
      4, static_cast<uint32_t>(outline.size() - 1),
      [&](double u, double v) {
        const dvec2 p = outline[static_cast<std::size_t>(std::lround(v * rows))];
        const int corner = static_cast<int>(std::lround(4 * u)) & 3;
        const double sx = corner == 0 || corner == 3 ? 1 : -1, sz = corner < 2 ? 1 : -1;
        return dvec3(sx * (halfLength - p.x), p.y, sz * (halfWidth - p.x));
      },
      true);
}

/// Small blocks in a row under a cornice.
void addBlocks(Atrium& atrium, uint32_t aBay, double width, double low, double high, double from, double to,
               uint64_t id) {
  for (const Facade& facade : Atrium::facades()) {
    const uint32_t count = atrium.repeats(aBay * static_cast<uint32_t>(facade.bays), 0, id + facade.id);
    for (uint32_t k = 0; k < count; ++k) {
      const double x = (facade.half() - 0.35) * ((2.0 * k + 1) / count - 1);
      atrium.mesh.box(facade.frame, {x - 0.5 * width, low, from}, {x + 0.5 * width, high, to});
    }
  }
}

/// Half-round tiles from the eaves up to the outer wall, bent upwards by chance here and there.
void addTiles(Atrium& atrium) {
  const double eavesOut = 0.72, rise = (ridge - 0.1 - eaves - 0.06) / (aisle + eavesOut);
  for (const Facade& facade : Atrium::facades()) {
    const uint64_t part = 0x310000 + 0x1000 * facade.id;
    const double half = facade.half() - eavesOut, full = facade.half() + aisle;
    const uint32_t runs = atrium.repeats(static_cast<uint32_t>(2 * full / 0.34), 0, part);
    Random random = atrium.random(part);
    for (uint32_t k = 0; k < runs; ++k) {
      const double x = full * ((2.0 * k + 1) / runs - 1), width = std::min(0.14, 0.8 * full / runs);
      const double start = std::max(0.0, std::abs(x) - half), lift = random.between(0, 0.03),
                   lean = random.between(-0.03, 0.03);
      const uint64_t id = part + 2 * k + 1;
      atrium.mesh.grid(atrium.segments(5, 2, id), atrium.segments(2, 1, id + 1), [&](double u, double v) {
        const double along = start + (aisle + eavesOut - start) * v, a = pi * u;
        return facade.frame(x - width * std::cos(a) + lean * (v - 0.5),
                            eaves + 0.06 + rise * along + width * 0.75 * std::sin(a) + lift * (1 - v),
                            eavesOut - along);
      });
    }
  }
}

}  // namespace

void buildRoof(Atrium& atrium) {
  MeshBuilder& mesh = atrium.mesh;
  // Out of the arcade's wall at storeyTop, and level with the gallery's floor.
  mesh.use(paleStone);
  addCornice(mesh, {{0.2, 5.30},
                    {0.34, 5.30},
                    {0.36, 5.38},
                    {0.42, 5.40},
                    {0.44, 5.46},
                    {0.5, 5.50},
                    {0.58, 5.62},
                    {0.66, 5.64},
                    {0.66, 5.72},
                    {0.62, galleryFloor},
                    {-0.3, galleryFloor}});
  mesh.use(stone);
  addCornice(mesh, {{-wallHalf, storeyTop - 0.02}, {-wallHalf, galleryFloor}});
  addBlocks(atrium, 12, 0.12, 5.42, 5.54, 0.3, 0.52, 0x300000);

  mesh.use(paleStone);
  addCornice(mesh, {{0.2, 9.30},
                    {0.29, 9.30},
                    {0.31, 9.40},
                    {0.31, 9.62},
                    {0.36, 9.66},
                    {0.38, 9.76},
                    {0.56, 9.86},
                    {0.66, 9.90},
                    {0.66, 10.0},
                    {0.72, 10.04},
                    {0.74, eaves},
                    {0.3, eaves + 0.03}});
  mesh.use(stone);
  addCornice(mesh, {{-0.25, 9.28}, {-0.25, 9.8}});
  addBlocks(atrium, 5, 0.16, 9.66, 9.85, 0.28, 0.6, 0x301000);

  // The roof's own surface, below the tiles: one quad a side, mitred like the cornices.
  mesh.use(terracotta);
  addCornice(mesh, {{0.72, eaves + 0.02}, {-aisle, ridge - 0.12}});
  addTiles(atrium);
}

}  // namespace copse::generator
