// A scene as OBJ and MTL, in the scene's own order: nine digits per coordinate, so that reading gives the same floats
// back and the same triangles in the same order. Linear in the file's size, one buffer of a megabyte.
#include <fmt/compile.h>
#include <fmt/format.h>

#include <filesystem>
#include <iterator>
#include <set>

#include "builder/base/error.h"
#include "builder/base/files.h"
#include "builder/base/whole_file.h"
#include "tracer/generators/generators.h"

namespace copse {

namespace {

namespace fs = std::filesystem;

class Writer {
 public:
  explicit Writer(const std::string& file) : file_(file) {}

  template <typename Format, typename... Args>
  void line(const Format& format, const Args&... args) {
    fmt::format_to(std::back_inserter(buffer_), format, args...);
    if (buffer_.size() > (1u << 20)) flush();
  }
  void commit() {
    flush();
    file_.commit();
  }

 private:
  void flush() {
    file_.write(buffer_.data(), buffer_.size());
    buffer_.clear();
  }
  WholeFile file_;
  fmt::memory_buffer buffer_;
};

/// A name a material: no blanks, which many readers stop at, and none twice.
std::vector<std::string> materialNames(const Scene& scene) {
  std::vector<std::string> names;
  std::set<std::string> taken;
  for (const Material& material : scene.materials) {
    std::string name = material.name.empty() ? "material" : material.name;
    for (char& c : name)
      if (static_cast<unsigned char>(c) <= ' ') c = '_';
    const std::string stem = name;
    for (int i = 2; !taken.insert(name).second; ++i) name = fmt::format("{}_{}", stem, i);
    names.push_back(name);
  }
  return names;
}

void writeMaterials(const Scene& scene, const std::vector<std::string>& names, const fs::path& folder, Writer& out) {
  for (std::size_t i = 0; i < names.size(); ++i) {
    const Material& m = scene.materials[i];
    out.line(FMT_COMPILE("newmtl {}\nKd {:.9g} {:.9g} {:.9g}\n"), names[i], m.kd.x, m.kd.y, m.kd.z);
    if (m.ke.x > 0 || m.ke.y > 0 || m.ke.z > 0)
      out.line(FMT_COMPILE("Ke {:.9g} {:.9g} {:.9g}\n"), m.ke.x, m.ke.y, m.ke.z);
    if (m.texture >= 0) {
      // From the folder of the MTL, where readers look.
      const fs::path texture = fs::absolute(scene.textures[static_cast<std::size_t>(m.texture)].file);
      out.line(FMT_COMPILE("map_Kd {}\n"), texture.lexically_proximate(folder).string());
    }
    out.line(FMT_COMPILE("\n"));
  }
}

}  // namespace

void writeObj(const Scene& scene, const std::string& file) {
  const fs::path obj(file);
  if (extensionOf(file) != ".obj") throw InputError(file + ": the name must end in .obj");
  fs::path mtl = obj;
  mtl.replace_extension(".mtl");
  Writer triangles(file), materials(mtl.string());

  const std::vector<std::string> names = materialNames(scene);
  writeMaterials(scene, names, fs::absolute(obj).parent_path(), materials);

  triangles.line(FMT_COMPILE("# {}: {} triangles\nmtllib {}\n"), scene.name, scene.triangles.size(),
                 mtl.filename().string());
  for (const vec3& p : scene.positions) triangles.line(FMT_COMPILE("v {:.9g} {:.9g} {:.9g}\n"), p.x, p.y, p.z);
  for (const vec2& t : scene.uvs) triangles.line(FMT_COMPILE("vt {:.9g} {:.9g}\n"), t.x, t.y);
  for (std::size_t i = 0; i < scene.triangles.size(); ++i) {
    if (i == 0 || scene.materialOf[i] != scene.materialOf[i - 1])
      triangles.line(FMT_COMPILE("usemtl {}\n"), names[scene.materialOf[i]]);
    const uvec3 p = scene.triangles[i] + 1u;
    if (scene.uvTriangles.empty()) {
      triangles.line(FMT_COMPILE("f {} {} {}\n"), p.x, p.y, p.z);
    } else {
      const uvec3 t = scene.uvTriangles[i] + 1u;
      triangles.line(FMT_COMPILE("f {}/{} {}/{} {}/{}\n"), p.x, t.x, p.y, t.y, p.z, t.z);
    }
  }
  materials.commit();
  triangles.commit();
}

}  // namespace copse
