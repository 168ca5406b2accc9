// Columns, beams, bracing, gratings of thin bars, handrails, stairs and ladders: the long thin triangles.
#include "tracer/generators/plant.h"

namespace copse::generator {

Frame frameAlong(const dvec3& origin, const dvec3& along) {
  Frame f;
  f.origin = origin;
  f.y = glm::normalize(along);
  f.x = glm::normalize(glm::cross(f.y, std::abs(f.y.y) < 0.8 ? dvec3(0, 1, 0) : dvec3(0, 0, 1)));
  f.z = glm::cross(f.x, f.y);
  return f;
}

void Plant::beam(const dvec3& from, const dvec3& to, double height, double width) {
  const Frame f = frameAlong(from, to - from);
  const double length = glm::length(to - from), h = 0.5 * height, w = 0.5 * width, t = 0.06 * height;
  mesh.box(f, {-w, 0, -h}, {w, length, -h + t});
  mesh.box(f, {-w, 0, h - t}, {w, length, h});
  mesh.box(f, {-0.5 * t, 0, -h + t}, {0.5 * t, length, h - t});
}

void Plant::bar(const dvec3& from, const dvec3& to, double thick) {
  const double t = 0.5 * thick;
  mesh.box(frameAlong(from, to - from), {-t, 0, -t}, {t, glm::length(to - from), t});
}

void Plant::grating(const Frame& f, double x, double z, uint64_t id) {
  mesh.use(galvanised);
  const uint32_t bars = repeats(static_cast<uint32_t>(x / 0.034), static_cast<uint32_t>(x / 0.5) + 1, id);
  const double wide = x / bars * (bars > x / 0.06 ? 0.12 : 0.4);
  for (uint32_t i = 0; i < bars; ++i) {
    const double at = x * (i + 0.5) / bars;
    mesh.box(f, {at, -0.03, 0}, {at + wide, 0, z});
  }
  const uint32_t rods = repeats(static_cast<uint32_t>(z / 0.1), 1, id + 1);
  for (uint32_t i = 0; i < rods; ++i) {
    const double at = z * (i + 0.5) / rods;
    mesh.box(f, {0, -0.012, at}, {x, -0.004, at + 0.007});
  }
}

void Plant::handrail(const dvec3& from, const dvec3& to, uint64_t id) {
  mesh.use(yellowPipe);
  const uint32_t sides = segments(8, 4, id);
  const dvec3 whole = to - from;
  const uint32_t posts = std::max(1u, static_cast<uint32_t>(glm::length(whole) / 1.5));
  for (const double y : {1.1, 0.55}) mesh.tube({from + dvec3(0, y, 0), to + dvec3(0, y, 0)}, 0.021, sides);
  for (uint32_t i = 0; i <= posts; ++i) {
    const dvec3 foot = from + whole * (static_cast<double>(i) / posts);
    mesh.tube({foot, foot + dvec3(0, 1.1, 0)}, 0.021, sides);
  }
  bar(from + dvec3(0, 0.06, 0), to + dvec3(0, 0.06, 0), 0.012);
}

void Plant::stairs(const Frame& f, double rise, double run, double width, uint64_t id) {
  const int steps = static_cast<int>(rise / 0.2);
  mesh.use(oxide);
  for (const double z : {0.0, width}) beam(f(0, 0, z), f(run, rise, z), 0.2, 0.08);
  for (int i = 0; i < steps; ++i)
    grating(f.at(run * (i + 0.5) / steps - 0.13, rise * (i + 1) / steps, 0.03), 0.26, width - 0.06,
            id + static_cast<uint64_t>(i));
  for (const double z : {0.0, width}) handrail(f(0, 0.1, z), f(run, rise + 0.1, z), id + 50);
}

void Plant::ladder(const Frame& f, double height, bool caged, uint64_t id) {
  mesh.use(yellowPipe);
  const uint32_t sides = segments(7, 3, id);
  for (const double x : {-0.22, 0.22}) mesh.tube({f(x, 0, 0), f(x, height + 1, 0)}, 0.02, sides);
  const uint32_t rungs = static_cast<uint32_t>(height / 0.3);
  for (uint32_t i = 0; i < rungs; ++i) mesh.tube({f(-0.22, 0.3 * (i + 1), 0), f(0.22, 0.3 * (i + 1), 0)}, 0.012, sides);
  if (!caged) return;
  const uint32_t hoops = static_cast<uint32_t>(std::max(0.0, height - 2.2) / 0.9), pieces = segments(10, 4, id + 1);
  for (uint32_t i = 0; i < hoops; ++i)
    mesh.grid(pieces, 1, [&](double u, double v) {
      const double a = pi * (1.1 * u - 0.05), y = 2.3 + 0.9 * i;
      return f(-0.36 * std::cos(a), y + 0.05 * v, 0.02 + 0.68 * std::sin(a));
    });
  for (int i = 0; i < 5 && hoops > 1; ++i) {
    const double a = pi * (0.1 + 0.2 * i);
    bar(f(-0.36 * std::cos(a), 2.3, 0.02 + 0.68 * std::sin(a)),
        f(-0.36 * std::cos(a), 1.4 + 0.9 * hoops, 0.02 + 0.68 * std::sin(a)), 0.02);
  }
}

void Plant::buildSteel() {
  for (int iy = 0; iy < levels; ++iy) {
    const double top = levelHeight * (iy + 1);
    for (int ix = 0; ix <= nx; ++ix)
      for (int iz = 0; iz <= nz; ++iz) {
        mesh.use(oxide);
        const dvec3 foot(cellSize * ix, levelHeight * iy, cellSize * iz);
        beam(foot, foot + dvec3(0, levelHeight, 0), 0.36, 0.34);
        if (iy == 0) {
          mesh.use(gravel);
          mesh.box(Frame{foot}, {-0.45, 0, -0.45}, {0.45, 0.25, 0.45});
          mesh.use(oxide);
        }
        const dvec3 head(foot.x, top - 0.24, foot.z);
        if (ix < nx) beam(head, head + dvec3(cellSize, 0, 0), 0.34, 0.2);
        if (iz < nz) beam(head, head + dvec3(0, 0, cellSize), 0.34, 0.2);
        if (ix < nx && iz < nz && !furnaceAt(ix, iz))
          for (const double x : {2.0, 4.0}) beam(head + dvec3(x, 0.06, 0), head + dvec3(x, 0.06, cellSize), 0.2, 0.12);
        // Bracing in some bays of the outer faces.
        const bool face = iz == 0 || iz == nz;
        if (face && ix < nx && (ix + iy + iz) % 3 == 1) {
          bar(foot, head + dvec3(cellSize, 0, 0), 0.1);
          bar(foot + dvec3(cellSize, 0, 0), head, 0.1);
        }
      }
    for (int ix = 0; ix < nx; ++ix)
      for (int iz = 0; iz < nz; ++iz) {
        const uint64_t id = 0x100000 + 0x100ull * static_cast<uint64_t>((iy * 128 + ix) * 128 + iz);
        if (furnaceAt(ix, iz)) continue;
        // A stairwell in every fourth bay of the first row: no grating over its flight.
        const bool well = iz == 0 && ix % 4 == 3;
        const Frame floor = cell(ix, iy + 1, iz);
        if (well) {
          grating(floor.at(0, 0, 1.5), cellSize, cellSize - 1.5, id);
          stairs(cell(ix, iy, iz).at(0.6, 0, 0.25), levelHeight, 4.8, 0.95, id + 8);
        } else {
          grating(floor, cellSize, cellSize, id);
        }
      }
    for (int ix = 0; ix < nx; ++ix)
      for (const double z : {0.0, lengthZ()})
        handrail({cellSize * ix, top, z}, {cellSize * (ix + 1), top, z}, 0x300000 + static_cast<uint64_t>(ix));
    for (int iz = 0; iz < nz; ++iz)
      for (const double x : {0.0, lengthX()})
        handrail({x, top, cellSize * iz}, {x, top, cellSize * (iz + 1)}, 0x310000 + static_cast<uint64_t>(iz));
  }
}

}  // namespace copse::generator
