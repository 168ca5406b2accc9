// Vessels, heat exchangers, pumps, manifolds, cabinets, fans; the furnace with its walls of tubes; the yard outside.
#include "tracer/generators/plant.h"

namespace copse::generator {

void Plant::vessel(const Frame& f, uint64_t id) {
  Random random = this->random(id);
  const double r = random.between(0.8, 1.25), high = 3.1;
  const uint32_t sides = segments(36, 8, id + 1), curve = segments(7, 2, id + 2);
  mesh.use(random.next() < 0.5 ? lagging : whiteTank);
  mesh.lathe(f,
             Profile(0, 0.35).outUp(r, 0.75, curve).to(r, high - 0.45).upOut(0.15, high - 0.02, curve).to(0.15, high),
             sides);
  mesh.use(galvanised);
  for (const double y : {1.1, 1.75, 2.4})
    mesh.lathe(f, Profile(r, y).to(r + 0.02, y).to(r + 0.02, y + 0.06).to(r, y + 0.06), sides);
  mesh.use(darkIron);
  for (int i = 0; i < 4; ++i) {
    const double a = 0.5 * pi * (i + 0.5);
    beam(f(0.85 * r * std::cos(a), 0, 0.85 * r * std::sin(a)), f(0.85 * r * std::cos(a), 0.8, 0.85 * r * std::sin(a)),
         0.16, 0.14);
  }
  for (int i = 0; i < 4; ++i) {  // Nozzles.
    const Frame side = f.turned(0.5 * pi * i + 0.4);
    const double y = 0.95 + 0.45 * i, n = 0.06 + 0.03 * (i % 3);
    mesh.use(lagging);
    pipe({side(0, y, r - 0.05), side(0, y, r + 0.25)}, n, id + 8 + static_cast<uint64_t>(i));
    flange(side(0, y, r + 0.25), side.z, n, id + 16 + static_cast<uint64_t>(i));
  }
  ladder(f.turned(2.4).at(0, 0, r + 0.2), 2.4, false, id + 30);
}

void Plant::exchanger(const Frame& f, uint64_t id) {
  Random random = this->random(id);
  const double r = random.between(0.4, 0.62), y = 1.3, half = 1.7;
  const uint32_t sides = segments(32, 8, id + 1), curve = segments(6, 2, id + 2);
  for (int k = 0; k < 2; ++k) {
    const Frame axis = frameAlong(f(-half, y, 0.8 * (2 * k - 1)), f.x);
    mesh.use(k ? lagging : greenPipe);
    mesh.lathe(axis, Profile(0, -0.3).outUp(r, 0, curve).to(r, 2 * half).upOut(0, 2 * half + 0.3, curve), sides);
    mesh.use(darkIron);
    for (const double at : {0.15, 2 * half - 0.15}) flange(axis(0, at, 0), axis.y, r, id + 4);
    for (const double at : {0.9, 2.5}) {
      mesh.box(f, {-half + at - 0.12, 0, 0.8 * (2 * k - 1) - r},
               {-half + at + 0.12, y - 0.6 * r, 0.8 * (2 * k - 1) + r});
      mesh.use(lagging);
      pipe({axis(0, at, 0), axis(0, at, 0) + dvec3(0, 1.15, 0), axis(0, at + 0.5, 0) + dvec3(0, 1.15, 0)}, 0.11,
           id + 12);
      flange(axis(0, at, 0) + dvec3(0, 0.85, 0), {0, 1, 0}, 0.11, id + 16);
      mesh.use(darkIron);
    }
  }
}

void Plant::pumps(const Frame& f, uint64_t id) {
  for (int k = 0; k < 3; ++k) {
    const double z = 1.35 * (k - 1);
    const uint64_t own = id + 0x20 * static_cast<uint64_t>(k);
    mesh.use(gravel);
    mesh.box(f, {-1.7, 0, z - 0.42}, {1.5, 0.22, z + 0.42});
    mesh.use(bluePipe);
    const Frame motor = frameAlong(f(-1.5, 0.72, z), f.x);
    const uint32_t sides = segments(28, 8, own), curve = segments(5, 2, own + 1);
    mesh.lathe(
        motor,
        Profile(0, 0).to(0.3, 0).to(0.34, 0.12).to(0.34, 1.3).upOut(0.1, 1.45, curve).to(0.06, 1.45).to(0.06, 1.9),
        sides);
    const uint32_t fins = repeats(26, 0, own + 2);
    for (uint32_t i = 0; i < fins; ++i)
      mesh.box(motor.turned(2 * pi * i / fins), {-0.007, 0.16, 0.33}, {0.007, 1.26, 0.4});
    mesh.box(f, {-1.35, 0.22, z - 0.25}, {-0.3, 0.45, z + 0.25});
    mesh.use(greenPipe);
    const Frame volute = frameAlong(f(0.62, 0.72, z), f.x);
    ring(volute, 0.3, 0.17, own + 3);
    mesh.lathe(volute, Profile(0, -0.14).to(0.3, -0.14).to(0.3, 0.14).to(0.13, 0.2).to(0.13, 0.5), sides);
    flange(volute(0, 0.5, 0), f.x, 0.13, own + 5);
    mesh.use(lagging);
    pipe({f(0.62, 0.75, z + 0.32), f(0.62, 2.6, z + 0.32), f(0.62, 2.6, z + 0.1)}, 0.1, own + 8);
    flange(f(0.62, 1.3, z + 0.32), {0, 1, 0}, 0.1, own + 10);
    valve(f(0.62, 1.85, z + 0.32), {0, 1, 0}, f.x, 0.1, own + 12);
    mesh.use(lagging);
    pipe({f(1.12, 0.72, z), f(1.75, 0.72, z), f(1.75, 0.05, z)}, 0.13, own + 24);
  }
}

void Plant::manifold(const Frame& f, uint64_t id) {
  Random random = this->random(id);
  for (const double y : {0.5, 2.7}) {
    mesh.use(lagging);
    pipe({f(-2, y, 0), f(2, y, 0)}, 0.2, id);
    flange(f(-2, y, 0), f.x, 0.2, id + 2);
    flange(f(2, y, 0), f.x, 0.2, id + 2);
  }
  constexpr Metal colours[] = {greenPipe, redPipe, yellowPipe, bluePipe};
  for (int i = 0; i < 8; ++i) {
    const double x = -1.75 + 0.5 * i, r = random.between(0.04, 0.07), out = random.between(0.35, 0.7),
                 y = random.between(1.3, 1.9);
    const uint64_t own = id + 0x20 * static_cast<uint64_t>(i + 1);
    mesh.use(colours[i % 4]);
    pipe({f(x, 0.5, 0), f(x, 0.5, out), f(x, 2.7, out), f(x, 2.7, 0)}, r, own);
    valve(f(x, y, out), {0, 1, 0}, f.z, r, own + 2);
    mesh.use(colours[i % 4]);
    pipe({f(x, 0.5, 0), f(x, 0.5, -0.5), f(x, 0.05, -0.5)}, r, own + 12);
    flange(f(x, 0.5, 0.26), f.z, r, own + 14);
  }
  mesh.use(oxide);
  for (const double x : {-1.9, 0.0, 1.9}) beam(f(x, 0, -0.28), f(x, 3, -0.28), 0.14, 0.12);
}

void Plant::cabinets(const Frame& f, uint64_t id) {
  for (int i = 0; i < 5; ++i) {
    const double x = -1.95 + 0.78 * i;
    mesh.use(whiteTank);
    mesh.box(f, {x, 0.08, -0.4}, {x + 0.76, 2.1, 0.1});
    mesh.use(darkIron);
    mesh.box(f, {x, 0, -0.4}, {x + 0.76, 0.08, 0.1});
    const uint32_t slots = repeats(14, 1, id + static_cast<uint64_t>(i));
    for (uint32_t s = 0; s < slots; ++s)
      for (const double y : {0.25, 1.7})
        mesh.box(f, {x + 0.12, y + 0.3 * s / slots, 0.1}, {x + 0.64, y + 0.3 * s / slots + 0.16 / slots, 0.112});
    for (int k = 0; k < 6; ++k) {
      mesh.use(k % 2 ? redPipe : greenPipe);
      Frame lamp = f.at(x + 0.18 + 0.08 * k, 1.45, 0.1);
      std::swap(lamp.y, lamp.z);
      mesh.lathe(lamp, Profile(0.022, 0).to(0.022, 0.015).to(0, 0.03), segments(12, 5, id + 20));
    }
  }
  for (int i = 0; i < 3; ++i)
    cableTray(f.at(-2, 2.35 + 0.28 * i, -0.1), 4, id + 0x40 + 0x10 * static_cast<uint64_t>(i));
}

void Plant::fan(const Frame& f, uint64_t id) {
  mesh.use(galvanised);
  duct(f.at(-2, 2.3, 0), 4, 1.5, 0.9, id);
  const Frame axis = frameAlong(f(0, 0.95, -0.75), f.z);
  const uint32_t sides = segments(40, 10, id + 1);
  mesh.use(orange);
  mesh.lathe(axis, Profile(0.35, -0.1).to(0.85, 0).to(0.85, 1.2).to(0.35, 1.3), sides);
  mesh.use(darkIron);
  ring(axis.at(0, -0.1, 0), 0.38, 0.05, id + 2);
  const uint32_t blades = repeats(24, 5, id + 3);
  for (uint32_t i = 0; i < blades; ++i) mesh.box(axis.turned(2 * pi * i / blades), {-0.01, 0.1, 0.3}, {0.01, 1.1, 0.7});
  mesh.box(f, {-0.8, 0, -0.7}, {0.8, 0.16, 0.6});
}

/// Four walls of upright tubes through all levels, held by girders, with headers at both ends.
void Plant::buildFurnace() {
  if (!(nx > 3 && nz > 2)) return;
  const double x0 = cellSize * (nx / 2 - 1) + 0.5, x1 = cellSize * (nx / 2 + 1) - 0.5;
  const double z0 = cellSize * (nz / 2 - 1) + 0.5, z1 = cellSize * (nz / 2 + 1) - 0.5, top = levelHeight * levels + 3;
  const uint32_t pieces = static_cast<uint32_t>(levels) * segments(2, 1, 0x7000000);
  const auto wall = [&](const dvec3& from, const dvec3& along, double length) {
    const uint32_t tubes = repeats(static_cast<uint32_t>(length / 0.075), 12, 0x7000001);
    const uint32_t sides = segments(10, 3, 0x7000002);
    mesh.use(rust);
    for (uint32_t i = 0; i < tubes; ++i) {
      const dvec3 foot = from + along * (length * (i + 0.5) / tubes);
      std::vector<dvec3> path;
      for (uint32_t k = 0; k <= pieces; ++k) path.push_back(foot + dvec3(0, 1.5 + (top - 1.5) * k / pieces, 0));
      mesh.tube(path, 0.42 * length / tubes, sides);
    }
    mesh.use(lagging);
    for (const double y : {1.4, top})
      pipe({from + dvec3(0, y, 0) - 0.2 * along, from + dvec3(0, y, 0) + along * (length + 0.2)}, 0.22, 0x7000004);
    mesh.use(oxide);
    for (double y = 3; y < top; y += 2.5)
      beam(from + dvec3(0, y, 0), from + dvec3(0, y, 0) + along * length, 0.34, 0.3);
  };
  wall({x0, 0, z0}, {1, 0, 0}, x1 - x0);
  wall({x0, 0, z1}, {1, 0, 0}, x1 - x0);
  wall({x0, 0, z0}, {0, 0, 1}, z1 - z0);
  wall({x1, 0, z0}, {0, 0, 1}, z1 - z0);
  // The drum on top, with risers.
  mesh.use(lagging);
  const Frame drum = frameAlong({x0 - 1, top + 1.6, 0.5 * (z0 + z1)}, {1, 0, 0});
  const uint32_t curve = segments(8, 2, 0x7000010);
  mesh.lathe(drum, Profile(0, 0).outUp(0.85, 0.6, curve).to(0.85, x1 - x0 + 1.4).upOut(0, x1 - x0 + 2, curve),
             segments(40, 8, 0x7000011));
  for (int i = 0; i < 20; ++i) {
    const double x = x0 + (x1 - x0) * (i + 0.5) / 20;
    for (const double z : {z0, z1})
      pipe({{x, top, z}, {x, top + 1.6, z}, {x, top + 1.6, 0.5 * (z0 + z1)}}, 0.1, 0x7000012);
  }
}

void Plant::buildYard() {
  const double x = lengthX(), z = lengthZ(), wide = 60 + x;
  mesh.use(gravel);
  mesh.quad({-wide, 0, z + wide}, {x + wide, 0, z + wide}, {x + wide, 0, -wide}, {-wide, 0, -wide});
  mesh.use(tarmac);
  mesh.box(Frame{{0, 0, 0}}, {-wide, 0, -19}, {x + wide, 0.03, -12});
  // The stack: brick below, with bands, platforms and a ladder.
  const double high = std::max(28.0, 2.1 * levelHeight * levels);
  const Frame stack{{x + 11, 0, 0.7 * z + 2}};
  const uint32_t sides = segments(56, 10, 0x8000000), rows = segments(30, 4, 0x8000001);
  for (int part = 0; part < 6; ++part) {
    mesh.use(part % 2 && part > 2 ? redPipe : part > 2 ? whiteTank : brick);
    mesh.grid(
        sides, rows,
        [&](double u, double v) {
          const double t = (part + v) / 6, r = 3.4 - 1.5 * t;
          return stack(r * std::cos(2 * pi * u), high * t, r * std::sin(2 * pi * u));
        },
        true);
  }
  for (const double t : {0.45, 0.95}) {
    const double r = 3.4 - 1.5 * t;
    mesh.use(galvanised);
    mesh.lathe(stack, Profile(r, high * t).to(r + 1.1, high * t).to(r + 1.1, high * t + 0.06), sides);
    for (int i = 0; i < 16; ++i) {
      const double a = 2 * pi * i / 16, b = 2 * pi * (i + 1) / 16, q = r + 1.05;
      handrail(stack(q * std::cos(a), high * t, q * std::sin(a)), stack(q * std::cos(b), high * t, q * std::sin(b)),
               0x8000010);
    }
  }
  Frame rungs = stack.at(0, 0, 3.5);
  rungs.y = glm::normalize(dvec3(0, high, -1.5));
  ladder(rungs, 0.95 * high, true, 0x8000020);
  // Storage tanks, with a walkway around their roofs and flights that wind up.
  const int tanks = std::clamp(nx / 3, 1, 6);
  for (int i = 0; i < tanks; ++i) {
    const double r = 4.6, tall = 6.5 + (i % 3);
    const uint64_t id = 0x8100000 + 0x1000 * static_cast<uint64_t>(i);
    const Frame tank{{6 + 14.0 * i, 0, -30}};
    mesh.use(whiteTank);
    mesh.lathe(tank, Profile(r, 0).to(r, tall).to(r - 0.4, tall + 0.25).to(0, tall + 0.9), segments(64, 10, id));
    mesh.use(galvanised);
    for (double y = 1.2; y < tall; y += 1.3)
      mesh.lathe(tank, Profile(r, y).to(r + 0.05, y).to(r + 0.05, y + 0.08).to(r, y + 0.08), segments(64, 10, id));
    constexpr int treads = 34;
    for (int k = 0; k < treads; ++k) {
      const double a = -2.6 + 0.06 * k, y = tall * (k + 1) / treads;
      Frame step{tank((r + 0.1) * std::cos(a), y, (r + 0.1) * std::sin(a)),
                 {-std::sin(a), 0, std::cos(a)},
                 {0, 1, 0},
                 {std::cos(a), 0, std::sin(a)}};
      grating(step, 0.27, 0.8, id + static_cast<uint64_t>(k));
      if (k % 3 == 0)
        handrail(step(0, 0, 0.8),
                 tank((r + 0.9) * std::cos(a + 0.18), y + 3 * tall / treads, (r + 0.9) * std::sin(a + 0.18)),
                 id + 0x80);
    }
    for (int k = 0; k < 20; ++k) {
      const double a = 2 * pi * k / 20, b = 2 * pi * (k + 1) / 20;
      handrail(tank(r * std::cos(a), tall, r * std::sin(a)), tank(r * std::cos(b), tall, r * std::sin(b)), id + 0x90);
    }
    mesh.use(lagging);
    pipe({tank(0, 0.7, r - 0.1), tank(0, 0.7, r + 2), tank(0, 4.2, r + 2), tank(0, 4.2, 20), tank(0, 4.2, 31)}, 0.22,
         id + 0xa0);
    flange(tank(0, 0.7, r + 0.4), {0, 0, 1}, 0.22, id + 0xa8);
    valve(tank(0, 0.7, r + 1.1), {0, 0, 1}, {1, 0, 0}, 0.22, id + 0xb0);
  }
}

}  // namespace copse::generator
