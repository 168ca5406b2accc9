// The court that the atrium's parts share: its measures in metres, its materials, its four facades, its level of
// detail.
//
// Plan: arcades stand on the rectangle |x| = 12.8, |z| = 4.8, in bays of 3.2 m; aisles run behind them, out to the
// walls at |x| = 16.4, |z| = 8.4. A facade's frame has x along it, y up from the ground and z towards the court, 0 in
// the wall's middle.
#pragma once

#include <algorithm>
#include <array>

#include "tracer/scene/generators/mesh_builder.h"
#include "tracer/scene/generators/random.h"

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

struct Atrium {
  MeshBuilder& mesh;
  double detail;  ///< About 0.8 at 262,144 triangles; segments grow with it, triangles with its square.
  uint64_t seed;

  static const std::array<Facade, 4>& facades();

  Random random(uint64_t part) const { return Random(seed, part); }
  /// Whether a thing is to be had at this detail: from about `from` on, each `id` from a detail of its own.
  bool fine(double from, uint64_t id) const { return detail > from * (0.7 + 0.6 * dither(id)); }
  /// Segments of one thing. Things of different `id` gain theirs at different detail, so the whole grows smoothly.
  uint32_t segments(double atOne, uint32_t least, uint64_t id) const {
    return std::max(least, static_cast<uint32_t>(atOne * detail + dither(id)));
  }
  /// How many of a thing: as many as `full` from detail 0.7 on, fewer on a coarse level.
  uint32_t repeats(uint32_t full, uint32_t least, uint64_t id) const {
    return std::clamp(static_cast<uint32_t>(full * detail / 0.7 + dither(id)), least, full);
  }

 private:
  static double dither(uint64_t id) { return static_cast<double>(mix(id) >> 11) * 0x1p-53; }
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

/// A round arch of up to `most` separate stones through a wall of half-thickness `half`, in colours that take turns,
/// around frame(0, 0, 0) in the plane of x and y; each stone stands out a little by chance.
void buildArchStones(Atrium& atrium, const Frame& frame, double radius, double depth, double half, uint32_t most,
                     uint64_t id);
/// The wall around such an arch, both faces: from x = -left to right and up to `top`, all relative to the arch's
/// centre.
void buildArchWall(Atrium& atrium, const Frame& frame, double radius, double left, double right, double top,
                   double half, uint64_t id);
/// A moulding along an arch's face at z: a half-round rib of that radius.
void buildHood(Atrium& atrium, const Frame& frame, double radius, double rib, double z, uint64_t id);

}  // namespace copse::generator
