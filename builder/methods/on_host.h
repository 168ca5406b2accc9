// For methods of the CPU: their input as the host sees it, and their tree as the device's.
#pragma once

#include <span>
#include <utility>

#include "builder/method.h"

namespace copse {

/// The CPU with the device's threads, and the boxes in its memory: copied where the device has memory of its own.
struct HostInput {
  Device host;  ///< Records no time of its own: phases are the device's.
  Buffer<Box> copied;
  BuildInput input;

  HostInput(const Device& device, const BuildInput& from) : input(from) {
    host.threads = device.threads;
    if (!device.isCuda()) return;
    const std::size_t count = from.count;
    copied = Buffer<Box>(host, count + 1);
    copyToHost(device, copied.data(), from.boxes, count * sizeof(Box));
    copyToHost(device, copied.data() + count, from.bounds, sizeof(Box));
    input.boxes = copied.data();
    input.bounds = copied.data() + count;
  }
};

/// Host memory as the device's: the same where the device is the host.
template <class T>
Buffer<T> onDevice(const Device& device, Buffer<T>&& host) {
  if (!device.isCuda()) return std::move(host);
  return Buffer<T>(device, std::span<const T>(host.data(), host.size()));
}

}  // namespace copse
