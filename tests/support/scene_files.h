// Scene files that a test writes, and the message of the error that reading one gives.
#pragma once

#include <cstdlib>
#include <filesystem>
#include <string>

#include "builder/base/error.h"
#include "tests/support/files.h"
#include "tracer/scene/scene.h"

namespace copse::test {

struct SceneFolder : Folder {
  std::string file(const std::string& name) const { return *this / name; }
  /// Writes a file and returns its path.
  std::string write(const std::string& name, const std::string& text) const {
    std::filesystem::remove(file(name));  // Overwriting a file costs a flush to disk.
    putBytes(file(name), text);
    return file(name);
  }
};

/// COPSE_SCENES as it was, at the end of the test.
struct KeepScenes {
  const char* was = std::getenv("COPSE_SCENES");
  const std::string value = was ? was : "";
  ~KeepScenes() { was ? setenv("COPSE_SCENES", value.c_str(), 1) : unsetenv("COPSE_SCENES"); }
};

inline std::string sceneData(const std::string& name) { return COPSE_SOURCE_DIR "/tests/data/scene/" + name; }

/// The error message of loading, without folders before file names; "" if it loads.
inline std::string errorOf(const std::string& file) {
  try {
    loadScene(file);
  } catch (const InputError& error) {
    std::string text = error.what();
    const std::string folder = std::filesystem::path(file).parent_path().string() + "/";
    for (std::size_t at; (at = text.find(folder)) != std::string::npos;) text.erase(at, folder.size());
    return text;
  }
  return "";
}

inline bool hasNote(const Scene& scene, const std::string& part) {
  for (const std::string& note : scene.notes)
    if (note.find(part) != std::string::npos) return true;
  return false;
}

/// Twice the area of the whole surface.
inline double doubleArea(const Scene& scene) {
  double sum = 0;
  for (const uvec3& t : scene.triangles)
    sum += glm::length(
        glm::cross(scene.positions[t.y] - scene.positions[t.x], scene.positions[t.z] - scene.positions[t.x]));
  return sum;
}

}  // namespace copse::test
