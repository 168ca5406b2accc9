// The devices that tests run on: the CPU always, CUDA where it is there, or what --device says.
#pragma once

#include <vector>

#include "builder/parallel/device.h"

namespace copse::test {

std::vector<Device> devices();

}  // namespace copse::test
