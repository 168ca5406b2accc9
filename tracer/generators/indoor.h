// What stands in rooms: furniture, books, lamps, windows, plants. Metres, y up; a thing's frame has its origin on the
// floor under the thing's middle, z towards who uses it. Conference room and office building are put together of these.
#pragma once

#include "tracer/generators/level.h"

namespace copse::generator {

enum Finish : uint32_t {
  wallPaint,
  wallAccent,
  ceilingPaint,
  carpet,
  linoleum,
  oak,
  walnut,
  steel,
  chrome,
  blackPlastic,
  greyPlastic,
  porcelain,
  blueFabric,
  redFabric,
  greyFabric,
  sheet,
  clothRed,
  clothBlue,
  clothGreen,
  clothTan,
  leather,
  foliage,
  clay,
  display,
  lampShade,
  lampLit,
  drapery,
  concrete,
  pavement,
  pane,
  finishes
};

std::vector<Material> indoorMaterials();

struct Indoor : Level {
  MeshBuilder& mesh;

  /// A box with rounded edges all around, closed: half its size in each direction, and how square it is (1 is round).
  void cushion(const Frame& frame, const dvec3& half, double squareness, double atOne, uint64_t id);
  void leg(const dvec3& from, const dvec3& to, double radius, uint64_t id);

  void desk(const Frame& frame, double width, uint64_t id);
  void computer(const Frame& onDesk, uint64_t id);  ///< Monitor, keyboard of 84 keys, mouse.
  void swivelChair(const Frame& frame, Finish fabric, uint64_t id);
  void armchair(const Frame& frame, Finish fabric, uint64_t id);  ///< On a bent steel tube.
  void bookcase(const Frame& frame, double width, double height, uint64_t id);
  void books(const Frame& shelf, double width, double height, double depth, uint64_t id);
  void cabinet(const Frame& frame, double width, double height, uint32_t drawers, uint64_t id);
  void mug(const Frame& frame, uint64_t id);
  void bottle(const Frame& frame, uint64_t id);
  void papers(const Frame& frame, uint32_t count, double width, double depth, uint64_t id);
  void deskLamp(const Frame& frame, uint64_t id);
  void bin(const Frame& frame, uint64_t id);
  void pottedPlant(const Frame& frame, double height, uint64_t id);
  void picture(const Frame& frame, double width, double height, Finish finish);  ///< On a wall, looking along z.
  void clock(const Frame& frame, uint64_t id);

  /// In a wall's opening; the frame is the opening's middle at its foot, the wall lies in x and y.
  void door(const Frame& frame, double width, double height, double open, uint64_t id);
  void window(const Frame& frame, double width, double height, uint64_t id);
  void blinds(const Frame& frame, double width, double height, double drawn, uint64_t id);
  void curtain(const Frame& frame, double width, double height, Finish finish, uint64_t id);
  void radiator(const Frame& frame, double width, uint64_t id);
  /// A ceiling of that half size with two rows of flush lamps at z = -row and row. The lamps fill holes: what they send
  /// upwards meets nothing that is seen.
  void ceiling(const Frame& frame, double halfX, double halfZ, double row, uint32_t lampsARow, const dvec2& lamp,
               uint32_t lit);
  void railing(const dvec3& from, const dvec3& to, double height, uint64_t id);
  /// A wall of that thickness from x = -half to half with one opening [x0, x1] x [y0, y1].
  void wallWithOpening(const Frame& frame, double half, double height, double thickness, double x0, double x1,
                       double y0, double y1);
};

}  // namespace copse::generator
