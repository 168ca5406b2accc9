// What a DeviceError tells: which call failed, how, and which launch was the last. Without a CUDA device every call
// fails, which shows it too; what a kernel did wrong takes a device.

#include <cstdlib>
#include <filesystem>

#include "builder/base/error.h"
#include "builder/parallel/buffer.h"
#include "builder/parallel/launch.h"
#include "builder/parallel/launch_warps.h"
#include "tests/support/catch.h"
#include "tests/support/devices.h"
#include "tests/support/real_meshes.h"

#if COPSE_CUDA
#include "builder/parallel/cuda_check.h"

using namespace copse;
using copse::test::Contains;
using copse::test::StartsWith;

namespace {

struct Nothing {
  HD void operator()(uint32_t) const {}
  HD void operator()(Warp&, uint32_t) const {}
};

/// Writes where nothing is.
struct Stray {
  HD void operator()(uint32_t i) const { *reinterpret_cast<volatile uint32_t*>(std::uintptr_t{16} + 4 * i) = i; }
};

template <class Action>
std::string errorOf(Action action) {
  try {
    action();
  } catch (const DeviceError& error) {
    return error.what();
  }
  return "no error";
}

}  // namespace

TEST_CASE("an error of a CUDA call names the call, what is wrong and CUDA's own name for it, success is none") {
  CHECK_NOTHROW(detail::checkCuda(cudaSuccess, "cudaMalloc"));
  const std::string told = errorOf([] { detail::checkCuda(cudaErrorMemoryAllocation, "cudaMalloc of 12 bytes"); });
  CHECK_THAT(told, StartsWith("cudaMalloc of 12 bytes: out of memory (cudaErrorMemoryAllocation)"));
}

TEST_CASE("without a CUDA device a launch fails with an error that names the call and the launch") {
  if (listDevices().size() > 1) return test::skipTest("there is a CUDA device");
  Device absent;
  absent.kind = DeviceKind::cuda;
  CHECK_THAT(errorOf([&] { launch(absent, "first launch", 1, Nothing{}); }),
             StartsWith("cudaSetDevice: ") && Contains("(cuda") && Contains("; last launch 'first launch'"));
  CHECK_THAT(errorOf([&] { launchWarps(absent, "second launch", 1, Nothing{}); }),
             StartsWith("cudaSetDevice: ") && Contains("; last launch 'second launch'"));
  CHECK_THAT(errorOf([&] { Buffer<uint32_t>(absent, 8); }), Contains("; last launch 'second launch'"));
}

// An error of a kernel ends the use of CUDA in its process, so this is run in one of its own.
TEST_CASE("a kernel that strays is told by the next call that waits, with the launch", "[.][strays]") {
  const Device device = openDevice("cuda");
  launch(device, "harmless", 1, Nothing{});
  synchronise(device);
  launch(device, "stray", 64, Stray{});
  CHECK_THAT(errorOf([&] { synchronise(device); }),
             StartsWith("cudaStreamSynchronize: ") && Contains("(cudaErrorIllegalAddress); last launch 'stray'"));
}

TEST_CASE("on a CUDA device errors of launches and kernels name the launch") {
  const std::vector<Device> all = listDevices();
  if (all.size() < 2) return test::skipTest("no CUDA device");
  const Device& device = all[1];
  CHECK_THAT(errorOf([&] { launchWarps(device, "too much", 1, Nothing{}, 1u << 24); }), Contains("launch 'too much'"));
  CHECK_NOTHROW(launch(device, "after it", 1, Nothing{}));
  CHECK_NOTHROW(synchronise(device));
  const std::string self = std::filesystem::read_symlink("/proc/self/exe");
  CHECK(std::system(("'" + self + "' '[strays]'").c_str()) == 0);
}
#endif
