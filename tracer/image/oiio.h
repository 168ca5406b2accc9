// What textures.cpp asks of the one file that knows OpenImageIO.
#pragma once

#include <string>

#include "tracer/scene/image.h"

namespace copse {

/// The first image of any file that OpenImageIO reads, in linear RGB: whole numbers are taken as sRGB, floats as
/// linear. Alpha is left out and colours are not multiplied by it. Throws InputError "FILE: why".
Image readByOpenImageIO(const std::string& file);

}  // namespace copse
