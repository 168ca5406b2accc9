// copse info: what is in a scene, or how an image was made.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include "builder/base/error.h"
#include "builder/base/files.h"
#include "builder/base/text.h"
#include "tracer/cli/commands.h"
#include "tracer/cli/options.h"
#include "tracer/cli/print.h"
#include "tracer/cli/progress.h"
#include "tracer/image/image_io.h"
#include "tracer/scene/scene.h"

namespace copse::cli {

namespace {

std::string text(const glm::dvec3& v, int digits = 6) {
  return fmt::format("{:.{}g} {:.{}g} {:.{}g}", v.x, digits, v.y, digits, v.z, digits);
}

/// A scene's coordinates as its files have them, so that a millionth of its size is seen.
class Places {
 public:
  explicit Places(const Scene& scene) : origin_(scene.origin) {
    const Box bounds = scene.bounds();
    const glm::dvec3 extent = scene.triangles.empty() ? vec3(0) : bounds.hi - bounds.lo, place = glm::abs(origin_);
    const double size = std::max({extent.x, extent.y, extent.z}), away = std::max({place.x, place.y, place.z});
    if (away > 0) digits_ = size > 0 ? std::min(17, 6 + static_cast<int>(std::ceil(std::log10(away / size)))) : 17;
  }
  std::string operator()(const glm::dvec3& place) const { return text(origin_ + place, digits_); }

 private:
  glm::dvec3 origin_;
  int digits_ = 6;
};

void printMaterials(const Scene& scene) {
  std::vector<uint64_t> used(scene.materials.size());
  for (const uint32_t material : scene.materialOf) ++used[material];
  print("\nmaterials {}\n", scene.materials.size());
  for (std::size_t i = 0; i < scene.materials.size(); ++i) {
    const Material& m = scene.materials[i];
    print("  {:<24} {:>12} triangles  kd {}", m.name, grouped(used[i]), text(m.kd));
    if (m.texture >= 0) print("  texture {}", scene.textures[m.texture].file);
    if (m.ke != vec3(0)) print("  ke {}", text(m.ke));
    print("\n");
  }
}

std::string skyText(const SkyLight& sky) {
  return sky.rotation == 0 ? sky.file : fmt::format("{}  rotation {:.6g}", sky.file, sky.rotation);
}

void printLights(const Scene& scene, const Places& place) {
  uint64_t triangles = 0;
  for (std::size_t i = 0; i < scene.triangles.size(); ++i) triangles += scene.emits(i);
  print("\nlights {}\n", scene.emitterCount());
  if (triangles) print("  {} triangles with Ke\n", grouped(triangles));
  for (const QuadLight& quad : scene.quads)
    print("  quad  corner {}  edges {}, {}  radiance {}\n", place(quad.corner), text(quad.edgeU), text(quad.edgeV),
          text(quad.radiance));
  if (scene.sky)
    print("  sky   {}\n", scene.sky->file.empty() ? "radiance " + text(scene.sky->radiance) : skyText(*scene.sky));
}

void printScene(const Scene& scene) {
  const Box bounds = scene.bounds();
  const Places place(scene);
  print("name      {}\ntriangles {}\nvertices  {}\n", scene.name, grouped(scene.triangles.size()),
        grouped(scene.positions.size()));
  if (!scene.triangles.empty())
    print("bounds    {} to {}, size {}\n", place(bounds.lo), place(bounds.hi), text(bounds.hi - bounds.lo));
  printMaterials(scene);
  printLights(scene, place);
  print("\nviews {}\n", scene.cameras.size());
  for (const Camera& camera : scene.cameras)
    print("  {:<12} eye {}  at {}  up {}  vfov {:.4g}\n", camera.name, place(camera.exactEye()),
          place(camera.exactAt()), text(camera.up), camera.vfov);
  if (scene.notes.empty()) return;
  print("\nnotes {}\n", scene.notes.size());
  for (const std::string& note : scene.notes) print("  {}\n", note);
}

/// Copse's record, or what the file's header says.
void printExr(const std::string& file) {
  const std::vector<ExrPartFacts> parts = readExrFacts(file);
  for (const ExrPartFacts& part : parts)
    if (const auto record = part.attributes.find("copse"); record != part.attributes.end())
      return print("{}", record->second);
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const ExrPartFacts& part = parts[i];
    if (parts.size() > 1) print("{}part {} {}\n", i ? "\n" : "", i + 1, part.name);
    print("{}x{} pixels, without a record of Copse\n", part.width, part.height);
    if (!part.window.empty()) print("data      {}\n", part.window);
    print("stored    {}{}\n", part.tiled ? "tiles" : "scan lines", part.deep ? ", deep: cannot be read" : "");
    print("channels  {}\n", part.channels.size());
    for (const auto& [name, type] : part.channels) print("  {:<32} {}\n", name, type);
    for (const auto& [name, value] : part.attributes) print("{:<9} {}\n", name, value);
  }
}

/// Of a format without a header that would say more.
void printImage(const std::string& file) {
  ImageSource source;
  const Image image = readImage(file, "", &source);
  print("{}x{} pixels, without a record of Copse\ntransfer  {}\n", image.width, image.height, source.transfer);
}

bool isImageName(const std::string& extension) {
  for (const char* one : {".png", ".jpg", ".jpeg", ".tga", ".tif", ".tiff", ".bmp", ".hdr", ".pfm", ".ppm", ".webp"})
    if (extension == one) return true;
  return false;
}

int run(const std::string& file, const SceneOptions& options) {
  const LoadOptions loadOptions = options.load();
  if (isExr(file) || isImageName(extensionOf(file))) {
    isExr(file) ? printExr(file) : printImage(file);
    return done;
  }
  const Scene scene = [&] {
    Progress progress("loading " + file, false);
    return loadScene(file, loadOptions);
  }();
  printScene(scene);
  return done;
}

}  // namespace

Command addInfo(CommandLine& program) {
  CommandLine command = program.addCommand("info", "Show what is in a scene, or how an image was made");
  auto file = std::make_shared<std::string>();
  auto options = std::make_shared<SceneOptions>();
  command.option("SCENE", *file, "Scene TOML, a bare mesh (.obj, .ply), or an image").required();
  options->add(command);
  return [file, options] { return run(*file, *options); };
}

}  // namespace copse::cli
