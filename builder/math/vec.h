// Vectors are GLM's. Note that vec3 is 12 bytes: what is read in bulk on a GPU is laid out in 16-byte words.
#pragma once

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include <cmath>

namespace copse {

using glm::uvec3;
using glm::vec2;
using glm::vec3;
using glm::vec4;

/// On the host.
inline bool isFinite(const vec3& p) { return std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z); }

}  // namespace copse
