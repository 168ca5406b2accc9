// Camera rays alone: every picture without light transport is made of them. The rays are the path tracer's, sample for
// sample.
#pragma once

#include "builder/parallel/device.h"
#include "tracer/accel/ray_tracer.h"
#include "tracer/integrators/phases.h"
#include "tracer/integrators/pinhole.h"
#include "tracer/integrators/pixel_order.h"

namespace copse {

/// Camera rays and what they hit, in the device's memory: sample number `first` + i is that of rays[i], and the numbers
/// go through all pixels of one sample, in the order of pixel_order.h, before the next begins.
struct PrimaryBatch {
  uint64_t first;
  uint32_t count;
  const Ray* rays;
  const Hit* hits;
};

/// Takes batch after batch of rays with their hits.
class PrimaryFilm {
 public:
  virtual ~PrimaryFilm() = default;
  virtual void add(const Device& device, const PrimaryBatch& batch) = 0;
};

/// Traces spp camera rays per pixel and hands them to `film`. Phases `generate` and `phase`, and the film's own.
/// `order` is that of an image of `settings`. `queue` rays at a time, 0 for the device's default. Returns the samples
/// traced: fewer where it was stopped, and not always whole images. Throws InputError for invalid settings.
uint64_t tracePrimary(const Device& device, const RayTracer& tracer, const Pinhole& pinhole,
                      const RenderSettings& settings, const PixelOrder& order, PrimaryFilm& film,
                      const Watch& watch = {}, uint32_t queue = 0, PhaseName phase = phases::tracePrimary);

}  // namespace copse
