// Desks, chairs, shelves and what lies on them.
#include "tracer/generators/indoor.h"

#include <glm/geometric.hpp>

namespace copse::generator {

namespace {

double power(double x, double e) { return x < 0 ? -std::pow(-x, e) : std::pow(x, e); }

}  // namespace

std::vector<Material> indoorMaterials() {
  std::vector<Material> all(finishes);
  const auto set = [&](Finish finish, const char* name, vec3 kd) {
    all[finish].name = name;
    all[finish].kd = kd;
  };
  set(wallPaint, "wall_paint", {0.76f, 0.74f, 0.69f});
  set(wallAccent, "wall_accent", {0.33f, 0.46f, 0.5f});
  set(ceilingPaint, "ceiling_paint", {0.82f, 0.82f, 0.8f});
  set(carpet, "carpet", {0.24f, 0.26f, 0.31f});
  set(linoleum, "linoleum", {0.5f, 0.46f, 0.4f});
  set(oak, "oak", {0.56f, 0.4f, 0.23f});
  set(walnut, "walnut", {0.28f, 0.16f, 0.09f});
  set(steel, "steel", {0.42f, 0.43f, 0.45f});
  set(chrome, "chrome", {0.62f, 0.62f, 0.62f});
  set(blackPlastic, "black_plastic", {0.05f, 0.05f, 0.055f});
  set(greyPlastic, "grey_plastic", {0.4f, 0.4f, 0.4f});
  set(porcelain, "porcelain", {0.8f, 0.79f, 0.75f});
  set(blueFabric, "blue_fabric", {0.08f, 0.15f, 0.34f});
  set(redFabric, "red_fabric", {0.44f, 0.07f, 0.06f});
  set(greyFabric, "grey_fabric", {0.2f, 0.2f, 0.21f});
  set(sheet, "sheet", {0.84f, 0.83f, 0.79f});
  set(clothRed, "cloth_red", {0.47f, 0.08f, 0.07f});
  set(clothBlue, "cloth_blue", {0.09f, 0.17f, 0.4f});
  set(clothGreen, "cloth_green", {0.1f, 0.28f, 0.14f});
  set(clothTan, "cloth_tan", {0.55f, 0.42f, 0.24f});
  set(leather, "leather", {0.23f, 0.12f, 0.06f});
  set(foliage, "foliage", {0.1f, 0.28f, 0.06f});
  set(clay, "clay", {0.5f, 0.24f, 0.14f});
  set(display, "display", {0.06f, 0.08f, 0.11f});
  set(lampShade, "lamp_shade", {0.78f, 0.74f, 0.64f});
  set(lampLit, "lamp_lit", {0.8f, 0.8f, 0.8f});
  all[lampLit].ke = {17, 15.2f, 12.4f};
  set(drapery, "drapery", {0.5f, 0.38f, 0.22f});
  set(concrete, "concrete", {0.46f, 0.45f, 0.42f});
  set(pavement, "pavement", {0.28f, 0.28f, 0.27f});
  set(pane, "pane", {0.2f, 0.26f, 0.3f});
  return all;
}

void Indoor::cushion(const Frame& frame, const dvec3& half, double squareness, double atOne, uint64_t id) {
  const double e = squareness;
  const uint32_t around = 2 * segments(atOne, 3, id), up = segments(atOne, 3, id + 1);
  mesh.grid(
      around, up,
      [&](double u, double v) {
        // Short of the poles by a hair: no triangle is without area.
        const double a = 2 * pi * u, b = pi * (0.004 + 0.992 * v - 0.5);
        const double c = power(std::cos(b), e);
        return frame(half.x * c * power(std::cos(a), e), half.y * power(std::sin(b), e),
                     half.z * c * power(std::sin(a), e));
      },
      true);
}

void Indoor::leg(const dvec3& from, const dvec3& to, double radius, uint64_t id) {
  mesh.tube({from, to}, radius, segments(9, 4, id));
}

void Indoor::desk(const Frame& f, double width, uint64_t id) {
  const double x = 0.5 * width, z = 0.4;
  mesh.use(oak);
  mesh.box(f, {-x, 0.71, -z}, {x, 0.745, z});
  mesh.box(f, {-x + 0.06, 0.3, -z + 0.02}, {x - 0.06, 0.7, -z + 0.04});
  mesh.use(steel);
  for (const double sx : {-x + 0.05, x - 0.05})
    for (const double sz : {-z + 0.06, z - 0.06}) leg(f(sx, 0, sz), f(sx, 0.71, sz), 0.022, id + 1);
  cabinet(f.at(x - 0.3, 0, 0), 0.4, 0.68, 3, id + 7);
}

void Indoor::cabinet(const Frame& f, double width, double height, uint32_t drawers, uint64_t id) {
  const double x = 0.5 * width;
  mesh.use(greyPlastic);
  mesh.box(f, {-x, 0.04, -0.3}, {x, height, 0.26});
  for (uint32_t i = 0; i < drawers; ++i) {
    const double y0 = 0.06 + (height - 0.07) * i / drawers, y1 = 0.05 + (height - 0.07) * (i + 1) / drawers;
    mesh.use(greyPlastic);
    mesh.box(f, {-x + 0.01, y0, 0.26}, {x - 0.01, y1, 0.285});
    mesh.use(chrome);
    const double y = y1 - 0.05;
    mesh.bentTube({f(-0.06, y, 0.285), f(-0.055, y, 0.31), f(0, y, 0.315), f(0.055, y, 0.31), f(0.06, y, 0.285)}, 0.006,
                  segments(7, 3, id + i));
  }
}

void Indoor::computer(const Frame& f, uint64_t id) {
  mesh.use(blackPlastic);
  mesh.box(f, {-0.27, 0.12, -0.2}, {0.27, 0.47, -0.165});
  mesh.use(display);
  mesh.quad(f(-0.255, 0.135, -0.164), f(0.255, 0.135, -0.164), f(0.255, 0.455, -0.164), f(-0.255, 0.455, -0.164));
  mesh.use(greyPlastic);
  mesh.lathe(f.at(0, 0, -0.2), Profile(0.12, 0).to(0.12, 0.008).ease(0.022, 0.05, segments(4, 1, id)).to(0.02, 0.2),
             segments(18, 5, id + 1));
  const Frame board = f.at(-0.04, 0, 0.12);
  mesh.use(blackPlastic);
  mesh.box(board, {-0.22, 0, -0.075}, {0.22, 0.014, 0.075});
  mesh.use(greyPlastic);
  const uint32_t columns = repeats(14, 2, id + 2), rows = repeats(6, 1, id + 3);
  for (uint32_t i = 0; i < columns; ++i)
    for (uint32_t j = 0; j < rows; ++j) {
      const double x = -0.21 + 0.42 * i / columns, z = -0.065 + 0.13 * j / rows;
      mesh.box(board, {x, 0.014, z}, {x + 0.34 / columns, 0.022, z + 0.105 / rows});
    }
  mesh.use(blackPlastic);
  cushion(f.at(0.27, 0.015, 0.14), {0.03, 0.018, 0.052}, 0.8, 7, id + 4);
}

void Indoor::swivelChair(const Frame& f, Finish fabric, uint64_t id) {
  mesh.use(blackPlastic);
  for (int i = 0; i < 5; ++i) {
    const Frame spoke = f.turned(2 * pi * i / 5);
    mesh.bentTube({spoke(0, 0.1, 0), spoke(0, 0.09, 0.15), spoke(0, 0.07, 0.3)}, 0.02, segments(8, 3, id + 1));
    cushion(spoke.at(0, 0.033, 0.3), {0.022, 0.032, 0.032}, 0.9, 6, id + 2);
  }
  mesh.use(chrome);
  leg(f(0, 0.08, 0), f(0, 0.42, 0), 0.028, id + 3);
  mesh.use(blackPlastic);
  mesh.box(f, {-0.1, 0.4, -0.12}, {0.1, 0.43, 0.12});
  mesh.use(fabric);
  cushion(f.at(0, 0.47, 0), {0.24, 0.045, 0.24}, 0.45, 14, id + 4);
  // The back is bent around who leans on it.
  const uint32_t across = segments(12, 2, id + 5), up = segments(16, 3, id + 6);
  for (const double front : {0.0, 0.05})
    mesh.grid(across, up, [&](double u, double v) {
      const double x = 0.46 * (u - 0.5) * (1 - 0.25 * v * v), y = 0.6 + 0.52 * v;
      const double lean = -0.2 - 0.08 * v + 0.05 * std::sin(pi * v) + 0.9 * x * x;
      const double thick = front * std::sqrt(std::max(0.0, 1 - std::pow(2 * u - 1, 4)));
      return f(x, y, lean + thick);
    });
  mesh.use(blackPlastic);
  mesh.bentTube({f(0, 0.42, -0.1), f(0, 0.45, -0.24), f(0, 0.6, -0.25), f(0, 0.8, -0.22)}, 0.018,
                segments(8, 3, id + 7));
  for (const double s : {-1.0, 1.0}) {
    mesh.bentTube({f(0.2 * s, 0.44, 0), f(0.28 * s, 0.46, 0), f(0.28 * s, 0.64, 0)}, 0.014, segments(8, 3, id + 8));
    cushion(f.at(0.28 * s, 0.655, 0.02), {0.032, 0.018, 0.13}, 0.6, 7, id + 9);
  }
}

void Indoor::armchair(const Frame& f, Finish fabric, uint64_t id) {
  mesh.use(chrome);
  const uint32_t bend = segments(5, 1, id);
  for (const double s : {-1.0, 1.0}) {
    // One bent tube a side: along the floor, up in front, back along the armrest, up behind.
    std::vector<dvec3> path = {f(0.27 * s, 0.018, -0.26)};
    const auto corner = [&](double y0, double z0, double y1, double z1, double y2, double z2) {
      for (uint32_t i = 0; i <= bend; ++i) {
        const double t = static_cast<double>(i) / bend, a = (1 - t) * (1 - t), b = 2 * t * (1 - t), c = t * t;
        path.push_back(f(0.27 * s, a * y0 + b * y1 + c * y2, a * z0 + b * z1 + c * z2));
      }
    };
    corner(0.018, 0.2, 0.018, 0.28, 0.1, 0.275);
    corner(0.56, 0.26, 0.66, 0.255, 0.655, 0.15);
    path.push_back(f(0.27 * s, 0.64, -0.24));
    mesh.bentTube(path, 0.0135, segments(10, 4, id + 1));
    mesh.bentTube({f(0.27 * s, 0.43, 0.265), f(0.25 * s, 0.42, 0.0), f(0.27 * s, 0.44, -0.22), f(0.25 * s, 0.9, -0.33)},
                  0.0125, segments(10, 4, id + 2));
  }
  mesh.bentTube({f(-0.27, 0.018, -0.26), f(0, 0.018, -0.27), f(0.27, 0.018, -0.26)}, 0.0135, segments(10, 4, id + 3));
  mesh.use(fabric);
  cushion(f.at(0, 0.46, 0.02), {0.235, 0.05, 0.235}, 0.42, 20, id + 4);
  Frame back = f.at(0, 0.71, -0.27);
  back.y = glm::normalize(f.y - 0.24 * f.z);
  back.z = glm::cross(f.x, back.y);
  cushion(back, {0.235, 0.21, 0.04}, 0.42, 20, id + 5);
  mesh.use(blackPlastic);
  for (const double s : {-1.0, 1.0}) cushion(f.at(0.27 * s, 0.668, 0.01), {0.026, 0.014, 0.15}, 0.6, 9, id + 6);
}

void Indoor::books(const Frame& shelf, double width, double height, double depth, uint64_t id) {
  Random random = this->random(id);
  constexpr Finish cloths[] = {clothRed, clothBlue, clothGreen, clothTan, leather, greyFabric, sheet};
  const double coarse = std::max(1.0, 0.55 / std::max(detail, 0.05));
  double x = -0.5 * width;
  while (true) {
    const double thick = random.between(0.012, 0.05) * coarse;
    const double tall = height * random.between(0.62, 0.95), deep = depth * random.between(0.7, 0.95);
    const uint32_t cloth = random.below(7);
    const double choice = random.next();
    if (x + thick > 0.5 * width) return;
    mesh.use(cloths[cloth]);
    if (choice < 0.06) {  // A gap, or one that leans on its neighbour.
      Frame leaning = shelf.at(x + 0.04 + thick, 0, 0);
      leaning.x = glm::normalize(shelf.x - 0.2 * shelf.y);
      leaning.y = glm::normalize(shelf.y + 0.2 * shelf.x);
      if (x + thick + 0.1 < 0.5 * width)
        mesh.box(leaning.at(-0.2 * tall, 0.004, 0), {0, 0.01 * tall, -0.5 * depth},
                 {thick, 0.93 * tall, -0.5 * depth + deep});
      x += thick + 0.11;
    } else {
      mesh.box(shelf, {x, 0, -0.5 * depth}, {x + 0.96 * thick, tall, -0.5 * depth + deep});
      x += thick;
    }
  }
}

void Indoor::bookcase(const Frame& f, double width, double height, uint64_t id) {
  const double x = 0.5 * width, depth = 0.3;
  mesh.use(oak);
  mesh.box(f, {-x, 0, -0.15}, {-x + 0.02, height, 0.15});
  mesh.box(f, {x - 0.02, 0, -0.15}, {x, height, 0.15});
  mesh.box(f, {-x + 0.02, 0, -0.15}, {x - 0.02, height, -0.14});
  const int shelves = static_cast<int>(height / 0.34);
  for (int i = 0; i <= shelves; ++i) {
    const double y = 0.05 + (height - 0.07) * i / shelves;
    mesh.use(oak);
    mesh.box(f, {-x + 0.02, y, -0.14}, {x - 0.02, y + 0.02, 0.15});
    if (i < shelves)
      books(f.at(0, y + 0.02, 0.01), width - 0.05, 0.29, depth - 0.04, id + 16 * static_cast<uint64_t>(i));
  }
}

void Indoor::mug(const Frame& f, uint64_t id) {
  mesh.use(porcelain);
  mesh.lathe(f, Profile(0.03, 0).to(0.04, 0.012).to(0.041, 0.09).to(0.037, 0.09).to(0.036, 0.014).to(0, 0.012),
             segments(18, 5, id));
  mesh.bentTube({f(0.039, 0.075, 0), f(0.062, 0.068, 0), f(0.066, 0.048, 0), f(0.058, 0.03, 0), f(0.039, 0.024, 0)},
                0.005, segments(7, 3, id + 1));
}

void Indoor::bottle(const Frame& f, uint64_t id) {
  mesh.use(clothGreen);
  const uint32_t curve = segments(5, 1, id);
  mesh.lathe(f, Profile(0.033, 0).to(0.035, 0.01).to(0.035, 0.15).ease(0.013, 0.21, curve).to(0.013, 0.235),
             segments(20, 5, id + 1));
  mesh.use(chrome);
  mesh.lathe(f, Profile(0.015, 0.232).to(0.015, 0.248).to(0, 0.248), segments(20, 5, id + 1));
}

void Indoor::papers(const Frame& f, uint32_t count, double width, double depth, uint64_t id) {
  Random random = this->random(id);
  mesh.use(sheet);
  for (uint32_t i = 0; i < count; ++i) {
    const double x = (random.next() - 0.5) * width, z = (random.next() - 0.5) * depth,
                 angle = random.between(-0.5, 0.5);
    const Frame s = f.at(x, 0.0005 + 0.0004 * i, z).turned(angle);
    mesh.quad(s(-0.105, 0, -0.1485), s(0.105, 0, -0.1485), s(0.105, 0, 0.1485), s(-0.105, 0, 0.1485));
  }
}

}  // namespace copse::generator
