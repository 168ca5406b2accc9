// copse info: what is in a scene, or how an image was made.
#include <fmt/format.h>

#include <memory>

#include "builder/base/error.h"
#include "builder/base/files.h"
#include "builder/base/text.h"
#include "tracer/cli/commands.h"
#include "tracer/cli/print.h"
#include "tracer/cli/progress.h"
#include "tracer/image/image_io.h"
#include "tracer/scene/scene.h"

namespace copse::cli {

namespace {

std::string text(const vec3& v) { return fmt::format("{:.6g} {:.6g} {:.6g}", v.x, v.y, v.z); }

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

void printLights(const Scene& scene) {
  uint64_t triangles = 0;
  for (std::size_t i = 0; i < scene.triangles.size(); ++i) triangles += scene.emits(i);
  print("\nlights {}\n", scene.emitterCount());
  if (triangles) print("  {} triangles with Ke\n", grouped(triangles));
  for (const QuadLight& quad : scene.quads)
    print("  quad  corner {}  edges {}, {}  radiance {}\n", text(quad.corner), text(quad.edgeU), text(quad.edgeV),
          text(quad.radiance));
  if (scene.sky)
    print("  sky   {}\n", scene.sky->file.empty() ? "radiance " + text(scene.sky->radiance) : scene.sky->file);
}

void printScene(const Scene& scene) {
  const Box bounds = scene.bounds();
  print("name      {}\ntriangles {}\nvertices  {}\n", scene.name, grouped(scene.triangles.size()),
        grouped(scene.positions.size()));
  if (!scene.triangles.empty())
    print("bounds    {} to {}, size {}\n", text(bounds.lo), text(bounds.hi), text(bounds.hi - bounds.lo));
  printMaterials(scene);
  printLights(scene);
  print("\nviews {}\n", scene.cameras.size());
  for (const Camera& camera : scene.cameras)
    print("  {:<12} eye {}  at {}  up {}  vfov {:.4g}\n", camera.name, text(camera.eye), text(camera.at),
          text(camera.up), camera.vfov);
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

int run(const std::string& file) {
  if (isExr(file) || isImageName(extensionOf(file))) {
    isExr(file) ? printExr(file) : printImage(file);
    return done;
  }
  const Scene scene = [&] {
    Progress progress("loading " + file, false);
    return loadScene(file);
  }();
  printScene(scene);
  return done;
}

}  // namespace

Command addInfo(CommandLine& program) {
  CommandLine command = program.addCommand("info", "Show what is in a scene, or how an image was made");
  auto file = std::make_shared<std::string>();
  command.option("SCENE", *file, "Scene TOML, a bare mesh (.obj, .ply), or an image").required();
  return [file] { return run(*file); };
}

}  // namespace copse::cli
