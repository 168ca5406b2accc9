// Two launches per batch and the film's own; nothing is read back before the end.
#include "tracer/integrators/primary_rays.h"

#include "builder/parallel/launch.h"
#include "tracer/integrators/path/queues.h"

namespace copse {

namespace {

struct GenerateRays {
  Pinhole pinhole;
  uint64_t seed, first;
  uint32_t width, pixels;
  const uint32_t* pixelAt;
  Ray* rays;

  HD void operator()(uint32_t i) const {
    const uint32_t pixel = pixelAt[(first + i) % pixels];
    rays[i] = cameraRay(pinhole, width, pixel, randomKey(seed, pixel, (first + i) / pixels));
  }
};

}  // namespace

uint64_t tracePrimary(const Device& device, const RayTracer& tracer, const Pinhole& pinhole,
                      const RenderSettings& settings, const PixelOrder& order, PrimaryFilm& film, const Watch& watch,
                      uint32_t queue, PhaseName phase) {
  checkSettings(settings);
  const uint32_t pixels = order.pixels();
  const uint64_t work = static_cast<uint64_t>(settings.spp) * pixels;
  const uint32_t capacity = queueCapacity(device, work, 1, queue);
  const Buffer<Ray> rays(device, capacity);
  const Buffer<Hit> hits(device, capacity);
  uint64_t done = 0;
  while (done < work && !(watch.stop && watch.stop->load())) {
    const uint32_t count = static_cast<uint32_t>(std::min<uint64_t>(capacity, work - done));
    launch(device, phases::generate, count,
           GenerateRays{pinhole, settings.seed, done, static_cast<uint32_t>(settings.width), pixels, order.pixelAt(),
                        rays.data()});
    {
      const Phase tracing(device, phase);
      tracer.closest(device, phase, count, rays.data(), hits.data());
    }
    film.add(device, {done, count, rays.data(), hits.data()});
    if (watch.stop) synchronise(device);  // Otherwise all work would be queued on a slow device before a signal.
    done += count;
    if (watch.progress) watch.progress(static_cast<double>(done) / static_cast<double>(work));
  }
  return done;
}

}  // namespace copse
