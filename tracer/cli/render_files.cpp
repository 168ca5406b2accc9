// Names first, checks before the work, contents after it.
#include "tracer/cli/render_files.h"

#include <fmt/format.h>

#include <filesystem>

#include "builder/base/error.h"
#include "builder/base/whole_file.h"
#include "tracer/image/image_io.h"
#include "tracer/integrators/registry.h"
#include "tracer/session/resume.h"

namespace copse::cli {

namespace {

std::vector<NamedFile> namedOutputs(const Outputs& files) {
  return {{"-o", files.exr}, {"--preview", files.png}, {"--stats", files.json}};
}

void checkEach(const Outputs& files) {
  checkOutput("-o", files.exr, ".exr");
  if (!files.png.empty()) checkOutput("--preview", files.png, ".png");
  checkWritable(files.json);
}

}  // namespace

Outputs outputsOf(const RenderFiles& files, const std::string& sceneName, const Camera& camera) {
  Outputs outputs{files.output, files.preview, files.stats};
  if (outputs.exr.empty()) {
    std::string name = asFileName(sceneName);
    if (!findIntegrator(files.integrator).rendersLight) name += "-" + files.integrator;
    // A view requested by name gets a file of its own.
    if (!files.view.empty() && !files.allViews()) name += "-" + asFileName(camera.name);
    outputs.exr = "out/" + name + ".exr";
    if (outputs.png.empty() && hasOpenImageIO()) outputs.png = "out/" + name + ".png";
  }
  if (files.allViews())
    for (std::string* file : {&outputs.exr, &outputs.png, &outputs.json})
      if (!file->empty()) *file = withSuffix(*file, camera.name);
  return outputs;
}

void checkBeforeLoading(const RenderFiles& files) {
  checkPng("--preview", files.preview);
  if (files.output.empty()) {
    std::error_code error;
    std::filesystem::create_directories("out", error);
    if (error) throw InputError("out: " + error.message());
  } else if (!files.allViews()) {
    const Outputs outputs{files.output, files.preview, files.stats};
    checkApart(namedOutputs(outputs), {{"SCENE", files.scene}});
    checkEach(outputs);
  }
}

void checkOutputs(const RenderFiles& files, const Scene& scene, const std::vector<Camera>& cameras) {
  std::vector<NamedFile> outputs;
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k)
      if (asFileName(cameras[k].name) == asFileName(cameras[i].name))
        throw InputError(fmt::format("{}: --view all: views '{}' and '{}' would both be written to {}", scene.file,
                                     cameras[k].name, cameras[i].name, outputsOf(files, scene.name, cameras[i]).exr));
    for (const NamedFile& file : namedOutputs(outputsOf(files, scene.name, cameras[i]))) outputs.push_back(file);
  }
  checkApart(outputs, {{"SCENE", files.scene}});
  for (const Camera& camera : cameras) checkEach(outputsOf(files, scene.name, camera));
}

void writeOutputs(const Outputs& outputs, Rendered& rendered, float exposure) {
  rendered.record.image->file = outputs.exr;
  const std::string json = toJson(rendered.record);
  Picture& picture = rendered.picture;
  if (picture.film)
    for (Channel& channel : filmChannels(*picture.film)) picture.channels.push_back(std::move(channel));
  writeExr(outputs.exr, picture.image, {{"copse", json}}, picture.channels);
  if (!outputs.png.empty())
    writePng(outputs.png, picture.preview.pixels.empty() ? picture.image : picture.preview, exposure);
  if (!outputs.json.empty()) writeWholeFile(outputs.json, json);
}

}  // namespace copse::cli
