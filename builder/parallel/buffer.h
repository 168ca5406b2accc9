// An array in a device's memory that frees itself and cannot be copied by accident.
#pragma once

#include <cstdint>
#include <span>
#include <type_traits>
#include <utility>
#include <vector>

#include "builder/parallel/device.h"

namespace copse {

template <class T>
class Buffer {
  static_assert(std::is_trivially_copyable_v<T>);

 public:
  Buffer() = default;

  /// `count` uninitialised elements.
  Buffer(const Device& device, std::size_t count) : device_(device), size_(count) {
    if (count) data_ = static_cast<T*>(allocate(device, detail::bytesOf(count, sizeof(T))));
  }
  /// A copy of `from` on the device.
  Buffer(const Device& device, std::span<const T> from) : Buffer(device, from.size()) { upload(from); }

  Buffer(Buffer&& other) noexcept { swap(other); }
  Buffer& operator=(Buffer&& other) noexcept {
    Buffer(std::move(other)).swap(*this);
    return *this;
  }
  ~Buffer() {
    if (data_) release(device_, data_);
  }

  T* data() const { return data_; }
  std::size_t size() const { return size_; }
  std::size_t bytes() const { return size_ * sizeof(T); }
  bool empty() const { return size_ == 0; }

  void upload(std::span<const T> from) {
    if (!from.empty()) copyToDevice(device_, data_, from.data(), from.size_bytes());
  }
  /// The first `count` elements, on the host.
  std::vector<T> toHost(std::size_t count) const {
    std::vector<T> host(count);
    if (count) copyToHost(device_, host.data(), data_, count * sizeof(T));
    return host;
  }
  std::vector<T> toHost() const { return toHost(size_); }
  /// Element `i`, on the host: waits for the device.
  T read(std::size_t i) const {
    T value;
    copyToHost(device_, &value, data_ + i, sizeof(T));
    return value;
  }
  /// Every byte set to `value`.
  void fill(unsigned char value) {
    if (size_) fillBytes(device_, data_, value, bytes());
  }

  void swap(Buffer& other) noexcept {
    std::swap(device_, other.device_);
    std::swap(data_, other.data_);
    std::swap(size_, other.size_);
  }

 private:
  Device device_;
  T* data_ = nullptr;
  std::size_t size_ = 0;
};

}  // namespace copse
