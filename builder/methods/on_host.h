// For methods of the CPU: their input as the host sees it, and their tree as the device's.
#pragma once

#include <span>
#include <utility>

#include "builder/primitives/primitives.h"

namespace copse {

/// The CPU with the device's threads, and the boxes in its memory: copied where the device has memory of its own. The
/// triangles stay where they are.
struct HostInput {
  Device host;  ///< Records no time of its own: phases are the device's.
  OwnedPrimitives copied;
  Primitives input;

  HostInput(const Device& device, const Primitives& from) : input(from) {
    host.threads = device.threads;
    if (!device.isCuda()) return;
    copied = OwnedPrimitives(host, from.count, from.triangles);
    copyToHost(device, copied.boxes(), from.boxes, from.count * sizeof(Box));
    copyToHost(device, copied.bounds(), from.bounds, sizeof(Box));
    input.boxes = copied.boxes();
    input.bounds = copied.bounds();
  }
};

/// Host memory as the device's: the same where the device is the host.
template <class T>
Buffer<T> onDevice(const Device& device, Buffer<T>&& host) {
  if (!device.isCuda()) return std::move(host);
  return Buffer<T>(device, std::span<const T>(host.data(), host.size()));
}

}  // namespace copse
