// The devices that tests run on: as --device says. By default, auto, all available ones, the CPU first. A test that
// requests none of these runs on the CPU or on no device at all; main.cpp counts and reports the others.
#pragma once

#include <string>
#include <vector>

#include "builder/parallel/device.h"

namespace copse::test {

std::vector<Device> devices();

/// A device whose code runs on the CPU (tests/gpu/emulate), where an input of thousands of triangles takes minutes.
inline bool isEmulated(const Device& device) { return device.name == "emulated"; }

/// One device, for tests that need only one: CUDA for --device cuda, and for auto where available; otherwise the CPU.
Device chosenDevice();

/// The same as a word, for the option --device of a program that a test starts.
std::string deviceOption();

}  // namespace copse::test
