// gpu_ceilings: prints the maximum rates of a GPU. tests/gpu/run starts it.
#include "tests/gpu/ceilings.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "builder/base/error.h"
#include "builder/base/whole_file.h"
#include "tracer/cli/command_line.h"

using namespace copse;

namespace {

struct Options {
  uint32_t mib = 4096, ms = 500;
  std::string stats;
};

void run(const Options& options) {
  const Device device = openDevice("cuda");
  const Ceilings found = measureCeilings(device, std::size_t{options.mib} << 20, options.ms);
  fmt::print("{}: a copy of {} MiB moves {:.0f} GB/s, by a kernel {:.0f} GB/s\n", device.name, options.mib,
             found.copy * 1e-9, found.copyByKernel * 1e-9);
  fmt::print(
      "{:.0f} MHz over {:.0f} ms with all lanes busy: {:.2f}e12 lane instructions per second, {:.2f}e12 were "
      "executed\n",
      found.clock * 1e-6, found.loadMs, found.instructions * 1e-12, found.multiplyAdds * 1e-12);
  if (options.stats.empty()) return;
  const nlohmann::ordered_json json{{"device", device.name},
                                    {"copy_mib", options.mib},
                                    {"copy_gb_s", found.copy * 1e-9},
                                    {"copy_by_kernel_gb_s", found.copyByKernel * 1e-9},
                                    {"load_ms", found.loadMs},
                                    {"clock_mhz", found.clock * 1e-6},
                                    {"instructions_e12_s", found.instructions * 1e-12},
                                    {"multiply_adds_e12_s", found.multiplyAdds * 1e-12}};
  writeWholeFile(options.stats, json.dump(1) + "\n");
}

}  // namespace

int main(int argc, char** argv) {
  copse::cli::Program program("The maximum bytes and instructions per second of a GPU", "gpu_ceilings");
  Options options;
  program.option("--mib", options.mib, "MiB to copy").showDefault();
  program.option("--ms", options.ms, "minimum time for which all lanes are kept busy").showDefault();
  program.option("--stats", options.stats, "results as JSON");
  if (const auto status = program.parse(argc, argv)) return *status;
  try {
    run(options);
    return 0;
  } catch (const DeviceError& error) {
    fmt::print(stderr, "error: {}\n", error.what());
    return 3;
  }
}
