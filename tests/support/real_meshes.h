// The real meshes that tests look for in the folders of COPSE_SCENES, and how a test reports that it was skipped.
#pragma once

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string>

namespace copse::test {

/// For a test that checked nothing, just before it returns: by this line ctest reports it as skipped, not passed.
inline void skipTest(const std::string& why) {
  std::printf("skipped: %s\n", why.c_str());
  std::fflush(stdout);
}

/// The path of mesh `name`; "", with a message, if it is missing.
inline std::string realMesh(const std::string& name) {
  const char* folders = std::getenv("COPSE_SCENES");
  std::string rest = folders ? folders : "";
  while (!rest.empty()) {
    const std::string folder = rest.substr(0, rest.find(':'));
    rest.erase(0, folder.size() + 1);
    if (std::filesystem::exists(folder + "/" + name)) return folder + "/" + name;
  }
  std::printf("left out: no %s in COPSE_SCENES\n", name.c_str());
  return "";
}

/// As realMesh(), but "" in a sanitizer's build: what a tree costs is checked in the other presets, and a sanitizer
/// takes minutes for it.
inline std::string realMeshForCosts(const std::string& name) {
#if COPSE_SANITIZED
  std::printf("left out: costs on %s are checked without sanitizers\n", name.c_str());
  return "";
#else
  return realMesh(name);
#endif
}

}  // namespace copse::test
