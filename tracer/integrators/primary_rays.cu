// Two launches a batch and the film's own; nothing is read back before the end.
#include "tracer/integrators/primary_rays.h"

#include "builder/parallel/launch.h"
#include "tracer/integrators/path/queues.h"

namespace copse {

namespace {

struct GenerateRays {
  Camera camera;
  uint64_t seed, first;
  uint32_t width, pixels;
  Ray* rays;

  HD void operator()(uint32_t i) const {
    const uint32_t pixel = static_cast<uint32_t>((first + i) % pixels);
    rays[i] = cameraRay(camera, width, pixel, randomKey(seed, pixel, (first + i) / pixels));
  }
};

class Surfaces final : public PrimaryFilm {
 public:
  explicit Surfaces(SurfaceFilm film) : film_(std::move(film)) {}
  void add(const Device& device, const PrimaryBatch& batch) override { film_.add(device, batch); }
  const SurfaceFilm& film() const { return film_; }

 private:
  SurfaceFilm film_;
};

uint32_t pixelsOf(const RenderSettings& settings) {
  return static_cast<uint32_t>(settings.width) * static_cast<uint32_t>(settings.height);
}

}  // namespace

uint64_t tracePrimary(const Device& device, const RayTracer& tracer, const Camera& camera,
                      const RenderSettings& settings, PrimaryFilm& film, const Watch& watch, uint32_t queue,
                      const char* name) {
  checkSettings(settings);
  const uint32_t pixels = pixelsOf(settings);
  const uint64_t work = static_cast<uint64_t>(settings.spp) * pixels;
  const uint32_t capacity = queueCapacity(device, work, 1, queue);
  const Buffer<Ray> rays(device, capacity);
  const Buffer<Hit> hits(device, capacity);
  uint64_t done = 0;
  while (done < work && !(watch.stop && watch.stop->load())) {
    const uint32_t count = static_cast<uint32_t>(std::min<uint64_t>(capacity, work - done));
    launch(device, "generate", count,
           GenerateRays{camera, settings.seed, done, static_cast<uint32_t>(settings.width), pixels, rays.data()});
    {
      const Phase phase(device, name);
      tracer.closest(device, name, count, rays.data(), hits.data());
    }
    film.add(device, {done, count, rays.data(), hits.data()});
    if (watch.stop) synchronise(device);  // Otherwise a device that lags behind would have all work before a signal.
    done += count;
    if (watch.progress) watch.progress(static_cast<double>(done) / static_cast<double>(work));
  }
  return done;
}

SurfaceResult renderSurfaces(const Device& device, const SceneView& scene, const RayTracer& tracer, const View& view,
                             const RenderSettings& settings, const Watch& watch, uint32_t queue) {
  checkSettings(settings);
  const Camera camera = makeCamera(view, settings.width, settings.height);
  Surfaces surfaces(SurfaceFilm(device, scene, camera, pixelsOf(settings)));
  SurfaceResult result;
  result.samples = tracePrimary(device, tracer, camera, settings, surfaces, watch, queue);
  result.buffers = surfaces.film().finish(device, result.samples, settings.width, settings.height);
  return result;
}

}  // namespace copse
