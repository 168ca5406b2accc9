// Doors, windows, blinds, lamps, radiators, railings, plants.
#include "tracer/generators/indoor.h"

namespace copse::generator {

void Indoor::deskLamp(const Frame& f, uint64_t id) {
  const uint32_t sides = segments(16, 5, id);
  mesh.use(steel);
  mesh.lathe(f, Profile(0.085, 0).to(0.085, 0.012).ease(0.014, 0.035, segments(3, 1, id + 1)).to(0, 0.036), sides);
  mesh.tube({f(0, 0.03, 0), f(0, 0.22, -0.07)}, 0.007, segments(7, 3, id + 2));
  mesh.tube({f(0, 0.22, -0.07), f(0, 0.42, 0.08)}, 0.007, segments(7, 3, id + 2));
  mesh.use(clothGreen);
  mesh.lathe(f.at(0, 0.34, 0.1), Profile(0.085, 0).ease(0.03, 0.08, segments(4, 1, id + 3)).to(0, 0.085), sides);
}

void Indoor::bin(const Frame& f, uint64_t id) {
  mesh.use(blackPlastic);
  mesh.lathe(f, Profile(0, 0.002).to(0.11, 0.004).to(0.145, 0.32).to(0.137, 0.32).to(0.104, 0.01), segments(18, 6, id));
}

void Indoor::pottedPlant(const Frame& f, double height, uint64_t id) {
  Random random = this->random(id);
  const double r = 0.16 * height;
  mesh.use(clay);
  mesh.lathe(f,
             Profile(0.7 * r, 0)
                 .to(r, 0.26 * height)
                 .to(1.08 * r, 0.27 * height)
                 .to(1.08 * r, 0.3 * height)
                 .to(0, 0.27 * height),
             segments(18, 6, id));
  mesh.use(foliage);
  const uint32_t leaves = repeats(34, 4, id + 1);
  for (uint32_t k = 0; k < leaves; ++k) {
    const double turn = 2 * pi * (k + random.next()) / leaves, length = height * random.between(0.4, 0.8);
    const double lean = random.between(0.25, 0.95), width = 0.05 * height * random.between(0.7, 1.3);
    const Frame leaf = f.at(0, 0.27 * height, 0).turned(turn);
    mesh.grid(2, segments(5, 2, id + 2 + k), [&](double u, double v) {
      const double across = 2 * u - 1, half = width * std::sin(pi * (0.1 + 0.88 * v));
      return leaf(half * across, length * (v * 1.1 - 0.65 * lean * v * v) + 0.3 * half * std::abs(across),
                  length * (0.08 + 0.8 * lean * v));
    });
  }
}

void Indoor::picture(const Frame& f, double width, double height, Finish finish) {
  const double x = 0.5 * width, y = 0.5 * height;
  mesh.use(walnut);
  mesh.box(f, {-x, -y, 0}, {x, -y + 0.03, 0.025});
  mesh.box(f, {-x, y - 0.03, 0}, {x, y, 0.025});
  mesh.box(f, {-x, -y + 0.03, 0}, {-x + 0.03, y - 0.03, 0.025});
  mesh.box(f, {x - 0.03, -y + 0.03, 0}, {x, y - 0.03, 0.025});
  mesh.use(sheet);
  mesh.quad(f(-x + 0.03, -y + 0.03, 0.012), f(x - 0.03, -y + 0.03, 0.012), f(x - 0.03, y - 0.03, 0.012),
            f(-x + 0.03, y - 0.03, 0.012));
  mesh.use(finish);
  mesh.quad(f(-0.7 * x, -0.65 * y, 0.014), f(0.7 * x, -0.65 * y, 0.014), f(0.7 * x, 0.65 * y, 0.014),
            f(-0.7 * x, 0.65 * y, 0.014));
}

void Indoor::clock(const Frame& f, uint64_t id) {
  Frame face = f;  // Turned so that the lathe's axis stands off the wall.
  face.y = f.z;
  face.z = f.y;
  mesh.use(blackPlastic);
  mesh.lathe(face, Profile(0.17, 0).to(0.17, 0.035).to(0.155, 0.04).to(0.15, 0.02), segments(28, 8, id));
  mesh.use(sheet);
  mesh.lathe(face, Profile(0.155, 0.02).to(0, 0.021), segments(28, 8, id));
  mesh.use(blackPlastic);
  mesh.box(f, {-0.005, -0.01, 0.024}, {0.005, 0.12, 0.027});
  mesh.box(f, {-0.01, -0.006, 0.028}, {0.085, 0.006, 0.03});
}

void Indoor::door(const Frame& f, double width, double height, double open, uint64_t id) {
  const double x = 0.5 * width;
  mesh.use(walnut);
  mesh.box(f, {-x, 0, -0.09}, {-x + 0.05, height, 0.09});
  mesh.box(f, {x - 0.05, 0, -0.09}, {x, height, 0.09});
  mesh.box(f, {-x + 0.05, height - 0.05, -0.09}, {x - 0.05, height, 0.09});
  const Frame hinge = f.at(-x + 0.055, 0.008, 0.06).turned(-open);
  const double leaf = width - 0.11;
  mesh.use(oak);
  mesh.box(hinge, {0, 0, -0.04}, {leaf, height - 0.06, 0});
  for (const double y : {0.18, 1.1})  // Two raised panels on either side.
    for (const double z : {-0.052, 0.0}) mesh.box(hinge, {0.12, y, z}, {leaf - 0.12, y + 0.75, z + 0.012});
  mesh.use(chrome);
  for (const double s : {-1.0, 1.0}) {
    const double z = s > 0 ? 0 : -0.04;
    mesh.bentTube({hinge(leaf - 0.07, 1.02, z), hinge(leaf - 0.07, 1.02, z + 0.05 * s),
                   hinge(leaf - 0.1, 1.02, z + 0.058 * s), hinge(leaf - 0.19, 1.02, z + 0.058 * s)},
                  0.009, segments(8, 3, id));
  }
}

void Indoor::window(const Frame& f, double width, double height, uint64_t id) {
  const double x = 0.5 * width, bar = 0.045;
  mesh.use(porcelain);
  mesh.box(f, {-x, 0, -0.04}, {x, bar, 0.04});
  mesh.box(f, {-x, height - bar, -0.04}, {x, height, 0.04});
  for (const double c : {-x + 0.5 * bar, 0.0, x - 0.5 * bar})
    mesh.box(f, {c - 0.5 * bar, bar, -0.04}, {c + 0.5 * bar, height - bar, 0.04});
  mesh.box(f, {-x + bar, 0.7 * height, -0.03}, {-0.5 * bar, 0.7 * height + 0.03, 0.03});
  mesh.box(f, {0.5 * bar, 0.7 * height, -0.03}, {x - bar, 0.7 * height + 0.03, 0.03});
  mesh.box(f, {-x - 0.05, -0.03, 0}, {x + 0.05, 0, 0.2});
  mesh.use(chrome);
  mesh.bentTube({f(-0.05, 0.42 * height, 0.04), f(-0.05, 0.42 * height, 0.07), f(-0.05, 0.36 * height, 0.075)}, 0.007,
                segments(7, 3, id));
}

void Indoor::blinds(const Frame& f, double width, double height, double drawn, uint64_t id) {
  const double x = 0.5 * width;
  mesh.use(porcelain);
  mesh.box(f, {-x, height - 0.04, 0}, {x, height, 0.04});
  const uint32_t slats = repeats(static_cast<uint32_t>(drawn * height / 0.03), 3, id);
  const double gap = drawn * (height - 0.05) / slats;
  for (uint32_t i = 0; i < slats; ++i) {
    const double y = height - 0.045 - gap * (i + 1);
    mesh.grid(1, segments(3, 1, id + 1 + i), [&](double u, double v) {
      const double t = 2 * v - 1;
      return f(x * (2 * u - 1), y + 0.008 * t - 0.004 * t * t, 0.02 + 0.011 * t);
    });
  }
  for (const double cord : {-0.7 * x, 0.7 * x})
    mesh.tube({f(cord, height - 0.04, 0.02), f(cord, height - 0.04 - drawn * (height - 0.05), 0.02)}, 0.0015, 3);
}

void Indoor::curtain(const Frame& f, double width, double height, Finish finish, uint64_t id) {
  Random random = this->random(id);
  const double p = random.between(0, 6), q = random.between(0, 6);
  const double waves = 5.5 * width;
  mesh.use(finish);
  mesh.grid(segments(70 * width, static_cast<uint32_t>(3 * waves), id), segments(22 * height, 3, id + 1),
            [&](double u, double v) {
              const double x = (u - 0.5) * width;
              const double deep = (0.032 + 0.03 * (1 - v)) * (1 + 0.25 * std::sin(5 * x + q));
              return f(x + 0.03 * (1 - v) * std::sin(3 * x + p), 0.01 + (height - 0.02) * v,
                       deep * std::sin(2 * pi * waves * u + p + 0.4 * (1 - v) * std::sin(2.3 * x + q)));
            });
  mesh.use(chrome);
  mesh.tube({f(-0.5 * width, height, 0), f(0.5 * width, height, 0)}, 0.012, segments(8, 4, id + 2));
}

void Indoor::radiator(const Frame& f, double width, uint64_t id) {
  mesh.use(porcelain);
  const uint32_t ribs = repeats(static_cast<uint32_t>(width / 0.05), 4, id);
  for (uint32_t i = 0; i < ribs; ++i) {
    const double x = (i + 0.5) / ribs * width - 0.5 * width;
    cushion(f.at(x, 0.38, 0), {0.4 * width / ribs, 0.25, 0.05}, 0.4, 5, id + 1 + i);
  }
  for (const double y : {0.18, 0.58})
    mesh.tube({f(-0.5 * width - 0.06, y, 0), f(0.5 * width, y, 0)}, 0.018, segments(9, 4, id + 99));
}

void Indoor::ceiling(const Frame& f, double halfX, double halfZ, double row, uint32_t lampsARow, const dvec2& lamp,
                     uint32_t lit) {
  const auto rectangle = [&](double x0, double z0, double x1, double z1) {
    mesh.quad(f(x0, 0, z0), f(x1, 0, z0), f(x1, 0, z1), f(x0, 0, z1));
  };
  const double half = 0.5 * lamp.y, rim = 0.03;
  const double rows[2] = {-row, row};
  double done = -halfZ;
  for (uint32_t r = row > 0 ? 0 : 1; r < 2; ++r) {
    const double z0 = rows[r] - half, z1 = rows[r] + half;
    mesh.use(ceilingPaint);
    rectangle(-halfX, done, halfX, z0);
    done = z1;
    double x = -halfX;
    for (uint32_t i = 0; i < lampsARow; ++i) {
      const double middle = halfX * ((2.0 * i + 1) / lampsARow - 1), x0 = middle - 0.5 * lamp.x,
                   x1 = middle + 0.5 * lamp.x;
      mesh.use(ceilingPaint);
      rectangle(x, z0, x0, z1);
      mesh.use(steel);
      rectangle(x0, z0, x1, z0 + rim);
      rectangle(x0, z1 - rim, x1, z1);
      rectangle(x0, z0 + rim, x0 + rim, z1 - rim);
      rectangle(x1 - rim, z0 + rim, x1, z1 - rim);
      mesh.use(r * lampsARow + i < lit ? lampLit : lampShade);
      rectangle(x0 + rim, z0 + rim, x1 - rim, z1 - rim);
      x = x1;
    }
    mesh.use(ceilingPaint);
    rectangle(x, z0, halfX, z1);
  }
  rectangle(-halfX, done, halfX, halfZ);
}

void Indoor::railing(const dvec3& from, const dvec3& to, double height, uint64_t id) {
  const dvec3 up(0, height, 0);
  const double length = glm::length(to - from);
  mesh.use(walnut);
  mesh.tube({from + up, to + up}, 0.028, segments(10, 4, id));
  mesh.use(steel);
  const uint32_t bars = repeats(static_cast<uint32_t>(length / 0.12), 2, id + 1);
  for (uint32_t i = 0; i <= bars; ++i) {
    const dvec3 foot = from + (to - from) * (static_cast<double>(i) / bars);
    mesh.tube({foot, foot + up}, i % 8 ? 0.008 : 0.016, segments(7, 3, id + 2));
  }
}

void Indoor::wallWithOpening(const Frame& f, double half, double height, double thickness, double x0, double x1,
                             double y0, double y1) {
  const double z = 0.5 * thickness;
  mesh.box(f, {-half, 0, -z}, {x0, height, z});
  mesh.box(f, {x1, 0, -z}, {half, height, z});
  if (y0 > 0) mesh.box(f, {x0, 0, -z}, {x1, y0, z});
  mesh.box(f, {x0, y1, -z}, {x1, height, z});
}

}  // namespace copse::generator
