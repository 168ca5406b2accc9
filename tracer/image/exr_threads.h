// OpenEXR's own threads, which pack and unpack pixels.
#pragma once

#include <cstdint>

namespace copse {

/// Starts them, once, for an image of that many pixels; a small image is done sooner than they are started.
void useExrThreads(int64_t pixels);

}  // namespace copse
