// Which Copse this is: for --version and for the records.
#pragma once

#include <string>

namespace copse {

/// "0.1.0".
std::string version();
/// The commit that was built, with a `+` where files differed from it; "unknown" where that cannot be told.
std::string commit();

}  // namespace copse
