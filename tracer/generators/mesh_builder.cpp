// The shapes of the mesh builder that are not templates.
#include "tracer/generators/mesh_builder.h"

namespace copse::generator {

void MeshBuilder::triangle(const dvec3& a, const dvec3& b, const dvec3& c) {
  ++count_;
  if (!scene_) return;
  const uint32_t first = vertex(a);
  vertex(b);
  vertex(c);
  add(first, first + 1, first + 2);
}

void MeshBuilder::quad(const dvec3& a, const dvec3& b, const dvec3& c, const dvec3& d) {
  count_ += 2;
  if (!scene_) return;
  const uint32_t first = vertex(a);
  vertex(b);
  vertex(c);
  vertex(d);
  add(first, first + 1, first + 2);
  add(first, first + 2, first + 3);
}

void MeshBuilder::box(const Frame& frame, const dvec3& lo, const dvec3& hi) {
  count_ += 12;
  if (!scene_) return;
  const uint32_t first = static_cast<uint32_t>(scene_->positions.size());
  for (int i = 0; i < 8; ++i) vertex(frame(i & 1 ? hi.x : lo.x, i & 2 ? hi.y : lo.y, i & 4 ? hi.z : lo.z));
  constexpr uint32_t faces[6][4] = {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}};
  for (const auto& f : faces) {
    add(first + f[0], first + f[1], first + f[2]);
    add(first + f[0], first + f[2], first + f[3]);
  }
}

void MeshBuilder::lathe(const Frame& frame, const Profile& profile, uint32_t sides) {
  const std::vector<dvec2>& points = profile.points;
  for (std::size_t j = 0; j + 1 < points.size(); ++j) {
    const bool lowerPoint = points[j].x == 0, upperPoint = points[j + 1].x == 0;
    count_ += sides * (lowerPoint && upperPoint ? 0u : lowerPoint || upperPoint ? 1u : 2u);
  }
  if (!scene_) return;
  std::vector<dvec2> circle;
  for (uint32_t i = 0; i < sides; ++i) circle.push_back({std::cos(2 * pi * i / sides), std::sin(2 * pi * i / sides)});
  uint32_t below = 0;
  for (std::size_t j = 0; j < points.size(); ++j) {
    const double r = points[j].x, y = points[j].y;
    const uint32_t ring = static_cast<uint32_t>(scene_->positions.size());
    if (r == 0)
      vertex(frame(0, y, 0));
    else
      for (const dvec2& c : circle) vertex(frame(r * c.x, y, r * c.y));
    const bool lowerPoint = j > 0 && points[j - 1].x == 0;
    for (uint32_t i = 0; j > 0 && i < sides; ++i) {
      const uint32_t next = i + 1 == sides ? 0 : i + 1;
      if (!lowerPoint && r != 0) {
        add(below + i, ring + i, ring + next);
        add(below + i, ring + next, below + next);
      } else if (!lowerPoint) {
        add(below + i, ring, below + next);
      } else if (r != 0) {
        add(below, ring + i, ring + next);
      }
    }
    below = ring;
  }
}

void MeshBuilder::tube(const std::vector<dvec3>& path, double radius, uint32_t sides) {
  const uint32_t pieces = static_cast<uint32_t>(path.size() - 1);
  const dvec3 whole = path.back() - path.front();
  // Any direction across will do as long as it is not along the tube.
  const dvec3 aside = std::abs(whole.y) < 0.7 * glm::length(whole) ? dvec3(0, 1, 0) : dvec3(0.8, 0, 0.6);
  grid(
      sides, pieces,
      [&](double u, double v) {
        const std::size_t j = static_cast<std::size_t>(std::lround(v * pieces));
        const dvec3 along = path[j < pieces ? j + 1 : j] - path[j > 0 ? j - 1 : j];
        const dvec3 a = glm::normalize(glm::cross(along, aside)), b = glm::normalize(glm::cross(a, along));
        return path[j] + radius * (std::cos(2 * pi * u) * a + std::sin(2 * pi * u) * b);
      },
      true);
}

void MeshBuilder::bentTube(const std::vector<dvec3>& path, double radius, uint32_t sides) {
  const std::size_t last = path.size() - 1;
  std::vector<Frame> rings;
  dvec3 across(0);
  for (std::size_t i = 0; scene_ && i <= last; ++i) {
    const dvec3 along = glm::normalize(path[i < last ? i + 1 : i] - path[i > 0 ? i - 1 : i]);
    across = i > 0 ? across : glm::cross(along, std::abs(along.y) < 0.8 ? dvec3(0, 1, 0) : dvec3(0, 0, 1));
    across = glm::normalize(across - along * glm::dot(across, along));
    rings.push_back({path[i], across, along, glm::cross(across, along)});
  }
  grid(
      sides, static_cast<uint32_t>(last),
      [&](double u, double v) {
        const Frame& f = rings[static_cast<std::size_t>(std::lround(v * static_cast<double>(last)))];
        return f(radius * std::cos(2 * pi * u), 0, radius * std::sin(2 * pi * u));
      },
      true);
}

}  // namespace copse::generator
