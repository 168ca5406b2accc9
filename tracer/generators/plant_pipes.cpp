// Pipes with bends, flanges with bolts, valves with handwheels, ducts with stiffeners, trays full of cables.
#include "tracer/generators/plant.h"

namespace copse::generator {

namespace {
constexpr Metal colours[] = {lagging, lagging, greenPipe, redPipe, yellowPipe, bluePipe, rust, galvanised};
}

void Plant::pipe(const std::vector<dvec3>& corners, double radius, uint64_t id) {
  const uint32_t sides = segments(14, 4, id), bend = segments(6, 1, id + 1);
  std::vector<dvec3> path = {corners.front()};
  for (std::size_t i = 1; i + 1 < corners.size(); ++i) {
    const dvec3 in = corners[i] - corners[i - 1], out = corners[i + 1] - corners[i];
    const double r = std::min({3 * radius, 0.45 * glm::length(in), 0.45 * glm::length(out)});
    const dvec3 a = corners[i] - r * glm::normalize(in), b = corners[i] + r * glm::normalize(out);
    const dvec3 centre = a + b - corners[i];
    for (uint32_t k = 0; k <= bend; ++k) {
      const double t = 0.5 * pi * k / bend;
      path.push_back(centre + std::cos(t) * (a - centre) + std::sin(t) * (b - centre));
    }
  }
  path.push_back(corners.back());
  mesh.bentTube(path, radius, sides);
}

void Plant::flange(const dvec3& at, const dvec3& along, double radius, uint64_t id) {
  const Frame f = frameAlong(at, along);
  const double outer = 1.45 * radius + 0.03, half = 0.12 * radius + 0.012, bolt = 0.06 * radius + 0.006;
  mesh.lathe(f,
             Profile(radius, -half)
                 .to(outer, -half)
                 .to(outer, -0.004)
                 .to(outer - 0.01, 0)
                 .to(outer, 0.004)
                 .to(outer, half)
                 .to(radius, half),
             segments(18, 5, id));
  const uint32_t bolts = repeats(12, 0, id + 1);
  for (uint32_t i = 0; i < bolts; ++i) {
    const double a = 2 * pi * i / bolts, r = 0.5 * (radius + outer) + 0.1 * radius;
    mesh.lathe(f.at(r * std::cos(a), 0, r * std::sin(a)),
               Profile(0, -2 * half).to(bolt, -2 * half).to(bolt, 2 * half).to(0, 2 * half), 6);
  }
}

void Plant::ring(const Frame& f, double radius, double thick, uint64_t id) {
  mesh.grid(
      segments(28, 8, id), segments(8, 3, id + 1),
      [&](double u, double v) {
        const double a = 2 * pi * u, b = 2 * pi * v, r = radius + thick * std::cos(b);
        return f(r * std::cos(a), thick * std::sin(b), r * std::sin(a));
      },
      true);
}

void Plant::valve(const dvec3& at, const dvec3& along, const dvec3& stem, double radius, uint64_t id) {
  const Frame body = frameAlong(at, along), up = frameAlong(at, stem);
  const uint32_t sides = segments(16, 5, id), curve = segments(4, 1, id + 1);
  mesh.use(darkIron);
  mesh.lathe(body, Profile(radius, -2.2 * radius).ease(1.6 * radius, 0, curve).ease(radius, 2.2 * radius, curve),
             sides);
  for (const double s : {-1.0, 1.0}) flange(at + s * 2.2 * radius * body.y, along, radius, id + 2);
  mesh.lathe(up,
             Profile(1.0 * radius, radius)
                 .to(0.9 * radius, 1.9 * radius)
                 .to(1.2 * radius, 1.9 * radius)
                 .to(1.2 * radius, 2.2 * radius)
                 .ease(0.3 * radius, 3 * radius, curve),
             sides);
  mesh.lathe(up, Profile(0.14 * radius, 2.9 * radius).to(0.14 * radius, 4.6 * radius).to(0, 4.6 * radius),
             segments(8, 4, id + 3));
  mesh.use(redPipe);
  const Frame wheel = up.at(0, 4.2 * radius, 0);
  ring(wheel, 1.8 * radius, 0.13 * radius, id + 4);
  for (int i = 0; i < 5; ++i) {
    const Frame spoke = wheel.turned(2 * pi * i / 5);
    mesh.tube({spoke(0, 0, 0), spoke(0, 0, 1.8 * radius)}, 0.08 * radius, segments(6, 3, id + 5));
  }
}

void Plant::duct(const Frame& f, double length, double width, double height, uint64_t id) {
  const double w = 0.5 * width, h = 0.5 * height;
  mesh.use(galvanised);
  mesh.box(f, {0, -h, -w}, {length, h, w});
  const uint32_t ribs = repeats(static_cast<uint32_t>(length / 0.5), 2, id);
  for (uint32_t i = 0; i <= ribs; ++i) {
    const double x = length * i / ribs, out = i % 4 ? 0.04 : 0.08, t = i % 4 ? 0.015 : 0.03;
    mesh.box(f, {x - t, -h - out, -w - out}, {x + t, -h, w + out});
    mesh.box(f, {x - t, h, -w - out}, {x + t, h + out, w + out});
    mesh.box(f, {x - t, -h, -w - out}, {x + t, h, -w});
    mesh.box(f, {x - t, -h, w}, {x + t, h, w + out});
  }
}

void Plant::cableTray(const Frame& f, double length, uint64_t id) {
  Random random = this->random(id);
  mesh.use(galvanised);
  for (const double z : {-0.3, 0.28}) {
    mesh.box(f, {0, 0, z}, {length, 0.1, z + 0.004});
    mesh.box(f, {0, 0, z}, {length, 0.004, z + 0.02});
  }
  const uint32_t rungs = repeats(static_cast<uint32_t>(length / 0.25), 2, id + 1);
  for (uint32_t i = 0; i < rungs; ++i) {
    const double x = length * (i + 0.5) / rungs;
    mesh.box(f, {x - 0.015, 0.01, -0.29}, {x + 0.015, 0.025, 0.28});
  }
  const uint32_t cables = repeats(9, 1, id + 2);
  const uint32_t pieces = segments(2.2 * length, 2, id + 3), sides = segments(7, 3, id + 4);
  for (uint32_t k = 0; k < cables; ++k) {
    const double z = -0.26 + 0.52 * (k + 0.5) / cables, r = random.between(0.008, 0.026), p = random.between(0, 6);
    mesh.use(k % 4 == 3 ? orange : cable);
    mesh.grid(
        sides, pieces,
        [&](double u, double v) {
          const double x = length * v, a = 2 * pi * u;
          return f(x, 0.026 + r + 0.004 * std::sin(2.1 * x + p) + r * std::sin(a),
                   z + 0.02 * std::sin(0.9 * x + 2 * p) + r * std::cos(a));
        },
        true);
  }
}

/// Above each row of cells on each level: pipes over its whole length that step up or down, a duct, trays of cables.
void Plant::buildPipeRacks() {
  for (int iy = 0; iy < levels; ++iy)
    for (int iz = 0; iz < nz; ++iz) {
      const uint64_t id = 0x4000000 + 0x10000ull * static_cast<uint64_t>(iy * 128 + iz);
      Random random = this->random(id);
      const double y = levelHeight * iy, z = cellSize * iz;
      const bool byFurnace = furnaceAt(nx / 2, iz);
      constexpr uint32_t pipes = 9;
      for (uint32_t k = 0; k < pipes; ++k) {
        const double radius = k % 3 == 0 ? random.between(0.1, 0.2) : random.between(0.03, 0.09);
        const double at = 0.9 + 0.42 * k + (k > 4 ? 0.5 : 0), high = 3.75 + 0.3 * (k % 2);
        const uint32_t colour = random.below(8);
        const uint64_t own = id + 0x400 * (k + 1);
        double x = -random.between(0.2, 2.0);
        const double end = lengthX() + random.between(0.2, 2.0);
        double now = high;
        while (x < end - 0.5) {
          double next = std::min(end, x + cellSize * (1 + random.below(3)) + random.between(-1, 1));
          const double step = random.next();
          // Pipes end before the furnace's walls and go on behind them.
          const double wall0 = cellSize * (nx / 2 - 1) - 0.5, wall1 = cellSize * (nx / 2 + 1) + 0.5;
          const bool blocked = byFurnace && next > wall0 && x < wall0;
          if (blocked) next = std::max(x + 0.4, wall0);
          mesh.use(colours[colour]);
          if (step < 0.3 && next - x > 2 && !blocked) {
            const double to = high + (now == high ? (step < 0.15 ? -0.42 : 0.36) : 0);
            pipe({{x, y + now, z + at},
                  {0.5 * (x + next), y + now, z + at},
                  {0.5 * (x + next), y + to, z + at},
                  {next, y + to, z + at}},
                 radius, own);
            now = to;
          } else {
            pipe({{x, y + now, z + at}, {next, y + now, z + at}}, radius, own);
          }
          flange({next, y + now, z + at}, {1, 0, 0}, radius, own + 3);
          if (step > 0.75 && next - x > 2) {  // A branch down to the machines, with a valve.
            const double bx = 0.5 * (x + next), low = y + 2.2 - 0.8 * random.next();
            mesh.use(colours[colour]);
            pipe({{bx, y + now, z + at}, {bx, low, z + at}, {bx + 0.9, low, z + at}}, 0.6 * radius, own + 7);
            valve({bx, 0.5 * (y + now + low), z + at}, {0, 1, 0}, {0, 0, -1}, 0.6 * radius, own + 9);
          }
          x = blocked ? wall1 : next;
        }
      }
      for (int tray = 0; tray < 2; ++tray)
        for (int ix = 0; ix < nx; ++ix)
          if (!furnaceAt(ix, iz))
            cableTray(cell(ix, iy, iz).at(0, 3.45 + 0.3 * tray, 5.35), cellSize,
                      id + 0x8000 + 0x20ull * static_cast<uint64_t>(2 * ix + tray));
      if ((iz + iy) % 2 == 0)
        for (int ix = 0; ix + 1 < nx; ix += 2)
          if (!furnaceAt(ix, iz) && !furnaceAt(ix + 1, iz))
            duct(cell(ix, iy, iz).at(0.4, 4.05, 2.9), 11.2, 0.75, 0.5,
                 id + 0xc000 + 0x40ull * static_cast<uint64_t>(ix));
    }
}

}  // namespace copse::generator
