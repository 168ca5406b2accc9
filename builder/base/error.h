// The errors that leave a public function. `main` catches them once and maps them to the exit status.
#pragma once

#include <stdexcept>
#include <string>

namespace copse {

/// Wrong usage or bad input: exit status 2. The text is "FILE:LINE: what is wrong", or what is wrong alone.
struct InputError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The device failed or is not there: exit status 3. The text names the call and the launch.
struct DeviceError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// A result failed its own check, such as a tree that loses a triangle: exit status 1.
struct ValidationError : std::runtime_error {
  using std::runtime_error::runtime_error;
};

}  // namespace copse
