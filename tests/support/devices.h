// The devices that tests run on: what --device says. By default, auto, all that there are, the CPU first.
// A test that asks for none of these runs on the CPU or on no device at all; main.cpp counts the others and tells.
#pragma once

#include <string>
#include <vector>

#include "builder/parallel/device.h"

namespace copse::test {

std::vector<Device> devices();

/// A device whose code runs on the CPU (tests/gpu/emulate), where an input of thousands of triangles takes minutes.
inline bool isEmulated(const Device& device) { return device.name == "emulated"; }

/// One device, for what needs no second: CUDA for --device cuda, and for auto where it is there; otherwise the CPU.
Device chosenDevice();

/// The same as a word, for the option --device of a program that a test starts.
std::string deviceOption();

}  // namespace copse::test
