// The record out of an EXR, and its sums out of channels or means.
#include "tracer/session/resume.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <nlohmann/json.hpp>

#include "builder/base/error.h"
#include "tracer/accel/tracers.h"

namespace copse {

namespace {

using Json = nlohmann::ordered_json;

constexpr const char* sumNames[] = {"sum.R", "sum.G", "sum.B"};
constexpr const char* lostNames[] = {"lost.R", "lost.G", "lost.B"};

[[noreturn]] void refuse(const std::string& file, const std::string& why) {
  throw InputError(fmt::format("{}: cannot be resumed: {}", file, why));
}

/// Values of a record by their path, "/image/spp".
class Reader {
 public:
  Reader(std::string file, const std::string& text) : file_(std::move(file)) {
    json_ = Json::parse(text, nullptr, false);
    if (!json_.is_object()) refuse(file_, "its record is not JSON");
  }

  std::string text(const char* path) const {
    const Json& value = at(path);
    if (!value.is_string()) wrong(path, "a text");
    return value;
  }
  std::string textOr(const char* path, const std::string& standard) const {
    return json_.contains(Json::json_pointer(path)) ? text(path) : standard;
  }
  double number(const char* path) const {
    const Json& value = at(path);
    if (!value.is_number()) wrong(path, "a number");
    return value;
  }
  double numberOr(const char* path, double standard) const {
    return json_.contains(Json::json_pointer(path)) ? number(path) : standard;
  }
  uint64_t count(const char* path, uint64_t max = std::numeric_limits<uint64_t>::max()) const {
    const Json& value = at(path);
    if (!value.is_number_unsigned() || value.get<uint64_t>() > max)
      wrong(path, fmt::format("an integer up to {}", max));
    return value;
  }
  uint64_t countOr(const char* path, uint64_t standard) const {
    return json_.contains(Json::json_pointer(path)) ? count(path) : standard;
  }
  int integer(const char* path) const { return static_cast<int>(count(path, 1 << 24)); }
  glm::dvec3 vector(const char* path) const {
    const Json& value = at(path);
    if (!value.is_array() || value.size() != 3 ||
        !std::ranges::all_of(value, [](const Json& v) { return v.is_number(); }))
      wrong(path, "three numbers");
    return {value[0].get<double>(), value[1].get<double>(), value[2].get<double>()};
  }

 private:
  const Json& at(const char* path) const {
    const Json::json_pointer pointer(path);
    if (!json_.contains(pointer))
      refuse(file_, fmt::format("its record lacks {}, as those of older versions do", path));
    return json_.at(pointer);
  }
  [[noreturn]] void wrong(const char* path, const std::string& expected) const {
    refuse(file_, fmt::format("its record's {}: expected {}", path, expected));
  }

  std::string file_;
  Json json_;
};

EarlierRuns runsOf(const Reader& record) {
  EarlierRuns runs;
  runs.runs = 1 + static_cast<int>(std::min<uint64_t>(record.countOr("/earlier/runs", 0), 1 << 30));
  runs.samplesDone = record.number("/image/samples_done");
  runs.loadMs = record.number("/time_ms/load") + record.numberOr("/earlier/time_ms/load", 0);
  runs.buildMs = record.number("/time_ms/build") + record.numberOr("/earlier/time_ms/build", 0);
  runs.renderMs = record.number("/time_ms/render") + record.numberOr("/earlier/time_ms/render", 0);
  runs.rays = {record.count("/rays/primary") + record.countOr("/earlier/rays/primary", 0),
               record.count("/rays/bounce") + record.countOr("/earlier/rays/bounce", 0),
               record.count("/rays/shadow") + record.countOr("/earlier/rays/shadow", 0)};
  return runs;
}

std::string words(const vec3& v) { return fmt::format("[{}, {}, {}]", v.x, v.y, v.z); }

/// "--seed 1 (now 2)", for each that differs.
class Differences {
 public:
  template <class T>
  void compare(const char* what, const T& then, const T& now) {
    if (then != now) list_.push_back(fmt::format("{} {} (now {})", what, then, now));
  }
  void compare(const std::string& what, const glm::dvec3& then, const glm::dvec3& now) {
    if (then != now) list_.push_back(fmt::format("{} {} (now {})", what, words(vec3(then)), words(vec3(now))));
  }
  void add(const std::string& text) { list_.push_back(text); }
  void refuseAny(const std::string& file) const {
    if (!list_.empty()) refuse(file, fmt::format("it was made with {}", fmt::join(list_, ", ")));
  }

 private:
  std::vector<std::string> list_;
};

std::vector<vec3> readThree(const EarlierRender& earlier, const char* const names[3]) {
  const std::size_t pixels = static_cast<std::size_t>(earlier.image.settings.width) * earlier.image.settings.height;
  std::vector<vec3> sums;
  for (int c = 0; c < 3; ++c) {
    const std::vector<float> values = readExrChannel(earlier.file, names[c]);
    if (values.size() != pixels) refuse(earlier.file, fmt::format("its channel {} is of another size", names[c]));
    sums.resize(pixels);
    for (std::size_t i = 0; i < pixels; ++i) sums[i][c] = values[i];
  }
  return sums;
}

/// A division by a power of two loses no bit, unless the result is too small for all of them.
std::vector<vec3> sumsOfMeans(const EarlierRender& earlier) {
  const RenderSettings& settings = earlier.image.settings;
  const uint64_t pixels = static_cast<uint64_t>(settings.width) * static_cast<uint64_t>(settings.height);
  const uint64_t samples = earlier.samples / pixels;
  const bool isPower = samples > 0 && (samples & (samples - 1)) == 0;
  if (earlier.samples % pixels != 0 || !isPower || samples > exactFilmSamples)
    refuse(
        earlier.file,
        fmt::format("of {:.6g} samples per pixel it has the means, which do not give back their sums exactly (a power "
                    "of two up to {} would). A render with --resume keeps the sums",
                    earlier.image.samplesDone, exactFilmSamples));
  Image image = readExr(earlier.file);
  if (image.width != settings.width || image.height != settings.height)
    refuse(earlier.file, "its image is not of the size that its record says");
  for (vec3& pixel : image.pixels)
    for (int c = 0; c < 3; ++c) {
      if (pixel[c] != 0 && std::abs(pixel[c]) < std::numeric_limits<float>::min())
        refuse(earlier.file, "some of its means are too small to give back their sums exactly");
      pixel[c] *= static_cast<float>(samples);
    }
  return std::move(image.pixels);
}

}  // namespace

EarlierRender readEarlierRender(const std::string& file) {
  const std::vector<ExrPartFacts> parts = readExrFacts(file);
  if (parts.size() != 1 || !parts[0].attributes.contains("copse"))
    refuse(file, "it has no record of Copse, so another program wrote it");
  const Reader record(file, parts[0].attributes.at("copse"));
  EarlierRender earlier;
  earlier.file = file;
  earlier.version = record.text("/copse/version");
  earlier.commit = record.text("/copse/commit");
  earlier.sceneName = record.text("/scene/name");
  earlier.sceneHash = record.text("/scene/hash");
  earlier.tracer = record.textOr("/tracer/name", "");
  ImageRecord& image = earlier.image;
  image.integrator = record.text("/image/integrator");
  image.view = record.text("/image/view");
  image.camera = {image.view, vec3(0), vec3(0), record.vector("/image/camera/up"),
                  static_cast<float>(record.number("/image/camera/vfov"))};
  image.camera.setEye(record.vector("/image/camera/eye"));
  image.camera.setAt(record.vector("/image/camera/at"));
  RenderSettings& settings = image.settings;
  settings.width = record.integer("/image/width");
  settings.height = record.integer("/image/height");
  settings.spp = record.integer("/image/spp");
  settings.maxDepth = record.integer("/image/max_depth");
  settings.lightSamples = record.integer("/image/light_samples");
  settings.seed = record.count("/image/seed");
  image.samplesDone = record.number("/image/samples_done");
  // At most 2^20 samples of 2^26 pixels: a double holds their number, and the quotient of both gives it back.
  const double samples = image.samplesDone * settings.width * settings.height;
  if (!(samples >= 1 && samples < 0x1p52) || parts[0].width != settings.width || parts[0].height != settings.height)
    refuse(file, "its record is not that of its image");
  earlier.samples = static_cast<uint64_t>(std::llround(samples));
  earlier.runs = runsOf(record);
  earlier.hasSums = std::ranges::any_of(parts[0].channels, [](const auto& c) { return c.first == sumNames[0]; });
  return earlier;
}

void checkSameRender(const EarlierRender& earlier, const std::string& integrator, const RenderSettings& settings,
                     const Camera* camera, const uint64_t* hash) {
  const RenderSettings& then = earlier.image.settings;
  Differences differences;
  differences.compare("--integrator", earlier.image.integrator, integrator);
  differences.compare("--size", fmt::format("{}x{}", then.width, then.height),
                      fmt::format("{}x{}", settings.width, settings.height));
  differences.compare("--max-depth", then.maxDepth, settings.maxDepth);
  differences.compare("--light-samples", then.lightSamples, settings.lightSamples);
  differences.compare("--seed", then.seed, settings.seed);
  if (camera) {
    const Camera& was = earlier.image.camera;
    const std::string name = fmt::format("view {}'s ", earlier.image.view);
    differences.compare(name + "eye", was.exactEye(), camera->exactEye());
    differences.compare(name + "at", was.exactAt(), camera->exactAt());
    differences.compare(name + "up", was.up, camera->up);
    differences.compare((name + "vfov").c_str(), was.vfov, camera->vfov);
  }
  if (hash && hashText(*hash) != earlier.sceneHash)
    differences.add(fmt::format("another scene, or another state of its files (scene {}, hash {}, now {})",
                                earlier.sceneName, earlier.sceneHash, hashText(*hash)));
  differences.refuseAny(earlier.file);
}

void checkSameTracer(const EarlierRender& earlier, const std::string& tracer) {
  const auto own = [](const std::string& name) -> std::string {
    for (const TracerEntry& entry : tracers())
      if (name == entry.name && !entry.ownTrees.empty()) return name;
    return "";
  };
  if (own(earlier.tracer) == own(tracer)) return;
  Differences differences;
  differences.compare("tracer", earlier.tracer, tracer);
  differences.refuseAny(earlier.file);
}

FilmState readFilm(const EarlierRender& earlier) {
  FilmState film{earlier.samples, {}, {}};
  film.sums = earlier.hasSums ? readThree(earlier, sumNames) : sumsOfMeans(earlier);
  const uint64_t pixels = film.sums.size();
  if (earlier.samples > exactFilmSamples * pixels) film.lost = readThree(earlier, lostNames);
  return film;
}

std::vector<Channel> filmChannels(const FilmState& film) {
  std::vector<Channel> channels;
  const auto add = [&](const char* const names[3], const std::vector<vec3>& values) {
    for (int c = 0; c < 3 && !values.empty(); ++c) {
      Channel& channel = channels.emplace_back(Channel{names[c], {}});
      channel.values.reserve(values.size());
      for (const vec3& value : values) channel.values.push_back(value[c]);
    }
  };
  add(sumNames, film.sums);
  add(lostNames, film.lost);
  return channels;
}

}  // namespace copse
