// Every texture of a scene and its sky, each file once. A texture that cannot be read costs its colours and a note;
// a sky that cannot be read is an error, since the image would be another one.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <iterator>
#include <map>

#include "builder/base/error.h"
#include "builder/base/files.h"
#include "tracer/image/image_io.h"

namespace copse {

namespace {

/// Puts every channel into [0, max], NaN to 0. Returns how many texels had to change.
std::size_t clean(Image& image, float max) {
  std::size_t changed = 0;
  for (vec3& texel : image.pixels) {
    const vec3 before = texel;
    for (int c = 0; c < 3; ++c) texel[c] = texel[c] > 0 ? std::min(texel[c], max) : 0;
    changed += !(texel == before);
  }
  return changed;
}

/// Textures of the same file become one; the others stay empty, with no material that names them.
void shareFiles(Scene& scene) {
  std::map<std::string, int> first;
  std::vector<int> substituteFor;
  for (std::size_t i = 0; i < scene.textures.size(); ++i) {
    std::error_code ignored;
    const std::string& file = scene.textures[i].file;
    const std::string key = std::filesystem::weakly_canonical(file, ignored).string();
    substituteFor.push_back(first.emplace(ignored ? file : key, static_cast<int>(i)).first->second);
  }
  for (Material& material : scene.materials)
    if (material.texture >= 0) material.texture = substituteFor[static_cast<std::size_t>(material.texture)];
}

void loadSky(SkyLight& sky, std::vector<std::string>& notes) {
  if (sky.file.empty()) return;
  sky.image = readTexture(sky.file);
  if (const std::size_t changed = clean(sky.image, 65504))  // The largest half, as most sky files have.
    notes.push_back(fmt::format("{}: clamped {} negative, infinite or NaN texels to 0 … 65504", sky.file, changed));
}

}  // namespace

bool isExr(const std::string& file) { return extensionOf(file) == ".exr"; }

void loadTextures(Scene& scene) {
  shareFiles(scene);
  std::vector<std::size_t> wanted;
  for (const Material& material : scene.materials)
    if (material.texture >= 0) wanted.push_back(static_cast<std::size_t>(material.texture));
  std::sort(wanted.begin(), wanted.end());
  wanted.erase(std::unique(wanted.begin(), wanted.end()), wanted.end());
  std::vector<std::string> notes(wanted.size());
  // Asked only where a texture needs it: the answer takes loading it.
  const auto needsOiio = [&](std::size_t i) { return !isExr(scene.textures[i].file); };
  std::size_t leftOut = 0;
  if (std::ranges::any_of(wanted, needsOiio) && !hasOpenImageIO()) leftOut = std::erase_if(wanted, needsOiio);

#pragma omp parallel for schedule(dynamic, 1)
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    Texture& texture = scene.textures[wanted[i]];
    try {
      texture.image = readTexture(texture.file);
      clean(texture.image, 1);
    } catch (const std::exception& error) {
      texture.image = {};
      notes[i] = fmt::format("{}; using the material's Kd instead", error.what());
    }
  }
  if (leftOut)
    notes.push_back(fmt::format("ignored {} texture{} (only EXR can be read), using Kd instead: {}", leftOut,
                                leftOut == 1 ? "" : "s", whyNoOpenImageIO()));
  std::vector<std::size_t> seeThrough;
  std::ranges::copy_if(wanted, std::back_inserter(seeThrough),
                       [&](std::size_t i) { return scene.textures[i].image.seeThrough; });
  if (!seeThrough.empty())
    notes.push_back(fmt::format("{}: ignored the alpha of this texture; surfaces are opaque{}",
                                scene.textures[seeThrough[0]].file,
                                seeThrough.size() == 1 ? "" : fmt::format(" ({} in all)", seeThrough.size())));
  for (std::string& note : notes)
    if (!note.empty()) scene.notes.push_back(std::move(note));
  if (scene.sky) loadSky(*scene.sky, scene.notes);
}

}  // namespace copse
