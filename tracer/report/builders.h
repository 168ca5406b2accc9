// What the registry says of a name that stands in a record: where its builder stands in tables and legends, the colour
// that it has in every figure, and what it reads.
#pragma once

#include <string>

namespace copse::report {

/// What others are set against: with a build that counts as nothing, and as it is.
constexpr const char* idealBuilder = "sah";
constexpr const char* baselineBuilder = "lbvh";

/// The ideal's builder first, then builders in the order of the registry, then baselines, then names that this build
/// does not know.
int builderRank(const std::string& builder);

/// 0xRRGGBB. A family of methods has a colour, in the order of the registry, and its builders shades of it; what this
/// build does not know is grey.
unsigned builderColor(const std::string& builder);

/// Whether the builder's method declares that parameter: "kmeans.k".
bool readsParameter(const std::string& builder, const std::string& parameter);
/// Whether the parameter is one method's own.
bool isOfOneMethod(const std::string& parameter);
/// Whether it is read where rays are traced.
bool isOfTracer(const std::string& parameter);

}  // namespace copse::report
