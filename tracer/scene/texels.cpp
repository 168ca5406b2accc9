// The table that decodes 8-bit texels to linear light, shared by all readers.
#include "tracer/scene/texels.h"

#include "tracer/scene/colour.h"

namespace copse {

const void* Texels::data() const {
  return format == TexelFormat::half ? static_cast<const void*>(halves.data()) : bytes.data();
}

vec3 Texels::at(int x, int y) const {
  return decodeTexel(data(), format, texelTable().data(), static_cast<uint64_t>(y) * width + x);
}

const std::vector<float>& texelTable() {
  static const std::vector<float> table = [] {
    std::vector<float> values;
    for (int i = 0; i < 256; ++i) values.push_back(linearOfScreen(i * (1 / 255.0f)));
    for (int i = 0; i < 256; ++i) values.push_back(i * (1 / 255.0f));
    return values;
  }();
  return table;
}

}  // namespace copse
