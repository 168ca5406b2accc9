// The wavefront path tracer's loop: batches of paths, bounce by bounce, each stage one launch over a queue.
// Work is numbered sample by sample over the whole image and every path has a slot of its own in its batch, so the
// image depends neither on the size of a batch nor on the order of a queue, and a stopped render gives a whole image.
#include "tracer/integrators/path/path_tracer.h"

#include <optional>
#include <utility>

#include "builder/parallel/launch.h"
#include "builder/parallel/pending_read.h"
#include "builder/parallel/primitives.h"
#include "tracer/integrators/film.h"
#include "tracer/integrators/path/queues.h"
#include "tracer/integrators/phases.h"

namespace copse {

namespace {

/// Grain of kernels whose work is uneven: small.
constexpr uint32_t grain = 256;

struct Generate {
  Pinhole pinhole;
  uint64_t seed, first;  ///< Number of the batch's first path.
  uint32_t width, pixels;
  const uint32_t* pixelAt;
  PathQueue queue;
  uint64_t* keys;
  vec3* radiance;

  HD void operator()(uint32_t i) const {
    const uint64_t sample = (first + i) / pixels;
    const uint32_t pixel = pixelAt[(first + i) % pixels];
    const uint64_t key = randomKey(seed, pixel, sample);
    queue.rays[i] = cameraRay(pinhole, width, pixel, key);
    queue.throughput[i] = vec4(1, 1, 1, 0);
    queue.slots[i] = i;
    keys[i] = key;
    radiance[i] = vec3(0);
  }
};

/// Compacts the paths that go on and the shadow rays, in order. A hit's own count is the sum before the next hit less
/// the sum before it.
struct Pack {
  PathQueue from, to;
  const uint64_t* before;  ///< Prefix sums of Onward.
  const Ray* shadowRays;
  Ray* shadowPacked;
  uint32_t lightSamples;

  HD void operator()(uint32_t i) const {
    const uint64_t here = before[i], next = before[i + 1];
    const uint32_t place = Onward::paths(here);
    if (place != Onward::paths(next)) {
      to.rays[place] = from.rays[i];
      to.throughput[place] = from.throughput[i];
      to.slots[place] = from.slots[i];
    }
    uint64_t ray = static_cast<uint64_t>(i) * lightSamples;
    for (uint32_t k = Onward::shadowRays(here); k < Onward::shadowRays(next); ++k) shadowPacked[k] = shadowRays[ray++];
  }
};

/// Each path adds the light of its own shadow rays, in their order.
struct AddLight {
  const uint32_t* slots;
  const uint64_t* before;  ///< Prefix sums of Onward.
  const uint32_t* occluded;
  const vec3* shadowLight;
  vec3* radiance;
  uint32_t lightSamples;

  HD void operator()(uint32_t i) const {
    const uint32_t begin = Onward::shadowRays(before[i]), end = Onward::shadowRays(before[i + 1]);
    if (begin == end) return;
    uint64_t ray = static_cast<uint64_t>(i) * lightSamples;
    vec3 sum(0);
    for (uint32_t k = begin; k < end; ++k, ++ray)
      if (!occluded[k]) sum += shadowLight[ray];
    radiance[slots[i]] += sum;
  }
};

struct RadianceOfPath {
  const vec3* radiance;
  HD vec3 operator()(const FilmSample& sample) const { return radiance[sample.place]; }
};

struct DivideBySamples {
  HD void operator()(uint32_t, vec3& sum, uint64_t samples) const {
    sum = samples ? sum / static_cast<float>(samples) : vec3(0);
  }
};

/// One render: the scene, the queues and the film.
class Wavefront {
 public:
  Wavefront(const Device& device, const SceneView& scene, const RayTracer& tracer, const Pinhole& pinhole,
            const RenderSettings& settings, const PathOptions& options)
      : device_(device),
        scene_(scene),
        tracer_(tracer),
        pinhole_(pinhole),
        settings_(settings),
        options_(options),
        order_(device, settings.width, settings.height),
        queues_(device, queueCapacity(device, work(), settings.lightSamples, options.queue),
                static_cast<uint32_t>(settings.lightSamples)),
        film_(device, order_,
              static_cast<uint64_t>(settings.spp) > exactFilmSamples ? exactFilmSamples : Film<vec3>::never),
        totals_(device) {
    if (options.surfaces) surfaces_.emplace(device, scene, pinhole, order_);
    if (options.from && options.from->samples > 0) film_.restore(options.from->sums, options.from->lost);
  }

  uint64_t work() const { return static_cast<uint64_t>(settings_.spp) * pixels(); }

  /// Traces the batch of paths that starts at `first` and adds it to the film; returns the number of the path after the
  /// batch.
  uint64_t batch(uint64_t first) {
    const uint32_t paths = traceCamera(first, work());
    uint32_t live = shade(1, paths);
    for (uint32_t hit = 2; live > 0; ++hit) {
      trace(phases::traceBounce, live);
      rays_.bounce += live;
      live = shade(hit, live);
    }
    film_.add(device_, phases::accumulate, first, paths, RadianceOfPath{queues_.radiance.data()});
    return first + paths;
  }

  /// The surfaces alone of a batch of paths that the film already has.
  uint64_t surfacesBefore(uint64_t first) { return first + traceCamera(first, options_.from->samples); }
  bool hasSurfaces() const { return surfaces_.has_value(); }

  FilmState film(uint64_t done) const { return {done, film_.sums().toHost(), film_.lost().toHost()}; }

  /// Divides the film by the samples that its pixels have once `done` paths are in it.
  void finish(uint64_t done, PathResult& result) {
    Image& image = result.image;
    image.width = settings_.width;
    image.height = settings_.height;
    image.pixels.resize(pixels());
    {
      const Phase phase(device_, phases::accumulate);  // The copy counts: before it there is no image on the host.
      film_.finish(device_, phases::accumulate, done, DivideBySamples{});
      copyToHost(device_, image.pixels.data(), film_.sums().data(), film_.sums().bytes());
    }
    if (surfaces_) result.surfaces = surfaces_->finish(device_, done, settings_.width, settings_.height);
  }

  const RayCounts& rays() const { return rays_; }
  uint32_t pixels() const { return order_.pixels(); }

 private:
  void trace(PhaseName name, uint32_t count) {
    const Phase phase(device_, name);
    tracer_.closest(device_, name, count, queues_.paths.rays.data(), queues_.hits.data());
  }

  /// Starts as many paths as there is room for, from number `first` to before `end`, and returns how many.
  uint32_t traceCamera(uint64_t first, uint64_t end) {
    const uint32_t paths = static_cast<uint32_t>(std::min<uint64_t>(queues_.capacity, end - first));
    launch(device_, phases::generate, paths,
           Generate{pinhole_, settings_.seed, first, static_cast<uint32_t>(settings_.width), pixels(), order_.pixelAt(),
                    queues_.paths.view(), queues_.keys.data(), queues_.radiance.data()});
    trace(phases::tracePrimary, paths);
    rays_.primary += paths;
    if (surfaces_) surfaces_->add(device_, {first, paths, queues_.paths.rays.data(), queues_.hits.data()});
    return paths;
  }

  /// Shades `count` hits, traces their shadow rays, and returns the number of paths that go on.
  uint32_t shade(uint32_t hit, uint32_t count) {
    const uint32_t lightSamples = static_cast<uint32_t>(settings_.lightSamples);
    const ShadeSettings settings{hit, static_cast<uint32_t>(settings_.maxDepth), lightSamples,
                                 options_.bounceFindsLight};
    Queues& q = queues_;
    {
      const Phase phase(device_, phases::shade);
      launch(device_, phases::shade, count,
             Shade{scene_, settings, q.paths.view(), q.hits.data(), q.keys.data(), q.radiance.data(), q.onward.data(),
                   q.shadowRays.data(), q.shadowLight.data()},
             grain);
      uint64_t* const all = q.onward.data() + count;
      exclusiveScan(device_, phases::shade, count, q.onward.data(), q.onward.data(), all);
      totals_.start(all);  // They arrive on the host while the paths are packed.
      launch(device_, phases::shade, count,
             Pack{q.paths.view(), q.packed.view(), q.onward.data(), q.shadowRays.data(), q.shadowPacked.data(),
                  lightSamples});
    }
    const uint64_t totals = totals_.wait<uint64_t>();
    if (const uint32_t shadowRays = Onward::shadowRays(totals)) {
      {
        const Phase phase(device_, phases::traceShadow);
        tracer_.any(device_, phases::traceShadow, shadowRays, q.shadowPacked.data(), q.occluded.data());
      }
      rays_.shadow += shadowRays;
      launch(device_, phases::accumulate, count,
             AddLight{q.paths.slots.data(), q.onward.data(), q.occluded.data(), q.shadowLight.data(), q.radiance.data(),
                      lightSamples});
    }
    std::swap(q.paths, q.packed);
    return Onward::paths(totals);
  }

  const Device& device_;
  SceneView scene_;
  const RayTracer& tracer_;
  Pinhole pinhole_;
  RenderSettings settings_;
  PathOptions options_;
  PixelOrder order_;
  Queues queues_;
  Film<vec3> film_;
  PendingRead totals_;
  std::optional<SurfaceFilm> surfaces_;
  RayCounts rays_;
};

constexpr ParameterSpec queueSpec{.name = "path.queue",
                                  .standard = 0,
                                  .min = 0,
                                  .max = 1 << 24,
                                  .meaning = "paths in flight, fewer where memory limits them; 0: the device's default",
                                  .ofTree = false};

}  // namespace

std::unique_ptr<SceneOnDevice> uploadScene(const Device& device, const Scene& scene) {
  return std::make_unique<SceneOnDevice>(device, scene);
}

TrianglesView trianglesOf(const SceneOnDevice& scene) { return scene.triangles(); }

std::vector<ParameterSpec> pathParameters() { return {queueSpec}; }

uint32_t pathQueueOf(const Parameters& parameters) { return static_cast<uint32_t>(parameters.integer(queueSpec)); }

PathResult renderPath(const Device& device, const SceneOnDevice& scene, const RayTracer& tracer, const Camera& camera,
                      const RenderSettings& settings, const Watch& watch, const PathOptions& options) {
  checkSettings(settings);
  const Pinhole pinhole = makePinhole(camera, settings.width, settings.height);
  Wavefront wavefront(device, scene.view(), tracer, pinhole, settings, options);
  const auto stopped = [&] { return watch.stop && watch.stop->load(); };
  uint64_t done = options.from ? options.from->samples : 0;
  if (wavefront.hasSurfaces())
    for (uint64_t before = 0; before < done;) before = wavefront.surfacesBefore(before);
  while (done < wavefront.work() && !stopped()) {
    done = wavefront.batch(done);
    if (watch.progress) watch.progress(static_cast<double>(done) / static_cast<double>(wavefront.work()));
  }
  PathResult result;
  if (options.from || done < wavefront.work()) result.film = wavefront.film(done);
  wavefront.finish(done, result);
  result.rays = wavefront.rays();
  result.samplesDone = static_cast<double>(done) / wavefront.pixels();
  return result;
}

}  // namespace copse
