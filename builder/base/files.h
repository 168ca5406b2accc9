// Names of files and what is in them. For writing see whole_file.h.
#pragma once

#include <string>

namespace copse {

/// The extension of a file's name in lower case, with its dot: ".exr" for "T.EXR"; "" where it has none. Formats are
/// told apart by it, so that no two readers disagree on what a name means.
std::string extensionOf(const std::string& file);

/// Throws InputError "FILE: why" where it is not there, or is a directory or another thing that is not a regular file.
void checkFile(const std::string& file);

/// The bytes of a regular file. Throws InputError "FILE: why": not there, a directory, empty, not readable.
std::string readFile(const std::string& file);

}  // namespace copse
