// tracer/accel/host_kernels: each instruction set in turn, forced by trace.simd, against the binary tree.
#include "tracer/accel/host_kernels.h"

#include <cstring>

#include "tests/support/catch.h"
#include "tests/support/devices.h"
#include "tests/support/trees.h"
#include "tracer/accel/tracers.h"

using namespace copse;
using namespace copse::test;

namespace {

const std::vector<ParameterSpec> table{simdParameter()};

Parameters simd(const char* name) {
  Parameters parameters(table);
  parameters.set("trace.simd", std::string(name));
  return parameters;
}

struct Answers {
  std::vector<Hit> hits;
  std::vector<uint32_t> occluded;

  Answers(const Device& device, const RayTracer& tracer, const std::vector<Ray>& rays)
      : hits(rays.size()), occluded(rays.size()) {
    const auto n = static_cast<uint32_t>(rays.size());
    tracer.closest(device, "closest", n, rays.data(), hits.data());
    tracer.any(device, "any", n, rays.data(), occluded.data());
  }
  friend bool operator==(const Answers& a, const Answers& b) {
    return a.occluded == b.occluded && std::memcmp(a.hits.data(), b.hits.data(), a.hits.size() * sizeof(Hit)) == 0;
  }
};

}  // namespace

TEST_CASE("Every instruction set that runs here gives the hits of the binary tree") {
  const Device cpu = openDevice("cpu");
  for (const HostKernels& kernels : hostKernels()) {
    if (!kernels.runsHere()) continue;
    for (const std::string& input : inputNames())
      for (const uint32_t leaf : {1u, 4u, 1000u}) {
        INFO(kernels.name << ", " << input << ", " << leaf << " per leaf");
        const TestMesh mesh = makeInput(input, 600);
        const Bvh bvh = medianTree(cpu, mesh, leaf);
        const std::vector<Ray> apart = raysAround(mesh, 700, 3);
        std::vector<Ray> alike = apart;
        for (Ray& ray : alike) ray.direction = glm::abs(ray.direction);
        const auto wide = makeTracer(cpu, bvh, mesh.hostView(), "wide8", simd(kernels.name));
        const auto binary = makeTracer(cpu, bvh, mesh.hostView(), "binary");
        for (const std::vector<Ray>& rays : {apart, alike})
          REQUIRE(Answers(cpu, *wide, rays) == Answers(cpu, *binary, rays));
      }
  }
}

TEST_CASE("trace.simd names the kernels, and auto takes the last that the processor has") {
  CHECK(hostKernels()[0].name == std::string("portable"));
  CHECK(hostKernels()[0].runsHere());
  std::string last;
  for (const HostKernels& kernels : hostKernels()) {
    if (kernels.runsHere()) {
      CHECK(chosenKernels(simd(kernels.name)).name == std::string(kernels.name));
      last = kernels.name;
    } else {
      CHECK_THROWS_WITH(chosenKernels(simd(kernels.name)), Contains("trace.simd") && Contains(kernels.name));
    }
  }
  CHECK(chosenKernels(simd("auto")).name == last);
  CHECK(chosenKernels(Parameters(table)).name == last);
}
