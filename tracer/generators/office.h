// The plan of the office building: rooms of 4 m by 5.4 m on both sides of a corridor along x, stairs before x = 0.
#pragma once

#include "tracer/generators/indoor.h"

namespace copse::generator {

constexpr double roomWidth = 4, roomDepth = 5.4, corridorHalf = 1.2, storeyHeight = 3.4, roomHeight = 2.9;
constexpr double wingDepth = corridorHalf + roomDepth, wingApart = 34;

struct Office {
  int wings = 1, storeys = 1, along = 2;  ///< `along`: rooms on one side of a corridor.

  double length() const { return roomWidth * along; }
  /// The storey whose corridor and second room have light.
  int litStorey() const { return std::min(1, storeys - 1); }
  Frame wing(int w) const { return {{0, 0, -wingApart * w}}; }
  /// A room's frame: the middle of its floor, z towards the window. Side 0 looks along +z.
  Frame room(int w, int storey, int i, int side) const {
    const Frame f = wing(w).at(roomWidth * (i + 0.5), storeyHeight * storey, 0);
    return (side ? f.turned(pi) : f).at(0, 0, corridorHalf + 0.5 * roomDepth);
  }
};

void buildOffice(Indoor& indoor, const Office& plan);
/// One room's furniture; which, follows from the seed and the room's number.
void furnish(Indoor& indoor, const Frame& room, bool lit, bool viewed, uint64_t id);
/// Where sheets lie on the desk of the room that a view shows.
Frame deskTop(const Office& plan);

}  // namespace copse::generator
