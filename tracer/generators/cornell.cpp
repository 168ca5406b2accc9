// The Cornell box as measured: vertices, camera and light of the Cornell University Program of Computer Graphics,
// "Cornell Box Data" (graphics.cornell.edu/online/box/data.html), in millimetres. The measured spectra are carried as
// the linear RGB that McGuire's archive derives from them. The ceiling has the hole that the light fills.
#include <array>
#include <cmath>

#include "tracer/generators/generate.h"

namespace copse::generator {

namespace {

enum Colour : uint32_t { white, red, green, light };

struct Face {
  Colour colour;
  vec3 a, b, c, d;
};

const std::array<Face, 19> faces = {{
    {white, {552.8f, 0, 0}, {0, 0, 0}, {0, 0, 559.2f}, {549.6f, 0, 559.2f}},
    // The ceiling, as four pieces around the light.
    {white, {556, 548.8f, 0}, {556, 548.8f, 559.2f}, {343, 548.8f, 332}, {343, 548.8f, 227}},
    {white, {556, 548.8f, 559.2f}, {0, 548.8f, 559.2f}, {213, 548.8f, 332}, {343, 548.8f, 332}},
    {white, {0, 548.8f, 559.2f}, {0, 548.8f, 0}, {213, 548.8f, 227}, {213, 548.8f, 332}},
    {white, {0, 548.8f, 0}, {556, 548.8f, 0}, {343, 548.8f, 227}, {213, 548.8f, 227}},
    {white, {549.6f, 0, 559.2f}, {0, 0, 559.2f}, {0, 548.8f, 559.2f}, {556, 548.8f, 559.2f}},
    {green, {0, 0, 559.2f}, {0, 0, 0}, {0, 548.8f, 0}, {0, 548.8f, 559.2f}},
    {red, {552.8f, 0, 0}, {549.6f, 0, 559.2f}, {556, 548.8f, 559.2f}, {556, 548.8f, 0}},
    {light, {343, 548.8f, 227}, {343, 548.8f, 332}, {213, 548.8f, 332}, {213, 548.8f, 227}},
    // The short block.
    {white, {130, 165, 65}, {82, 165, 225}, {240, 165, 272}, {290, 165, 114}},
    {white, {290, 0, 114}, {290, 165, 114}, {240, 165, 272}, {240, 0, 272}},
    {white, {130, 0, 65}, {130, 165, 65}, {290, 165, 114}, {290, 0, 114}},
    {white, {82, 0, 225}, {82, 165, 225}, {130, 165, 65}, {130, 0, 65}},
    {white, {240, 0, 272}, {240, 165, 272}, {82, 165, 225}, {82, 0, 225}},
    // The tall block.
    {white, {423, 330, 247}, {265, 330, 296}, {314, 330, 456}, {472, 330, 406}},
    {white, {423, 0, 247}, {423, 330, 247}, {472, 330, 406}, {472, 0, 406}},
    {white, {472, 0, 406}, {472, 330, 406}, {314, 330, 456}, {314, 0, 456}},
    {white, {314, 0, 456}, {314, 330, 456}, {265, 330, 296}, {265, 0, 296}},
    {white, {265, 0, 296}, {265, 330, 296}, {423, 330, 247}, {423, 0, 247}},
}};
constexpr uint32_t plain = 2 * 19, maxTriangles = 50'000'000;

/// n x n cells over the face. Edges of neighbours are cut at the same points.
void addFace(Scene& scene, const Face& face, uint32_t n) {
  const uint32_t first = static_cast<uint32_t>(scene.positions.size());
  for (uint32_t j = 0; j <= n; ++j)
    for (uint32_t i = 0; i <= n; ++i) {
      const float u = static_cast<float>(i) / static_cast<float>(n), v = static_cast<float>(j) / static_cast<float>(n);
      scene.positions.push_back((1 - v) * ((1 - u) * face.a + u * face.b) + v * ((1 - u) * face.d + u * face.c));
    }
  for (uint32_t j = 0; j < n; ++j)
    for (uint32_t i = 0; i < n; ++i) {
      const uint32_t a = first + j * (n + 1) + i, d = a + n + 1;
      scene.triangles.push_back({a, a + 1, d + 1});
      scene.triangles.push_back({a, d + 1, d});
    }
  scene.materialOf.resize(scene.triangles.size(), face.colour);
}

/// One triangle becomes three around its centre; no edge is cut, so no crack can open.
void splitAtCentre(Scene& scene, std::size_t i) {
  const uvec3 t = scene.triangles[i];
  const uint32_t centre = static_cast<uint32_t>(scene.positions.size());
  scene.positions.push_back((scene.positions[t.x] + scene.positions[t.y] + scene.positions[t.z]) / 3.0f);
  scene.triangles[i] = {t.x, t.y, centre};
  scene.triangles.push_back({t.y, t.z, centre});
  scene.triangles.push_back({t.z, t.x, centre});
  scene.materialOf.resize(scene.triangles.size(), scene.materialOf[i]);
}

}  // namespace

Scene generateCornell(uint32_t triangles, uint64_t) {
  checkRange("cornell", triangles, plain, maxTriangles);
  Scene scene;
  scene.name = "cornell";
  scene.materials = {{.name = "white", .kd = {0.725f, 0.71f, 0.68f}},
                     {.name = "red", .kd = {0.63f, 0.065f, 0.05f}},
                     {.name = "green", .kd = {0.14f, 0.45f, 0.091f}},
                     {.name = "light", .kd = {0.78f, 0.78f, 0.78f}, .ke = {17, 12, 4}}};
  scene.triangles.reserve(triangles);
  scene.materialOf.reserve(triangles);
  scene.positions.reserve(triangles / 2 + triangles / 8 + 64);

  const uint32_t n = static_cast<uint32_t>(std::sqrt(triangles / static_cast<double>(plain)));
  for (const Face& face : faces) addFace(scene, face, n);
  for (std::size_t count = scene.triangles.size(); count + 2 <= triangles; count = scene.triangles.size()) {
    const std::size_t splits = std::min(count, (triangles - count) / 2);
    for (std::size_t i = 0; i < splits; ++i) splitAtCentre(scene, i * count / splits);
  }

  // A lens of 35 mm before a film of 25 mm: 2 atan(25 / 70) = 39.3 degrees.
  scene.cameras = {{"front", {278, 273, -800}, {278, 273, 0}, {0, 1, 0}, 39.3077f},
                   {"corner", {500, 500, 30}, {150, 90, 400}, {0, 1, 0}, 60},
                   {"floor", {500, 70, 40}, {250, 210, 400}, {0, 1, 0}, 60}};
  return scene;
}

}  // namespace copse::generator
