// The parameters of a program that builds trees and traces rays.
#pragma once

#include <span>

#include "builder/parameters.h"

namespace copse {

/// What builders, ray tracers and the path tracer read, in that order.
std::span<const ParameterSpec> tracerParameters();

}  // namespace copse
