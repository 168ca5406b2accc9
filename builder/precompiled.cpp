// Empty: CMake wants a file for the target whose precompiled headers the libraries use.
