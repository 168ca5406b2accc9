// What a plant is put together of. Metres, y up. Cells of 6 m by 6 m stand on levels 5 m apart; along the low z of each
// runs a walkway, above which nothing hangs lower than 3.2 m.
#pragma once

#include "tracer/generators/level.h"

namespace copse::generator {

enum Metal : uint32_t {
  oxide,
  galvanised,
  lagging,
  greenPipe,
  redPipe,
  yellowPipe,
  bluePipe,
  whiteTank,
  rust,
  darkIron,
  orange,
  cable,
  tarmac,
  gravel,
  brick,
  metals
};

constexpr double cellSize = 6, levelHeight = 5;

struct Plant : Level {
  MeshBuilder& mesh;
  int nx = 2, nz = 1, levels = 1;

  double lengthX() const { return cellSize * nx; }
  double lengthZ() const { return cellSize * nz; }
  Frame cell(int ix, int iy, int iz) const { return {{cellSize * ix, levelHeight * iy, cellSize * iz}}; }
  /// Cells where the furnace stands through all levels.
  bool furnaceAt(int ix, int iz) const {
    return nx > 3 && nz > 2 && (ix == nx / 2 || ix == nx / 2 - 1) && (iz == nz / 2 || iz == nz / 2 - 1);
  }

  // Steel (plant_steel.cpp).
  void beam(const dvec3& from, const dvec3& to, double height, double width);  ///< An I-profile.
  void bar(const dvec3& from, const dvec3& to, double thick);                  ///< A square one.
  void grating(const Frame& corner, double x, double z, uint64_t id);          ///< Bearing bars along z, rods along x.
  void handrail(const dvec3& from, const dvec3& to, uint64_t id);
  void stairs(const Frame& foot, double rise, double run, double width, uint64_t id);  ///< Up along +x.
  void ladder(const Frame& foot, double height, bool caged, uint64_t id);              ///< Climbed looking along -z.
  void buildSteel();

  // Pipes (plant_pipes.cpp).
  /// Through the corners with bends of one and a half diameters.
  void pipe(const std::vector<dvec3>& corners, double radius, uint64_t id);
  void flange(const dvec3& at, const dvec3& along, double radius, uint64_t id);
  void valve(const dvec3& at, const dvec3& along, const dvec3& stem, double radius, uint64_t id);
  void ring(const Frame& frame, double radius, double thick, uint64_t id);                 ///< Around y.
  void duct(const Frame& start, double length, double width, double height, uint64_t id);  ///< Along x.
  void cableTray(const Frame& start, double length, uint64_t id);                          ///< Along x.
  void buildPipeRacks();

  // Machines (plant_machines.cpp). Each stands within x and z of -2.1 to 2.1 around its frame, below 3.2 m.
  void vessel(const Frame& frame, uint64_t id);
  void exchanger(const Frame& frame, uint64_t id);
  void pumps(const Frame& frame, uint64_t id);
  void manifold(const Frame& frame, uint64_t id);
  void cabinets(const Frame& frame, uint64_t id);
  void fan(const Frame& frame, uint64_t id);
  void buildFurnace();
  void buildYard();  ///< Stack, tanks, ground.
};

/// A frame with y along a direction.
Frame frameAlong(const dvec3& origin, const dvec3& along);

}  // namespace copse::generator
