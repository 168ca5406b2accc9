// The channel names of the surface buffers.
#pragma once

#include <vector>

#include "tracer/image/image_io.h"
#include "tracer/integrators/surfaces/surface_buffers.h"

namespace copse {

inline constexpr const char* surfaceChannels[] = {"N.X", "N.Y", "N.Z", "albedo.R", "albedo.G", "albedo.B", "Z"};

/// All of surfaceChannels, in their order.
std::vector<Channel> channelsOf(const SurfaceBuffers& surfaces);

}  // namespace copse
