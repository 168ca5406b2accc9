// Small scenes whose light is known, and functions that render them in one call.
#pragma once

#include <functional>
#include <memory>
#include <vector>

#include "tracer/accel/ray_tracer.h"
#include "tracer/integrators/path/path_tracer.h"

namespace copse::test {

/// A scene assembled piece by piece.
struct SceneMaker {
  Scene scene;

  uint32_t material(const vec3& kd, const vec3& ke = vec3(0));
  void triangle(const vec3& a, const vec3& b, const vec3& c, uint32_t material);
  /// Two triangles with texture coordinates (0, 0) at `corner`, (1, 0) along edge1, (0, 1) along edge2.
  void parallelogram(const vec3& corner, const vec3& edge1, const vec3& edge2, uint32_t material);
  /// Six sides. `without` leaves one out: 0 … 5 is -x, +x, -y, +y, -z, +z.
  void box(const vec3& lo, const vec3& hi, uint32_t material, int without = -1);
  /// An octahedron's faces split `levels` times: 8 4^levels triangles, convex.
  void sphere(const vec3& centre, float radius, int levels, uint32_t material);
  void sky(const vec3& radiance) { scene.sky = SkyLight{radiance, "", {}}; }
};

Camera lookAt(const vec3& eye, const vec3& at, float vfov = 40);
RenderSettings settings(int width, int height, int spp, int maxDepth, uint64_t seed = 1);

/// A tree of the scene, ready to trace; owns what it needs.
class Traced {
 public:
  Traced(const Device& device, const Scene& scene);
  PathResult render(const Camera& camera, const RenderSettings& settings, const PathOptions& options = {},
                    const Watch& watch = {}) const;
  const SceneOnDevice& scene() const { return *scene_; }
  const RayTracer& tracer() const { return *tracer_; }

 private:
  Device device_;
  std::unique_ptr<SceneOnDevice> scene_;
  std::unique_ptr<RayTracer> tracer_;
};

/// Every ray against every triangle in double precision.
std::unique_ptr<RayTracer> bruteForce(const SceneOnDevice& scene);

/// Mean over pixels and channels, and the standard error of that mean if pixels are independent and identically
/// distributed.
struct Mean {
  double value = 0, error = 0;
};
Mean meanOf(const Image& image);
Mean meanOf(const Image& image, int channel);

bool allFinite(const Image& image);
bool identical(const Image& a, const Image& b);

}  // namespace copse::test
