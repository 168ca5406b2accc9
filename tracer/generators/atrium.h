// The court that the atrium's parts share: its measures in metres, its materials, its four facades, its level of
// detail.
//
// Plan: arcades stand on the rectangle |x| = 12.8, |z| = 4.8, in bays of 3.2 m; aisles run behind them, out to the
// walls at |x| = 16.4, |z| = 8.4. A facade's frame has x along it, y up from the ground and z towards the court, 0 in
// the wall's middle.
#pragma once

#include <array>

#include "tracer/generators/level.h"

namespace copse::generator {

enum Stuff : uint32_t {
  stone,
  paleStone,
  darkStone,
  plaster,
  terracotta,
  slabPale,
  slabDark,
  marble,
  wood,
  bronze,
  red,
  blue,
  green,
  gold,
  leaf,
  paleLeaf,
  soil,
  water,
  rope,
  glass,
  stuffs
};

constexpr double halfLength = 12.8, halfWidth = 4.8, bay = 3.2, aisle = 3.6;
constexpr double outerLength = halfLength + aisle, outerWidth = halfWidth + aisle;
constexpr double wallHalf = 0.3;                            ///< Half the thickness of the arcade's wall.
constexpr double groundSpring = 3.45, groundRadius = 1.22;  ///< Where the arches of the ground floor start.
constexpr double storeyTop = 5.35, galleryFloor = 5.75, railTop = 6.78;
constexpr double upperSpring = 8.4, upperTop = 9.35, eaves = 10.15, ridge = 11.7;

struct Facade {
  Frame frame;
  int bays;
  uint32_t id;

  double half() const { return 0.5 * bay * bays; }
  double bayCentre(int i) const { return bay * (i + 0.5) - half(); }
  double bayBorder(int i) const { return bay * i - half(); }
};

/// Detail is about 0.8 at 262,144 triangles.
struct Atrium : Level {
  MeshBuilder& mesh;

  static const std::array<Facade, 4>& facades();
};

// The parts, each in the file of that name. All are deterministic in seed and detail.
void buildShell(Atrium& atrium);    // floors, outer walls, piers, doors, ceilings
void buildArcade(Atrium& atrium);   // ground floor: columns, arches, vaults
void buildGallery(Atrium& atrium);  // first floor: balustrade, paired columns, arches
void buildRoof(Atrium& atrium);     // cornices, tiles
void buildFabric(Atrium& atrium);   // curtains, banners, cables, lanterns
void buildGarden(Atrium& atrium);   // fountain, urns, plants, trees without their leaves
/// As many leaves on the trees as make `triangles`.
void buildLeaves(Atrium& atrium, uint64_t triangles);

/// A round arch of up to `maxStones` separate stones through a wall of half-thickness `half`, in colours that take
/// turns, around frame(0, 0, 0) in the plane of x and y; each stone stands out a little by chance.
void buildArchStones(Atrium& atrium, const Frame& frame, double radius, double depth, double half, uint32_t maxStones,
                     uint64_t id);
/// The wall around such an arch, both faces: from x = -left to right and up to `top`, all relative to the arch's
/// centre.
void buildArchWall(Atrium& atrium, const Frame& frame, double radius, double left, double right, double top,
                   double half, uint64_t id);
/// A moulding along an arch's face at z: a half-round rib of that radius.
void buildHood(Atrium& atrium, const Frame& frame, double radius, double rib, double z, uint64_t id);

}  // namespace copse::generator
