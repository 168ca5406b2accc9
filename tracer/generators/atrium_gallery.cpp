// The first floor: turned balusters between pedestals, thin columns in twos and fours, small arches.
#include "tracer/generators/atrium.h"

namespace copse::generator {

namespace {

void addBaluster(Atrium& atrium, const Frame& frame, uint64_t id) {
  const uint32_t curve = atrium.segments(2.4, 1, id);
  atrium.mesh.lathe(frame,
                    Profile(0.06, 0)
                        .to(0.06, 0.05)
                        .to(0.035, 0.08)
                        .outUp(0.072, 0.22, curve)
                        .upOut(0.03, 0.47, curve)
                        .to(0.028, 0.52)
                        .outUp(0.05, 0.56, curve)
                        .upOut(0.032, 0.60, curve)
                        .to(0.06, 0.65)
                        .to(0.06, 0.70),
                    atrium.segments(9, 3, id + 1));
}

void addThinColumn(Atrium& atrium, const Frame& frame, uint64_t id) {
  const uint32_t sides = atrium.segments(13, 3, id), curve = atrium.segments(2, 1, id + 1);
  const double r = 0.085, height = upperSpring - railTop - 0.14;
  if (!atrium.fine(0.2, id)) {
    atrium.mesh.lathe(frame, Profile(r, 0).to(r, height), sides);
    return;
  }
  atrium.mesh.lathe(frame,
                    Profile(0.125, 0)
                        .to(0.125, 0.04)
                        .torus(0.015, 0.09, curve)
                        .to(r + 0.005, 0.13)
                        .ease(r - 0.008, height - 0.28, curve)
                        .torus(0.02, height - 0.23, curve)
                        .upOut(0.15, height - 0.03, curve)
                        .to(0.15, height),
                    sides);
}

/// Where arches meet: a pedestal in the balustrade, columns on it, a block on these. Four columns at a bay's border.
void addSupport(Atrium& atrium, const Frame& frame, bool border, uint64_t id) {
  MeshBuilder& mesh = atrium.mesh;
  if (!atrium.fine(0.15, id)) {
    mesh.use(marble);
    mesh.lathe(frame, Profile(0.12, galleryFloor).to(0.14, upperSpring), 3);
    return;
  }
  const double halfX = border ? 0.31 : 0.19, halfZ = 0.3;
  mesh.use(stone);
  mesh.box(frame, {-halfX, galleryFloor, -halfZ}, {halfX, railTop - 0.1, halfZ});
  mesh.use(paleStone);
  mesh.box(frame, {-halfX - 0.04, railTop - 0.1, -halfZ - 0.04}, {halfX + 0.04, railTop, halfZ + 0.04});
  mesh.use(marble);
  for (const double z : {-0.155, 0.155})
    if (border) {
      for (const double x : {-0.155, 0.155}) addThinColumn(atrium, frame.at(x, railTop, z), id);
    } else {
      addThinColumn(atrium, frame.at(0, railTop, z), id);
    }
  mesh.use(paleStone);
  mesh.box(frame, {-halfX - 0.02, upperSpring - 0.14, -0.32}, {halfX + 0.02, upperSpring, 0.32});
}

/// The balustrade between two supports; `length` is the opening's.
void addRail(Atrium& atrium, const Frame& frame, double length, uint64_t id) {
  MeshBuilder& mesh = atrium.mesh;
  mesh.use(paleStone);
  if (!atrium.fine(0.15, id)) {
    const double x = 0.5 * length;
    mesh.quad(frame(-x, galleryFloor, 0), frame(x, galleryFloor, 0), frame(x, railTop, 0), frame(-x, railTop, 0));
    return;
  }
  mesh.box(frame, {-0.5 * length, railTop - 0.1, -0.17}, {0.5 * length, railTop - 0.02, 0.17});
  mesh.use(stone);
  mesh.box(frame, {-0.5 * length, galleryFloor, -0.13}, {0.5 * length, galleryFloor + 0.12, 0.13});
  mesh.box(frame, {-0.5 * length, railTop - 0.2, -0.12}, {0.5 * length, railTop - 0.1, 0.12});
  const uint32_t balusters = atrium.repeats(5, 0, id);
  mesh.use(marble);
  for (uint32_t k = 0; k < balusters; ++k)
    addBaluster(atrium, frame.at(length * ((k + 0.5) / balusters - 0.5), galleryFloor + 0.12, 0), id + 1);
}

}  // namespace

void buildGallery(Atrium& atrium) {
  for (const Facade& facade : Atrium::facades()) {
    const uint64_t part = 0x100000 + 0x1000 * facade.id;
    const double half = 0.5 * bay, fromBorder = 0.31, fromMiddle = 0.19;
    for (int i = 0; i < 2 * facade.bays; ++i) {
      const uint64_t id = part + 32 * static_cast<uint64_t>(i);
      const bool even = i % 2 == 0;
      const double left = half * i - facade.half();
      if (i > 0) addSupport(atrium, facade.frame.at(left, 0, 0), even, id);
      // The opening lies between a border's wide support and a middle's narrow one.
      const double from = left + (even ? fromBorder : fromMiddle), to = left + half - (even ? fromMiddle : fromBorder);
      const double centre = 0.5 * (from + to);
      addRail(atrium, facade.frame.at(centre, 0, 0), to - from, id + 4);
      const Frame arch = facade.frame.at(centre, upperSpring, 0);
      const double radius = 0.5 * (to - from) + 0.02;
      buildArchStones(atrium, arch, radius - 0.02, 0.2, 0.25, 9, id + 8);
      atrium.mesh.use(stone);
      buildArchWall(atrium, arch, radius - 0.02, centre - left, left + half - centre, upperTop - upperSpring, 0.25,
                    id + 9);
      atrium.mesh.use(paleStone);
      buildHood(atrium, arch, radius + 0.18, 0.02, 0.25, id + 12);
    }
  }
}

}  // namespace copse::generator
