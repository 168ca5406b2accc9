// For methods of the CPU: their input as the host sees it, and their tree as the device's.
#pragma once

#include <span>
#include <utility>

#include "builder/registry.h"

namespace copse {

/// The CPU with the device's threads, and the boxes in its memory: copied where the device has memory of its own.
struct HostInput {
  Device host;  ///< Records no time of its own: phases are the device's.
  Buffer<Box> copied;
  BuildInput input;

  HostInput(const Device& device, const BuildInput& from) : input(from) {
    host.threads = device.threads;
    if (!device.isCuda()) return;
    copied = Buffer<Box>(host, from.count);
    copyToHost(device, copied.data(), from.boxes, copied.bytes());
    input.boxes = copied.data();
  }
};

/// Host memory as the device's: the same where the device is the host.
template <class T>
Buffer<T> onDevice(const Device& device, Buffer<T>&& host) {
  if (!device.isCuda()) return std::move(host);
  return Buffer<T>(device, std::span<const T>(host.data(), host.size()));
}

}  // namespace copse
