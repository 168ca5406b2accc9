// The reference tracer as an integrator.
#include "tracer/integrators/integrator.h"

#include "tracer/integrators/reference/reference.h"

namespace copse {

namespace {

class ReferenceIntegrator final : public Integrator {
 public:
  explicit ReferenceIntegrator(const IntegratorInput& input) : scene_(input.scene) {}

  Picture render(const Device& device, const Camera& camera, const RenderSettings& settings,
                 const Watch& watch) const override {
    ReferenceResult result = renderReference(scene_, camera, settings, device.threads, watch);
    Picture picture;
    picture.buildMs = result.buildMs;
    picture.renderMs = result.renderMs;
    picture.samplesDone = result.samplesDone;
    picture.rays = {result.rays[0], result.rays[1], result.rays[2]};
    picture.image = std::move(result.image);
    return picture;
  }

 private:
  const Scene& scene_;
};

}  // namespace

extern const IntegratorEntry referenceIntegrator;
constinit const IntegratorEntry referenceIntegrator{
    .name = "reference",
    .meaning = "light by an independent tracer in double precision, which shares only the scene with path",
    .tree = TreeUse::none,
    .rendersLight = true,
    .onCpuOnly = true,
    .takes = {.exposure = true},
    .make = [](const Device&, const IntegratorInput& input, const IntegratorOptions&)
        -> std::unique_ptr<const Integrator> { return std::make_unique<ReferenceIntegrator>(input); }};

}  // namespace copse
