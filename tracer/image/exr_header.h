// The header of an EXR file before OpenEXR reads it, which takes the memory for what a header says before it looks
// whether the file has it.
#pragma once

#include <string>

namespace copse {

/// Throws InputError without the file's name where an attribute of a header is larger than the file, or not as large as
/// its type: OpenEXR would take what follows for other attributes. What else is wrong with a file is OpenEXR's to say.
/// Reads what says how long something is, and skips the rest.
void checkExrHeader(const std::string& file);

}  // namespace copse
