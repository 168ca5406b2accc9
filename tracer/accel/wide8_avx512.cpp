// The kernels of wide trees for AVX-512; CMakeLists.txt has this file's flags.
#include "tracer/accel/runs.h"
#include "tracer/accel/wide8_kernels.h"
#include "tracer/accel/wide8_steps.h"

namespace copse {

void wide8ClosestAvx512(const Wide8View& view, const Ray* rays, uint32_t begin, uint32_t end, Hit* hits) {
  closestOfRun<Wide8>(view, rays, begin, end, hits);
}

void wide8AnyAvx512(const Wide8View& view, const Ray* rays, uint32_t begin, uint32_t end, uint32_t* occluded) {
  anyOfRun<Wide8>(view, rays, begin, end, occluded);
}

}  // namespace copse
