// Where kernels run: this machine's threads or a CUDA device, chosen at run time.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace copse {

class Timeline;

enum class DeviceKind { cpu, cuda };

/// A handle, cheap to copy. Everything that allocates or launches takes one.
struct Device {
  DeviceKind kind = DeviceKind::cpu;
  std::string name;        ///< The processor's or the card's own name.
  int threads = 1;         ///< CPU threads that a launch may use.
  int ordinal = 0;         ///< CUDA's device number.
  void* stream = nullptr;  ///< CUDA's stream; launches and copies are ordered on it.
  /// Whether a CUDA device gives memory from a pool in the order of the stream. A card, or what a virtual one passes
  /// on, may have none; then a release waits for the stream, and the device's memory in use is not known.
  bool hasPools = false;
  Timeline* timeline = nullptr;  ///< Where launches record their time; none where null.

  bool isCuda() const { return kind == DeviceKind::cuda; }
  /// "cuda" or "cpu", as records and tables have it.
  const char* kindName() const { return isCuda() ? "cuda" : "cpu"; }

  /// The same device, with launches recorded in `timeline`, which must outlive the handle's use.
  Device recording(Timeline& timeline) const;
};

/// The device that a user asks for. Automatic: CUDA where there is a device, otherwise the CPU.
enum class DeviceChoice { automatic, cuda, cpu };

/// The names of deviceChoice, for messages and help.
inline constexpr const char* deviceChoices = "auto, cuda or cpu";

/// Nothing for another name.
std::optional<DeviceChoice> deviceChoice(std::string_view name);

/// Opens what the name of a DeviceChoice says.
/// `threads` 0 means every processor that this process may use.
/// Throws InputError for another name or threads outside 0 … 1024; DeviceError where "cuda" is asked for and no device
/// is there, or where the system refuses to start so many threads.
Device openDevice(const std::string& name, int threads = 0);

/// Processors that this process may use.
int processorCount();

/// Every device that openDevice could give, the CPU first.
std::vector<Device> listDevices();

/// Waits until everything launched has finished; throws DeviceError for an error of an earlier launch.
void synchronise(const Device& device);

namespace detail {
/// count * size; throws DeviceError where no memory could hold it.
std::size_t bytesOf(std::size_t count, std::size_t size);
}  // namespace detail

/// Memory of `device`: `bytes` > 0, aligned to 256 bytes, uninitialised. Throws DeviceError naming the size.
void* allocate(const Device& device, std::size_t bytes);
void release(const Device& device, void* memory) noexcept;

/// Copies between host memory and the device's; the host side may be reused on return.
void copyToDevice(const Device& device, void* to, const void* from, std::size_t bytes);
void copyToHost(const Device& device, void* to, const void* from, std::size_t bytes);
void fillBytes(const Device& device, void* memory, unsigned char value, std::size_t bytes);

}  // namespace copse
