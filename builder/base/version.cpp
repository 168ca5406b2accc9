// The version comes from CMake, the commit from a header that commit.cmake rewrites when it changes.
#include "builder/base/version.h"

#include "copse_commit.h"

namespace copse {

std::string version() { return COPSE_VERSION; }
std::string commit() { return COPSE_COMMIT; }

}  // namespace copse
