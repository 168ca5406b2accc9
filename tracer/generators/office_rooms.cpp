// What the office's rooms are used for: one or two desks, a table for meetings, a row of computers, or shelves.
#include "tracer/generators/office.h"

namespace copse::generator {

namespace {

constexpr Finish fabrics[] = {blueFabric, redFabric, greyFabric, blackPlastic};

void workplace(Indoor& in, const Frame& f, Random& random, uint64_t id) {
  in.desk(f, 1.6, id);
  in.computer(f.at(random.between(-0.25, 0.1), 0.745, -0.05), id + 0x10);
  const double turn = random.between(-0.7, 0.7), away = random.between(0.65, 0.85);
  const uint32_t fabric = random.below(4), sheets = random.below(7);
  in.swivelChair(f.at(random.between(-0.3, 0.2), 0, away).turned(pi + turn), fabrics[fabric], id + 0x20);
  in.papers(f.at(0.45, 0.7455, 0.1), 2 + sheets, 0.3, 0.2, id + 0x30);
  in.mug(f.at(-0.55, 0.745, 0.2), id + 0x31);
  in.deskLamp(f.at(-0.65, 0.745, -0.2).turned(0.7), id + 0x33);
  in.bin(f.at(-0.95, 0, 0.1), id + 0x37);
  // A row of books at the desk's back edge.
  in.books(f.at(0.5, 0.745, -0.27), 0.45, 0.27, 0.2, id + 0x38);
}

Frame viewedDesk(const Frame& room) { return room.at(1.12, 0, 1.0).turned(-0.5 * pi); }

}  // namespace

Frame deskTop(const Office& plan) { return viewedDesk(plan.room(0, plan.litStorey(), 1, 0)).at(0.3, 0.748, 0.12); }

void furnish(Indoor& in, const Frame& room, bool lit, bool viewed, uint64_t id) {
  Random random = in.random(id);
  const double kind = viewed ? 0.5 : random.next();
  const double front = 0.5 * roomDepth;
  in.radiator(room.at(0, 0, front - 0.14), 1.8, id + 0x100);
  in.blinds(room.at(0, 0.92, front - 0.02).turned(pi), 2.4, 1.66, random.between(0.15, 0.9), id + 0x200);
  in.clock(room.at(-1.92, 2.3, -1.3).turned(0.5 * pi), id + 0x2f0);
  in.picture(room.at(-1.92, 1.7, 0.6).turned(0.5 * pi), 1.0, 0.7, kind < 0.5 ? clothGreen : clothTan);
  in.ceiling(room.at(0, roomHeight, 0), 0.5 * roomWidth, front, 1.2, 1, {1.5, 0.6}, viewed ? 2 : lit ? 1 : 0);

  if (kind < 0.3) {  // One desk, many books.
    workplace(in, room.at(0.3, 0, 1.1).turned(pi), random, id + 0x300);
    for (int i = 0; i < 3; ++i)
      in.bookcase(room.at(1.77, 0, -1.9 + 1.25 * i).turned(-0.5 * pi), 1.2, 2.1,
                  id + 0x400 + 0x100 * static_cast<uint64_t>(i));
    in.armchair(room.at(-1.2, 0, -0.9).turned(0.9), greyFabric, id + 0x800);
    in.pottedPlant(room.at(-1.5, 0, 2.2), 1.3, id + 0x900);
  } else if (kind < 0.65) {  // Two desks.
    workplace(in, viewedDesk(room), random, id + 0x300);
    workplace(in, room.at(-1.12, 0, 1.0).turned(0.5 * pi), random, id + 0x400);
    in.bookcase(room.at(1.77, 0, -1.2).turned(-0.5 * pi), 1.8, 2.1, id + 0x500);
    in.cabinet(room.at(-1.66, 0, -1.0).turned(0.5 * pi), 0.8, 1.1, 4, id + 0x700);
    in.pottedPlant(room.at(-1.66, 1.1, -1.0), 0.6, id + 0x800);
  } else if (kind < 0.78) {  // A table with eight chairs.
    in.mesh.use(walnut);
    in.mesh.box(room, {-0.65, 0.71, -1.5}, {0.65, 0.75, 1.5});
    in.mesh.box(room, {-0.4, 0, -1.0}, {0.4, 0.71, -0.9});
    in.mesh.box(room, {-0.4, 0, 0.9}, {0.4, 0.71, 1.0});
    for (int i = 0; i < 8; ++i) {
      const double side = i % 2 ? 1 : -1;
      const double away = random.between(0.95, 1.15), turn = random.between(-0.3, 0.3);
      const uint64_t seat = id + 0x300 + 0x20 * static_cast<uint64_t>(i);
      in.armchair(room.at(away * side, 0, -1.15 + 0.76 * (i / 2)).turned(-0.5 * pi * side + turn), redFabric, seat);
      in.papers(room.at(0.4 * side, 0.751, -1.15 + 0.76 * (i / 2)), 1 + random.below(3), 0.1, 0.1, seat + 0x10);
      if (i % 3 == 0) in.mug(room.at(0.2 * side, 0.75, -1.0 + 0.76 * (i / 2)), seat + 0x11);
    }
    in.mesh.use(sheet);
    in.mesh.box(room, {1.89, 0.9, -1.4}, {1.93, 2.2, 1.4});
    in.pottedPlant(room.at(1.5, 0, 2.2), 1.5, id + 0x500);
  } else if (kind < 0.9) {  // Computers along both walls.
    for (int i = 0; i < 3; ++i)
      for (const double s : {-1.0, 1.0})
        workplace(in, room.at(1.45 * s, 0, -1.6 + 1.65 * i).turned(-0.5 * pi * s), random,
                  id + 0x300 + 0x100 * static_cast<uint64_t>(2 * i + (s > 0)));
  } else {  // Shelves.
    for (int row = 0; row < 4; ++row)
      for (int i = 0; i < 2; ++i)
        in.bookcase(room.at(-1.35 + 0.9 * row, 0, -0.9 + 1.9 * i).turned(row % 2 ? 0.5 * pi : -0.5 * pi), 1.8, 2.3,
                    id + 0x300 + 0x100 * static_cast<uint64_t>(2 * row + i));
  }
}

}  // namespace copse::generator
