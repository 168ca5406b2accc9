// The path tracer against the reference tracer, which shares the scene with it and nothing else: block means over
// independent seeds, against their own standard errors. An error of 2 % in one material has to show.
//
// Each block's difference is brought to a standard normal number z (Student's t with 2 (seeds - 1) degrees of freedom).
// Images that are alike are refused where Σ z² lies more than 4 standard deviations above chance, or some |z| passes 5:
// each happens by chance less than once in 20,000 scenes. Seeds are fixed, so a test that passes always passes.

#include <algorithm>
#include <cfloat>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>

#include "tests/support/catch.h"
#include "tests/support/devices.h"
#include "tests/support/path_scenes.h"
#include "tests/support/real_meshes.h"
#include "tests/support/textures.h"
#include "tracer/generators/generators.h"
#include "tracer/image/image_io.h"
#include "tracer/integrators/pinhole.h"
#include "tracer/integrators/reference/reference.h"

using namespace copse;
using namespace copse::test;

namespace {

// Sanitizers make both tracers many times slower: then a few samples test for crashes, not for 2 %.
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr bool enough = false;
#elif defined(__has_feature)
constexpr bool enough = !(__has_feature(address_sanitizer) || __has_feature(thread_sanitizer));
#else
constexpr bool enough = true;
#endif

constexpr int seeds = enough ? 24 : 6, blockSide = 16, width = enough ? 64 : 32, height = enough ? 48 : 32;
constexpr int blocks = (width / blockSide) * (height / blockSide);

/// Means over blocks, one row per seed.
using Rows = std::vector<std::vector<double>>;

std::vector<double> blockMeans(const Image& image) {
  std::vector<double> means(blocks, 0);
  for (int y = 0; y < height; ++y)
    for (int x = 0; x < width; ++x) {
      const vec3 p = image.at(x, y);
      means[static_cast<std::size_t>(y / blockSide) * (width / blockSide) + static_cast<std::size_t>(x / blockSide)] +=
          (p.x + p.y + p.z) / (3.0 * blockSide * blockSide);
    }
  return means;
}

struct Verdict {
  double chiSigmas;  ///< Σ z² as standard deviations above its mean (Wilson and Hilferty 1931).
  double worst;      ///< The largest |z|.
  double mean;       ///< The mean of the blocks' relative differences.
  bool alike() const { return chiSigmas < 4 && worst < 5; }
};

Verdict compare(const Rows& a, const Rows& b) {
  const double n = seeds, freedom = 2 * (n - 1);
  Verdict verdict{0, 0, 0};
  double chi = 0;
  for (int block = 0; block < blocks; ++block) {
    const auto moments = [&](const Rows& rows, double& mean, double& variance) {
      mean = variance = 0;
      for (const auto& row : rows) mean += row[block] / n;
      for (const auto& row : rows) variance += (row[block] - mean) * (row[block] - mean) / (n - 1);
    };
    double meanA, varianceA, meanB, varianceB;
    moments(a, meanA, varianceA);
    moments(b, meanB, varianceB);
    verdict.mean += (meanA / meanB - 1) / blocks;
    const double t = (meanA - meanB) / std::sqrt((varianceA + varianceB) / n);
    const double z = t * (1 - 1 / (4 * freedom)) / std::sqrt(1 + t * t / (2 * freedom));
    chi += z * z;
    verdict.worst = std::max(verdict.worst, std::abs(z));
  }
  const double spread = 2.0 / (9 * blocks);
  verdict.chiSigmas = (std::cbrt(chi / blocks) - (1 - spread)) / std::sqrt(spread);
  return verdict;
}

Rows pathRows(const Scene& scene, const Camera& camera, int spp) {
  const Traced traced(chosenDevice(), scene);
  Rows rows;
  for (int seed = 0; seed < seeds; ++seed) {
    const RenderSettings wanted = settings(width, height, spp, 8, 100 + static_cast<uint64_t>(seed));
    rows.push_back(blockMeans(traced.render(camera, wanted).image));
  }
  return rows;
}

Rows referenceRows(const Scene& scene, const Camera& camera, int spp) {
  Rows rows;
  for (int seed = 0; seed < seeds; ++seed) {
    const RenderSettings wanted = settings(width, height, spp, 8, 900 + static_cast<uint64_t>(seed));
    rows.push_back(blockMeans(renderReference(scene, camera, wanted, openDevice("cpu").threads).image));
  }
  return rows;
}

/// The same scene with one material 2 % brighter, its texture too.
Scene brightened(Scene scene, uint32_t material) {
  Material& changed = scene.materials[material];
  changed.kd *= 1.02f;
  if (changed.texture >= 0) {
    Texture& texture = scene.textures[static_cast<std::size_t>(changed.texture)];
    Image image = lightOf(*texture.texels);
    for (vec3& texel : image.pixels) texel *= 1.02f;
    texture = textureOf(image);
  }
  return scene;
}

/// The material that most of the view's pixels see.
uint32_t mainMaterial(const Scene& scene, const Camera& camera) {
  const Device device = chosenDevice();
  const Traced traced(device, scene);
  const Pinhole pinhole = makePinhole(camera, width, height);
  std::vector<Ray> rays;
  for (int i = 0; i < width * height; ++i)
    rays.push_back({pinhole.eye, 0, pinhole.direction(i % width + 0.5f, i / width + 0.5f), FLT_MAX});
  const Buffer<Ray> onDevice(device, std::span<const Ray>(rays));
  const Buffer<Hit> hits(device, rays.size());
  traced.tracer().closest(device, "materials", static_cast<uint32_t>(rays.size()), onDevice.data(), hits.data());
  std::vector<int> pixels(scene.materials.size(), 0);
  for (const Hit& hit : hits.toHost())
    if (hit.triangle != Hit::none) ++pixels[scene.materialOf[hit.triangle]];
  return static_cast<uint32_t>(std::max_element(pixels.begin(), pixels.end()) - pixels.begin());
}

void agreeAndNotice(const Scene& scene, const Camera& camera, int pathSpp, int referenceSpp) {
  const Rows reference = referenceRows(scene, camera, referenceSpp);
  const auto say = [&](const char* what, const Verdict& v) {
    std::printf("%s, %s: chi-square %+.1f sigma, worst block %.1f, mean difference %+.2f %%\n", scene.name.c_str(),
                what, v.chiSigmas, v.worst, 100 * v.mean);
  };
  const Verdict same = compare(pathRows(scene, camera, pathSpp), reference);
  say("as it is", same);
  CHECK(same.alike());
  if (!enough) return;
  const uint32_t material = mainMaterial(scene, camera);
  const Verdict planted = compare(pathRows(brightened(scene, material), camera, pathSpp), reference);
  say(("2 % on " + scene.materials[material].name).c_str(), planted);
  CHECK_FALSE(planted.alike());
}

}  // namespace

TEST_CASE("Cornell box: the path tracer agrees with the reference tracer and 2 % in one material show", "[medium]") {
  const Scene scene = findGenerator("cornell").generate(38, 1);
  agreeAndNotice(scene, scene.cameras.at(0), 4, 4);
}

TEST_CASE("Atrium: the path tracer agrees with the reference tracer and 2 % in one material show", "[slow]") {
  const Scene scene = findGenerator("atrium").generate(30000, 1);
  // The third view turned down, to where one material fills most of every block.
  Camera camera = scene.cameras.at(2);
  const vec3 forward = camera.at - camera.eye;
  camera.at = camera.eye + vec3(forward.x, -std::hypot(forward.x, forward.z), forward.z);
  camera.vfov = 60;
  agreeAndNotice(scene, camera, 8, 1);
}

TEST_CASE("Sibenik: the path tracer agrees with the reference tracer and 2 % in one material show", "[slow]") {
  const std::string file = realMesh("sibenik/sibenik.obj");
  if (file.empty()) return skipTest("no Sibenik");
  Scene scene = loadScene(file);
  loadTextures(scene);
  scene.sky.reset();
  for (const vec3 centre : {vec3(-10, 4, 0), vec3(-2, 4, 0), vec3(9.5f, 8, 0)})
    scene.quads.push_back({centre - vec3(1, 0, 1), {2, 0, 0}, {0, 0, 2}, {40, 36, 30}});
  agreeAndNotice(scene, lookAt({-10.8762f, -6.0474f, 0.3653f}, {-7.13f, -7.5378f, 0.325f}, 45), 3, 3);
}
