// Every texture of a scene and its sky, each file once. A texture that cannot be read costs its colours and a note;
// a sky that cannot be read is an error, since the image would be another one.
#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>
#include <atomic>
#include <filesystem>
#include <iterator>
#include <memory>
#include <new>
#include <unordered_map>

#include "builder/base/error.h"
#include "tracer/image/image_io.h"

namespace copse {

namespace fs = std::filesystem;

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

/// The same for two names of one file, links included, and for nothing else; its name where there is no file.
std::string identityOf(const Texture& texture) {
  struct stat found {};
  const std::string file =
      ::stat(texture.file.c_str(), &found) == 0
          ? fmt::format("{} {}", static_cast<uint64_t>(found.st_dev), static_cast<uint64_t>(found.st_ino))
          : fs::path(texture.file).lexically_normal().string();
  return (texture.linear ? "linear " : "screen ") + file;
}

/// Textures of the same file become one; the others stay empty, with no material that names them.
void shareFiles(Scene& scene) {
  std::unordered_map<std::string, int> first;
  std::vector<int> substituteFor;
  for (std::size_t i = 0; i < scene.textures.size(); ++i)
    substituteFor.push_back(first.emplace(identityOf(scene.textures[i]), static_cast<int>(i)).first->second);
  for (Material& material : scene.materials)
    if (material.texture >= 0) material.texture = substituteFor[static_cast<std::size_t>(material.texture)];
}

/// Moves what is said of single textures to the notes; beyond a few, their number.
void noteUnread(const std::vector<std::string>& unread, std::vector<std::string>& notes) {
  constexpr std::ptrdiff_t most = 4;
  const std::ptrdiff_t all = std::ranges::count_if(unread, [](const std::string& one) { return !one.empty(); });
  std::ptrdiff_t said = 0;
  for (const std::string& one : unread)
    if (!one.empty() && said < (all <= most ? all : most - 1)) {
      notes.push_back(one + "; using the material's Kd instead");
      ++said;
    }
  if (said < all)
    notes.push_back(fmt::format("{} more textures cannot be read; using the materials' Kd instead", all - said));
}

/// One note for all textures whose alpha is not shown.
void noteAlpha(Scene& scene, const std::vector<std::size_t>& textures) {
  std::vector<std::size_t> seeThrough;
  std::ranges::copy_if(textures, std::back_inserter(seeThrough),
                       [&](std::size_t i) { return scene.textures[i].texels && scene.textures[i].texels->seeThrough; });
  if (!seeThrough.empty())
    scene.notes.push_back(fmt::format("{}: ignored the alpha of this texture; surfaces are opaque{}",
                                      scene.textures[seeThrough[0]].file,
                                      seeThrough.size() == 1 ? "" : fmt::format(" ({} in all)", seeThrough.size())));
}

void loadSky(SkyLight& sky, std::vector<std::string>& notes) {
  if (sky.file.empty()) return;
  sky.image = readImage(sky.file);
  if (const std::size_t changed = clean(sky.image, 65504))  // The largest half, as most sky files have.
    notes.push_back(fmt::format("{}: clamped {} negative, infinite or NaN texels to 0 … 65504", sky.file, changed));
}

}  // namespace

void loadTextures(Scene& scene) {
  shareFiles(scene);
  std::vector<std::size_t> wanted;
  for (const Material& material : scene.materials)
    if (material.texture >= 0) wanted.push_back(static_cast<std::size_t>(material.texture));
  std::sort(wanted.begin(), wanted.end());
  wanted.erase(std::unique(wanted.begin(), wanted.end()), wanted.end());
  // Asked only where a texture needs it: the answer takes loading it.
  const auto needsOiio = [&](std::size_t i) { return !isExr(scene.textures[i].file); };
  std::size_t leftOut = 0;
  if (std::ranges::any_of(wanted, needsOiio) && !hasOpenImageIO()) leftOut = std::erase_if(wanted, needsOiio);
  std::vector<std::string> unread(wanted.size());

  std::atomic<bool> outOfMemory = false;
#pragma omp parallel for schedule(dynamic, 1)
  for (std::size_t i = 0; i < wanted.size(); ++i) {
    Texture& texture = scene.textures[wanted[i]];
    try {
      if (!outOfMemory) texture.texels = std::make_shared<const Texels>(readTexels(texture.file, texture.linear));
    } catch (const std::bad_alloc&) {
      outOfMemory = true;
    } catch (const std::exception& error) {
      unread[i] = error.what();
    }
  }
  if (outOfMemory)
    throw InputError(fmt::format("{}: not enough memory for its {} textures", scene.file, wanted.size()));
  if (leftOut)
    scene.notes.push_back(fmt::format("ignored {} texture{} (only EXR can be read), using Kd instead: {}", leftOut,
                                      leftOut == 1 ? "" : "s", whyNoOpenImageIO()));
  noteUnread(unread, scene.notes);
  noteAlpha(scene, wanted);
  if (scene.sky) loadSky(*scene.sky, scene.notes);
}

}  // namespace copse
