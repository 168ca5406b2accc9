// A few bytes of the device's memory on their way to the host, while what is launched after them runs already: the host
// waits, the device does not.
#pragma once

#include <cstddef>

#include "builder/parallel/device.h"

namespace copse {

class PendingRead {
 public:
  static constexpr std::size_t maxBytes = 64;

  explicit PendingRead(const Device& device);
  ~PendingRead();
  PendingRead(const PendingRead&) = delete;
  PendingRead& operator=(const PendingRead&) = delete;

  /// Reads what is at `from` once everything launched so far has run.
  template <class T>
  void start(const T* from) {
    static_assert(sizeof(T) <= maxBytes);
    startBytes(from, sizeof(T));
  }
  /// What was read. Throws DeviceError for an error of an earlier launch.
  template <class T>
  T wait() {
    return *static_cast<const T*>(waitForBytes());
  }

  struct Slot;  ///< Memory that a device can write to by itself, and an event.

 private:
  void startBytes(const void* from, std::size_t bytes);
  const void* waitForBytes();

  Device device_;
  Slot* slot_;
  bool isPending_ = false;
};

}  // namespace copse
